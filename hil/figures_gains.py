"""What servos can be asked for: stiffness and damping of every mode, and what was measured."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.patches import Rectangle

from hil.compose import feasible_gains
from hil.gain_bench import MODES, GainRow

COLOURS = {"position": "#2a6f97", "current_position": "#d9722b", "current": "#4a4e54"}
COLUMNS = 3
LEAST_STIFFNESS = 0.02
"""Left end of the axes, as a share of the largest stiffness of position mode."""


def draw_feasible(servos: Sequence[str], rows: Sequence[GainRow], path: Path) -> None:
    """One panel a servo: feasible regions as areas, asked gains as rings, measured as dots."""
    lines = -(-len(servos) // COLUMNS)
    figure, panels = plt.subplots(
        lines, COLUMNS, figsize=(3.6 * COLUMNS, 2.9 * lines), squeeze=False, layout="constrained"
    )
    for axes in panels.flat[len(servos) :]:
        axes.set_visible(False)
    for axes, servo in zip(panels.flat, servos, strict=False):
        _draw_servo(axes, servo, [row for row in rows if row.servo == servo])
    for axes in panels[:, 0]:
        axes.set_ylabel("damping [N·m·s/rad]")
    panels.flat[0].legend(loc="upper left", fontsize=7)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def _draw_servo(axes: Axes, servo: str, rows: Sequence[GainRow]) -> None:
    highest, widest = 0.0, 0.0
    for mode in MODES:
        limits = feasible_gains(servo, mode)
        if limits is None:
            continue
        (left, right), (low, high) = limits.stiffness, limits.damping
        axes.add_patch(
            Rectangle(
                (left, low), right - left, high - low,
                fc=to_rgba(COLOURS[mode], 0.10), ec=COLOURS[mode], lw=1.5,
                label=mode.replace("_", " "),
            )
        )  # fmt: skip
        highest, widest = max(highest, high), max(widest, right)
    for row in rows:
        colour = COLOURS[row.mode]
        axes.plot(row.stiffness, row.damping, "o", mfc="none", color=colour, ms=8)
        axes.plot(row.measured_stiffness, row.measured_damping, ".", color=colour, ms=5)
    axes.set_xscale("log")
    axes.set_xlim(LEAST_STIFFNESS * widest / 10, 1.2 * widest)
    axes.set_ylim(0.0, 1.1 * highest)
    axes.set_title(servo, fontsize=9)
    axes.set_xlabel("stiffness [N·m/rad]")
