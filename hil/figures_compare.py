"""The picture of a comparison: two walks over each other."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.compare import STRIDE_BINS, Walk, stance_load, stride_profile
from hil.figure_style import LEFT, RIGHT, STYLE
from hil.figures import forward_speed, over_a_stride

JOINTS = ("hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
"""Joints of the left leg that are drawn, where a robot has them."""
COLOURS = (LEFT, RIGHT)


def draw_comparison(first: Walk, second: Walk, path: Path) -> None:
    """Write the picture to a file whose suffix says the format."""
    joints = [name for name in JOINTS if _column(first, name) is not None]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(12, 6.8), layout="constrained")
        grid = figure.add_gridspec(2, 6)
        speed = figure.add_subplot(grid[0, :3])
        load = figure.add_subplot(grid[0, 3:5])
        timing = figure.add_subplot(grid[0, 5])
        below = grid[1, :].subgridspec(1, max(1, len(joints)))
        panels = [figure.add_subplot(below[0, place]) for place in range(len(joints))]
        for walk, colour in zip((first, second), COLOURS, strict=True):
            _draw_speed(speed, walk, colour)
            _draw_load(load, walk, colour)
            for axes, joint in zip(panels, joints, strict=True):
                _draw_joint(axes, walk, joint, colour)
        _draw_timing(timing, (first, second))
        figure.suptitle(f"{first.label} and {second.label}", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=130)


def _draw_speed(axes: Axes, walk: Walk, colour: str) -> None:
    trace = walk.trace
    axes.plot(trace.time_s, trace.speed, color=colour, linestyle=":", linewidth=1.0)
    speed = over_a_stride(trace, forward_speed(trace))
    axes.plot(trace.time_s, speed, color=colour, label=walk.label)
    axes.set(title="Speed over one stride (dotted: commanded)", xlabel="time [s]", ylabel="[m/s]")
    axes.margins(x=0)
    axes.legend(loc="lower right", fontsize=8)


def _draw_load(axes: Axes, walk: Walk, colour: str) -> None:
    load = stride_profile(walk.trace, stance_load(walk.trace)) / walk.meta["weight_n"]
    axes.plot(_stride_axis(), load, color=colour)
    axes.set(title="Load on the stance foot / weight", xlabel="stride: left, right stance")
    axes.set_xticks((0, 0.5, 1))


def _draw_joint(axes: Axes, walk: Walk, joint: str, colour: str) -> None:
    column = _column(walk, joint)
    if column is None:
        return
    angles = np.degrees(walk.trace.joint_position[:, column])
    axes.plot(_stride_axis(), stride_profile(walk.trace, angles), color=colour)
    axes.set(title=f"left {joint.replace('_', ' ')} [°]", xlabel="stride")
    axes.set_xticks((0, 0.5, 1))


def _draw_timing(axes: Axes, walks: tuple[Walk, Walk]) -> None:
    boxes = axes.boxplot(
        [walk.trace.cycle_ns * 1e-6 for walk in walks],
        whis=(1, 99), showfliers=False, widths=0.6, patch_artist=True,
        medianprops={"color": "white"},
    )  # fmt: skip
    for box, colour in zip(boxes["boxes"], COLOURS, strict=True):
        box.set(facecolor=colour, edgecolor=colour)
    axes.set(title="Tick, 1–99 % [ms]", xticks=[], yscale="log")


def _column(walk: Walk, joint: str) -> int | None:
    names: list[str] = walk.meta["joints"]
    name = f"left_{joint}"
    return names.index(name) if name in names else None


def _stride_axis() -> np.ndarray:
    return (np.arange(STRIDE_BINS) + 0.5) / STRIDE_BINS
