"""Pictures of a jump: strip, path of the centre of mass, force arrows, support and balance.

The four of chapter 4 of seed 004_2880d7939e94ed85, each on axes of its own; all plain arrays.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from hil.description import RobotDescription
from hil.figure_robot import Outline
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, WARNING
from hil.interface import Floats

MARGIN = 0.35
"""Free space beside the first and last outline, as a share of the robot's height."""


def draw_jump_strip(
    axes: Axes,
    description: RobotDescription,
    base_positions: Floats,
    base_orientations: Floats,
    joint_positions: Floats,
    labels: Sequence[str],
    spacing: float = 0.0,
) -> None:
    """Outlines from the right: `spacing` [m] apart, or where they are for a spacing of 0.

    `base_positions` (k, 3), `base_orientations` (k, 4), `joint_positions` (k, n), a label each.
    """
    outline = Outline(description)
    height = float(base_positions[:, 2].max())
    places = spacing * np.arange(len(labels)) if spacing else base_positions[:, 0]
    for place, base, orientation, joints, label in zip(
        places.tolist(), base_positions, base_orientations, joint_positions, labels, strict=True
    ):
        outline.draw_posture(axes, base, orientation, joints, 0.0, place)
        axes.text(place, -0.08 * height, label, ha="center", va="top", color=LIMIT)
    axes.axhline(0.0, color="#9a9ea4", linewidth=1.0, zorder=0)
    axes.set_xlim(places.min() - MARGIN * 1.5 * height, places.max() + MARGIN * 1.5 * height)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_axis_off()


def draw_com_path(axes: Axes, planned: Floats, measured: Floats | None = None) -> None:
    """Centre of mass from the side [m]: `planned` (p, 3) dashed, `measured` (q, 3) in full."""
    axes.plot(planned[:, 0], planned[:, 2], "--", color=WARNING, label="planned")
    if measured is not None:
        axes.plot(measured[:, 0], measured[:, 2], color=RIGHT, label="measured")
    axes.set(xlabel="forward [m]", ylabel="up [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(loc="upper left")


def draw_force_arrows(axes: Axes, points: Floats, forces: Floats, scale: float) -> None:
    """Forces (k, 3) [N] at points (k, 3) from the side, `scale` [m/N] long."""
    for point, force in zip(points[:, ::2], scale * forces[:, ::2], strict=True):
        axes.annotate(
            "", xytext=point, xy=point + force,
            arrowprops={"arrowstyle": "-|>", "color": LEFT, "linewidth": 1.4},
        )  # fmt: skip


def draw_support(axes: Axes, vertices: Floats, coms: Floats) -> None:
    """From above: supporting polygon (v, 2) and the centre of mass (k, 2) or (k, 3), last big."""
    axes.add_patch(Polygon(vertices[:, ::-1], facecolor="#e6e8ea", edgecolor=BODY, linewidth=1.2))
    axes.plot(coms[:, 1], coms[:, 0], ".-", color=RIGHT, linewidth=0.8, markersize=4)
    axes.plot(coms[-1, 1], coms[-1, 0], "o", color=LEFT, label="centre of mass, last")
    everything = np.vstack((vertices, coms[:, :2]))
    low, high = everything.min(axis=0), everything.max(axis=0)
    room = 0.15 * float((high - low).max())
    axes.set_xlim(high[1] + room, low[1] - room)
    axes.set_ylim(low[0] - room, high[0] + room)
    axes.set(xlabel="left [m]", ylabel="forward [m]")
    axes.set_aspect("equal")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), borderaxespad=0.2)
