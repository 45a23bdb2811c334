"""The gait diagram: which corner of which foot carries when, from the corner forces."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, RIGHT
from hil.interface import CORNERS, SIDES, Floats
from hil.plots.plotted_run import LAST_S, PlottedRun
from hil.trace import Trace

LOADED = 0.05
"""Share of the weight on a foot from which it counts as carrying."""


def draw_gait(figure: Figure, run: PlottedRun) -> None:
    """Eight corners over the last seconds, and how long every step took."""
    corners, steps = figure.subplots(1, 2, width_ratios=(3, 2))
    trace, weight = run.trace, run.meta["weight_n"]
    _draw_corners(corners, trace, weight)
    _draw_steps(steps, trace, weight)


def _draw_corners(axes: Axes, trace: Trace, weight: float) -> None:
    shown = trace.time_s >= trace.time_s[-1] - LAST_S
    first, last = trace.time_s[shown][[0, -1]]
    for foot, colour in enumerate((LEFT, RIGHT)):
        forces = trace.foot_force[shown, foot]
        shades = LinearSegmentedColormap.from_list("load", ["white", colour])
        top = 5.0 * foot
        axes.imshow(
            forces.T, extent=(first, last, top + 4, top), aspect="auto", cmap=shades,
            interpolation="nearest", vmin=0.0, vmax=weight / 2,
        )  # fmt: skip
        carries = _loads(trace)[shown, foot] > LOADED * weight
        axes.fill_between(
            trace.time_s[shown], top + 4.15, top + 4.5, where=carries, color=colour, linewidth=0
        )
    names = [name.replace("_", " ") for name in CORNERS]
    places = [0.5, 1.5, 2.5, 3.5, 4.32]
    axes.set_yticks(
        [top + place for top in (0, 5) for place in places],
        [f"{side} {name}" for side in SIDES for name in (*names, "foot carries")],
    )
    axes.set(xlim=(first, last), ylim=(9.7, 0), xlabel="time [s]", title="Gait, from corner forces")
    axes.grid(visible=False)


def _draw_steps(axes: Axes, trace: Trace, weight: float) -> None:
    """Durations of whole steps by stance foot; the shares of support are in the title."""
    begins = np.flatnonzero(np.diff(trace.steps) > 0) + 1
    durations, stance = np.diff(trace.time_s[begins]), trace.stance[begins[:-1]]
    for foot, colour in enumerate((LEFT, RIGHT)):
        own = stance == foot
        axes.plot(
            trace.time_s[begins[:-1]][own], durations[own], "o", ms=4, color=colour,
            label=f"{SIDES[foot]} stance",
        )  # fmt: skip
    axes.set(title=support_shares(trace, weight), xlabel="time [s]", ylabel="step time [s]")
    if len(durations):
        axes.set_ylim(0, 1.25 * float(durations.max()))
        axes.legend(loc="lower right", ncols=2)
    else:
        axes.text(0.5, 0.5, "no whole step", transform=axes.transAxes, ha="center", color=BODY)


def support_shares(trace: Trace, weight: float) -> str:
    """How much of the time both feet, one, or none carries."""
    feet = (_loads(trace) > LOADED * weight).sum(axis=1)
    both, one, none = (100.0 * float(np.mean(feet == count)) for count in (2, 1, 0))
    return f"Support: both feet {both:.0f} %, one {one:.0f} %, none {none:.0f} %"


def _loads(trace: Trace) -> Floats:
    """Load on each foot, toe included [N], (T, 2)."""
    return np.asarray(trace.foot_force.sum(axis=2) + trace.toe_force)
