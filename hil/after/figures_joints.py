"""The picture of two runs joint by joint: position and torque over the stride, or over time."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.after.comparison import Comparison
from hil.figure_style import LEFT, RIGHT, STYLE, WARNING

COLOURS = (LEFT, RIGHT)
SHOWN_S = 1.5
"""Of a twin, from the middle of the run."""
COLUMNS = 6


def draw_joints(comparison: Comparison, labels: tuple[str, str], path: Path) -> None:
    """Write the picture to a file whose suffix says the format; joints with a cause are red.

    Runs that were compared by their means alone have no curves, and no picture.
    """
    curves, joints = comparison.curves, comparison.joints
    blocks = -(-len(joints) // COLUMNS)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(15, 3.9 * blocks + 0.9), layout="constrained")
        grid = figure.subplots(2 * blocks, COLUMNS, sharex=True, squeeze=False)
        shown, axis, label = _window(comparison)
        for place in range(blocks * COLUMNS):
            row, column = 2 * (place // COLUMNS), place % COLUMNS
            above, below = grid[row, column], grid[row + 1, column]
            if place >= len(joints):
                above.set_visible(False)
                below.set_visible(False)
                continue
            for run, colour in enumerate(COLOURS):
                angle = np.degrees(curves.position[run][shown, place])
                above.plot(axis, angle, color=colour, label=labels[run])
                below.plot(axis, curves.torque[run][shown, place], color=colour)
            _title(above, comparison, joints[place])
            above.margins(x=0)
            if row == 2 * (blocks - 1):
                below.set_xlabel(label)
            if column == 0:
                above.set_ylabel("position [°]")
                below.set_ylabel("torque [N·m]")
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        title = f"{labels[1]} less {labels[0]}: {comparison.headline}"
        figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
        figure.savefig(path, dpi=110)


def _window(comparison: Comparison) -> tuple[slice, np.ndarray, str]:
    curves = comparison.curves
    if curves.aligned == "phase":
        return slice(None), curves.axis, "stride: left, right stance"
    middle = float(curves.axis[len(curves.axis) // 2])
    first, last = np.searchsorted(curves.axis, (middle, middle + SHOWN_S))
    return slice(int(first), int(last)), curves.axis[first:last], "time [s]"


def _title(axes: Axes, comparison: Comparison, joint: str) -> None:
    row = next(row for row in comparison.rows if row.joint == joint)
    name = joint.replace("_", " ")
    if row.finding is None:
        axes.set_title(name, fontsize=10)
    else:
        axes.set_title(f"{name}: {row.finding.cause}", fontsize=10, color=WARNING)
