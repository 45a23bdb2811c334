"""The rungs of a rehearsal in one picture: each run from arming to torque off, seen from the side.

    python benchmarks/rehearsal_picture.py OUT.png RUN...

Runs are run folders, as `benchmarks/rehearsal.py --keep FOLDER` leaves them.
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.description import RobotDescription
from hil.figure_robot import Outline
from hil.figure_style import LIMIT, STYLE
from hil.recording import read_recording
from hil.robot_files import load_robot
from hil.trace import Trace
from sim_backends.support import HOIST

INSTANTS = 12
LIFT = 0.06
"""How high above the ground a robot that hangs is drawn [m]."""
HANGS_ABOVE = 0.4
"""The truth of a hoisted robot says more than this, an estimate does not [m]."""


def whole_run(folder: Path) -> tuple[dict[str, object], Trace]:
    """Meta data, and all ticks with torque on."""
    recording = read_recording(folder)
    rows = recording.rows.copy()
    rows["time_s"] = (rows["frame"]["time_ns"] - rows["frame"]["time_ns"][0]) * 1e-9
    rows["safety"]["walking"] = True
    return recording.meta, Trace.from_ticks(rows)


def draw_rung(axes: Axes, name: str, trace: Trace, robot: RobotDescription, lift: float) -> None:
    """Outlines at even instants of one run."""
    outline, spacing = Outline(robot), 0.42
    trace.base_position[:, 2] += lift
    for place, tick in enumerate(np.linspace(0, len(trace) - 1, INSTANTS).astype(int)):
        outline.draw(axes, trace, int(tick), place * spacing)
        axes.text(
            place * spacing, -0.03, f"{trace.time_s[tick]:.1f} s", ha="center", va="top",
            color=LIMIT, fontsize=8,
        )  # fmt: skip
    axes.axhline(0.0, color="#9a9ea4", linewidth=1.0, zorder=0)
    axes.set_xlim(-0.75 * spacing, (INSTANTS - 0.25) * spacing)
    axes.set_aspect("equal")
    axes.set_ylim(-0.1, 0.6)
    axes.axis("off")
    axes.set_title(name, loc="left", fontsize=10, fontweight="bold")


def draw(path: Path, folders: list[Path]) -> None:
    """One row a run."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(12, 2.0 * len(folders)), layout="constrained")
        for row, folder in enumerate(folders):
            meta, trace = whole_run(folder)
            height = float(trace.base_position[0, 2])
            hangs = height > HANGS_ABOVE or str(meta["rung"]).endswith("hoisted")
            axes = figure.add_subplot(len(folders), 1, row + 1)
            robot = load_robot(str(meta["robot"]))
            name = f"{folder.name} ({meta['rung']}, {meta['rate_hz']} Hz)"
            draw_rung(
                axes, name, trace, robot, LIFT - HOIST * (height > HANGS_ABOVE) if hangs else 0.0
            )
        figure.savefig(path, dpi=130)


if __name__ == "__main__":
    draw(Path(sys.argv[1]), [Path(folder) for folder in sys.argv[2:]])
