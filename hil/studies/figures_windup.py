"""The figure of `stride study windup`."""

import math
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.description import RobotDescription
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, STYLE, WARNING
from hil.figures_jump import draw_com_path, draw_force_arrows, draw_jump_strip, draw_support
from hil.interface import Floats
from hil.joint_gains import kind_of
from hil.studies.study import Result
from hil.studies.windup_rows import BENDING

KEY_FRAMES = 7
"""Outlines of the strip."""
SHADES = (LEFT, RIGHT, BODY, WARNING, LIMIT, "#7fb2cf")


def draw_windup(head: str, description: RobotDescription, rows: list[Result], path: Path) -> None:
    """Key frames; planned path, support, controller constants; then postures of the tables."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(13, 21), layout="constrained")
        grid = figure.add_gridspec(7, 3, height_ratios=(1.1, 1.25, 1, 1, 1, 1, 1))
        plain = _arrays(rows[0])
        _key_frames(figure.add_subplot(grid[0, :]), description, plain)
        _path(figure.add_subplot(grid[1, 0]), plain)
        support = figure.add_subplot(grid[1, 1])
        draw_support(support, plain["support"], plain["coms"])
        _constants(figure.add_subplot(grid[1, 2]), rows)
        _ranges(figure.add_subplot(grid[4, :]), description, plain)
        for line, chosen, name in (
            (2, _muscles(rows, "mitre"), "Table 3.2: stiffness k times, mitre muscles"),
            (3, _muscles(rows, "chord"), "Table 3.2: stiffness k times, chord muscles"),
            (5, _limits(rows), "Table 3.3: one range narrowed, as deep a windup as it lets"),
            (6, _characters(rows), "the same target elsewhere, and for others"),
        ):
            axes = figure.add_subplot(grid[line, :])
            _postures(axes, description, chosen)
            axes.set_title(name)
        figure.suptitle(f"Windup: {head}", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=80)


def _arrays(row: Result) -> dict[str, Floats]:
    figure: dict[str, Any] = row["figure"]
    return {name: np.array(values) for name, values in figure.items()}


def _key_frames(axes: Axes, description: RobotDescription, plain: dict[str, Floats]) -> None:
    count = len(plain["errors"])
    chosen = np.unique(np.linspace(0, count - 1, KEY_FRAMES).round().astype(int))
    bases = plain["base_positions"][chosen]
    draw_jump_strip(
        axes, description, bases, plain["base_orientations"][chosen],
        plain["joint_positions"][chosen], [f"iterate {each}" for each in chosen.tolist()],
        spacing=1.1 * float(bases[:, 2].max()),
    )  # fmt: skip
    axes.set_title("key frames of the windup")


def _path(axes: Axes, plain: dict[str, Floats]) -> None:
    """Down to the crouch, then as planned; the force that the ground shall push with."""
    planned, force = plain["planned"], plain["planned_force"]
    height = float(np.ptp(planned[:, 2]))
    draw_com_path(axes, planned)
    axes.plot(plain["coms"][:, 0], plain["coms"][:, 2], color=BODY, label="windup")
    scale = 0.6 * height / float(np.linalg.norm(force))
    draw_force_arrows(axes, planned[:1], force[None], scale)
    axes.set_title("centre of mass; arrow: force of the push")
    axes.legend(loc="lower right")


def _constants(axes: Axes, rows: list[Result]) -> None:
    """|E_all| over the iterations for kd = 0."""
    chosen = [row for row in rows if row["table"] == "3.1" and row["kd"] == 0.0]
    wanted = [row for row in chosen if row["kp"] in (0.1, 0.3, 0.8, 1.6, 2.2)]
    for row, shade in zip(wanted or chosen, SHADES, strict=False):
        errors = np.array(row["figure"]["errors"])
        axes.semilogy(1e3 * errors, color=shade, label=f"kp = {row['kp']:g}")
    axes.set(xlabel="iteration", ylabel="|E_all| [mm]", xlim=(0, 60))
    axes.set_title("Table 3.1, kd = 0")
    axes.legend(loc="lower right")


def _ranges(axes: Axes, description: RobotDescription, plain: dict[str, Floats]) -> None:
    """Each kind of joint that bends at its two limits, the others at 0, the root in its place."""
    names, labels, postures = description.joint_names, [], []
    for kind in BENDING:
        joints = [place for place, name in enumerate(names) if kind_of(name) == kind]
        for end in (0, 1):
            posture = plain["joint_positions"][0].copy()
            posture[[place for place, name in enumerate(names) if kind_of(name) in BENDING]] = 0.0
            posture[joints] = [description.joints[place].range[end] for place in joints]
            postures.append(posture)
            labels.append(f"{kind}\n{math.degrees(posture[joints[0]]):.0f}°")
    count = len(labels)
    base = plain["base_positions"][0]
    draw_jump_strip(
        axes, description, np.tile(base, (count, 1)),
        np.tile(plain["base_orientations"][0], (count, 1)), np.array(postures), labels,
        spacing=1.6 * float(base[2]),
    )  # fmt: skip
    axes.set_title("Table 3.3: both ends of the ranges")


def _muscles(rows: list[Result], law: str) -> list[tuple[str, Result]]:
    """Windups of one law by stiffness; the width would show the same pictures."""
    return [
        (f"{row['scale']:g}", row)
        for row in _drawable(rows, "3.2")
        if row["law"] == law and row["varied"] == "k"
    ]


def _limits(rows: list[Result]) -> list[tuple[str, Result]]:
    return [(f"{row['joint']}\n{row['share']:.0%}", row) for row in _drawable(rows, "3.3")]


def _characters(rows: list[Result]) -> list[tuple[str, Result]]:
    """With the law of the plain windup."""
    law = rows[0]["law"]
    return [(row["character"], row) for row in _drawable(rows, "characters") if row["law"] == law]


def _drawable(rows: list[Result], table: str) -> list[Result]:
    """A windup that was refused has no picture."""
    return [row for row in rows if row["table"] == table and "error" not in row]


def _postures(axes: Axes, description: RobotDescription, chosen: list[tuple[str, Result]]) -> None:
    """The last posture of every windup, with how far its centre of mass went down."""
    if not chosen:
        axes.set_axis_off()
        return
    arrays = [_arrays(row) for _, row in chosen]
    labels = [f"{label}\n{1e3 * row['depth_m']:.0f} mm" for label, row in chosen]
    bases = np.array([each["base_positions"][-1] for each in arrays])
    draw_jump_strip(
        axes, description, bases, np.array([each["base_orientations"][-1] for each in arrays]),
        np.array([each["joint_positions"][-1] for each in arrays]), labels,
        spacing=1.6 * float(bases[:, 2].max()),
    )  # fmt: skip
