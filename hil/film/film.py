"""`stride video`: a recording tick by tick through the view's own stage, into a film."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from hil.errors import InputError
from hil.film.camera import followed
from hil.film.encoder import Encoder
from hil.film.offscreen import Offscreen
from hil.interface import Ints
from hil.plots.plotted_run import PlottedRun
from hil.view.overlay import Overlay
from hil.view.stage import Stage, stage_model


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """What of a run is shown, and how."""

    width: int
    """[pixels], even."""
    height: int
    fps: float
    """Pictures a second of film."""
    slower: float = 1.0
    """Seconds of film for a second of the run."""
    begin_s: float | None = None
    """Time of the run at which the film begins; none: 1 s before the first step."""
    end_s: float | None = None
    """At which it ends; none: with the recording."""


BEFORE_S = 1.0
LAMP, AMBIENT, HEADLIGHT = 0.45, 0.40, 0.30
"""Grey levels of the three lights that a scene has."""


def film_ticks(run: PlottedRun, plan: FilmPlan) -> Ints:
    """Ticks (places in the recording) of the pictures, evenly spaced in the run's time.

    Raises InputError where there are none.
    """
    times = run.time_s
    begin = -BEFORE_S if plan.begin_s is None else plan.begin_s
    end = float(times[-1]) if plan.end_s is None else plan.end_s
    begin = max(begin, float(times[0]))
    wanted = np.arange(begin, min(end, float(times[-1])), 1.0 / (plan.fps * plan.slower))
    if not len(wanted):
        raise InputError(
            f"{run.name}: nothing to show from {begin:g} to {end:g} s: its recording goes from "
            f"{times[0]:.2f} to {times[-1]:.2f} s"
        )
    return np.asarray(np.searchsorted(times, wanted), dtype=np.int64)


def film_run(run: PlottedRun, plan: FilmPlan, path: Path, tell: Callable[[int, int], None]) -> None:
    """Write the film; `tell` hears after every picture how many of how many are done.

    The body is the simulation's truth where it is known, else the estimate. Raises InputError.
    """
    ticks = film_ticks(run, plan)
    rows = run.rows
    source = "truth" if "truth" in (rows.dtype.names or ()) else "estimate"
    model = stage_model(run.description)
    light_up(model)
    data, geoms = mujoco.MjData(model), list[Any]()
    stage = Stage(run.description, model)
    overlay = Overlay(stage, geoms)
    shots = followed(rows[source]["base_position"], run.meta["rate_hz"], stage.height)
    encoder = Encoder(path, plan.width, plan.height, plan.fps)
    with encoder, Offscreen(model, plan.width, plan.height) as screen:
        for done, tick in enumerate(ticks.tolist(), start=1):
            row = rows[tick]
            stage.place(model, data, row[source])
            overlay.draw(data, row, row[source])
            encoder.add(screen.draw(model, data, shots[tick], geoms, caption(row)))
            tell(done, len(ticks))


def light_up(model: Any) -> None:
    """Light as in a bright room: a robot's own lamp stays where it stood at the start."""
    model.light_type[:] = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    model.light_diffuse[:] = LAMP
    model.vis.headlight.ambient[:] = AMBIENT
    model.vis.headlight.diffuse[:] = HEADLIGHT


def caption(row: Any) -> str:
    """What stands in the corner of a picture."""
    lines = [f"{row['time_s']:.2f} s", f"{row['reference']['speed']:.2f} m/s asked for"]
    if row["reference"]["water_level"] > 0:
        lines.append(f"water {row['reference']['water_level']:.2f} m")
    return "\n".join(lines)
