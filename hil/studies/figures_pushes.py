"""The figure of `stride study pushes`: the survived push around the robot, and by phase."""

import math
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from hil.figure_robot import LEFT, RIGHT
from hil.figures import STYLE
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
        around.tick_params(axis="y", labelsize=7)
        around.set_title("Survived push as Δv/√(gL); ahead is up")
        around.legend(loc="upper left", bbox_to_anchor=(-0.35, 1.05))
        for name in names:
            where = [row["phase"] for row in rows if row["direction"] == name]
            phases.plot(where, _forces(rows, name), "o-", label=name.replace("_", " "))
        phases.axhline(largest_n, color="#9a9ea4", linestyle=":", linewidth=1.0)
        phases.set_ylim(0, 1.2 * largest_n)
        phases.set(title="Largest survived force; dotted: the ladder's end",
                   xlabel="phase of the push [steps]", ylabel="[N]")  # fmt: skip
        phases.legend(ncols=4, loc="upper center", fontsize=8)
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _forces(rows: list[Result], name: str) -> np.ndarray:
    return np.array([row["survived_n"] or 0.0 for row in rows if row["direction"] == name])
