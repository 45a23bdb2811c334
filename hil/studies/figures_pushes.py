"""The figure of `stride study pushes`: the survived push around the robot, and by phase."""

import math
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from hil.figure_style import LEFT, RIGHT, STYLE
from hil.studies.study import Result

ANGLES_DEG = {
    "forward": 90, "forward_left": 135, "left": 180, "back_left": 225,
    "back": 270, "back_right": 315, "right": 0, "forward_right": 45,
}  # fmt: skip
"""On the page: the robot walks upwards."""


def draw_pushes(
    title: str, rows: list[Result], largest_n: float, froude_per_n: float, path: Path
) -> None:
    """Left: least and largest survived push by direction. Right: every phase."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 4.4), layout="constrained")
        around = figure.add_subplot(1, 2, 1, projection="polar", rlabel_position=22.5)
        phases = figure.add_subplot(1, 2, 2)
        names = list(dict.fromkeys(row["direction"] for row in rows))
        around_names = sorted(names, key=ANGLES_DEG.__getitem__)
        angles = [math.radians(ANGLES_DEG[name]) for name in around_names]
        least = [_forces(rows, name).min() * froude_per_n for name in around_names]
        largest = [_forces(rows, name).max() * froude_per_n for name in around_names]
        around.plot([*angles, angles[0]], [*largest, largest[0]], "--", color=RIGHT,
                    label="best phase")  # fmt: skip
        around.plot([*angles, angles[0]], [*least, least[0]], "o-", color=LEFT, label="all phases")
        around.set_xticks(angles, [name.replace("_", "\n") for name in around_names])
        around.set_ylim(bottom=0)
        around.yaxis.set_major_locator(MultipleLocator(0.1))
        around.tick_params(axis="y", labelsize=7)
        around.set_title("Survived push as Δv/√(gL); ahead is up")
        around.legend(loc="upper left", bbox_to_anchor=(-0.35, 1.05))
        _draw_phases(phases, rows, names, largest_n)
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _draw_phases(axes: Axes, rows: list[Result], names: list[str], largest_n: float) -> None:
    """Every direction and phase as a field with its force."""
    forces = np.array([_forces(rows, name) for name in names])
    axes.imshow(forces, cmap="RdYlGn", vmin=0.0, vmax=largest_n, aspect="auto", alpha=0.8)
    for (line, place), force in np.ndenumerate(forces):
        axes.text(place, line, f"{force:g}", ha="center", va="center", fontsize=8)
    phases = [row["phase"] for row in rows if row["direction"] == names[0]]
    axes.set_xticks(range(len(phases)), [f"{phase:.2f}" for phase in phases])
    axes.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    axes.grid(False)
    axes.set(
        title=f"Largest survived force [N], of at most {largest_n:g}",
        xlabel="phase of the push [steps]",
    )


def _forces(rows: list[Result], name: str) -> np.ndarray:
    return np.array([row["survived_n"] or 0.0 for row in rows if row["direction"] == name])
