"""The figure of `stride study ceiling`: gains of each joint and how high they may be."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, RIGHT, STYLE
from hil.studies.study import Result


def draw_ceilings(title: str, rows: list[Result], path: Path) -> None:
    """A panel a joint: damping by rate, stored and at the ceiling."""
    joints = list(dict.fromkeys(row["joint_group"] for row in rows if row["kd"] is not None))
    columns = 3
    with mpl.rc_context(STYLE):
        height = 0.8 + 2.0 * -(-len(joints) // columns)
        figure = Figure(figsize=(10, height), layout="constrained")
        for place, joint in enumerate(joints, start=1):
            axes = figure.add_subplot(-(-len(joints) // columns), columns, place)
            chosen = sorted(
                (row for row in rows if row["joint_group"] == joint), key=lambda row: row["rate_hz"]
            )
            rates = [row["rate_hz"] for row in chosen]
            for key, label, colour, marker in (
                ("kd", "stored", BODY, "o"),
                ("kd_ceiling", "ceiling", RIGHT, "v"),
                ("kd_register", "registers", LEFT, "_"),
            ):
                values = np.array([row[key] for row in chosen], dtype=np.float64)
                if np.isfinite(values).any():
                    axes.plot(rates, values, marker=marker, color=colour, label=label)
            axes.set(title=joint, xscale="log", yscale="log")
            axes.set_xticks(rates, [str(rate) for rate in rates], fontsize=6, rotation=70)
            axes.minorticks_off()
            if place == 1:
                axes.legend(fontsize=8)
                axes.set_ylabel("damping [N·m·s/rad]")
        figure.supxlabel("control rate [Hz]", fontsize=9)
        figure.suptitle(f"{title}: damping and its ceiling", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)
