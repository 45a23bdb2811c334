"""The figure of `stride study speeds`: where each commanded velocity led."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, STYLE, WARNING
from hil.studies.study import Result


def draw_speeds(title: str, rows: list[Result], path: Path) -> None:
    """Targets as rings, reached velocities as dots, falls as crosses."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8, 4.2), layout="constrained")
        axes = figure.add_subplot()
        walked = [row for row in rows if row["stopped_s"] is None and row["speed_mps"] is not None]
        fallen = [row for row in rows if row not in walked]
        for row in walked:
            axes.plot(
                [row["target_mps"], row["speed_mps"]],
                [row["target_coronal_mps"], row["coronal_mps"]],
                color="#9a9ea4",
                linewidth=1.0,
            )
        for chosen, keys, style, label in (
            (walked, ("target_mps", "target_coronal_mps"), {"marker": "o", "mfc": "none",
             "mec": BODY, "ms": 9}, "commanded"),
            (walked, ("speed_mps", "coronal_mps"), {"marker": ".", "color": LEFT}, "reached"),
            (fallen, ("target_mps", "target_coronal_mps"), {"marker": "x", "color": WARNING,
             "ms": 9}, "fell"),
        ):  # fmt: skip
            x, y = [[row[key] for row in chosen] for key in keys]
            axes.plot(x, y, linestyle="none", label=label, **style)
        axes.set(xlabel="sagittal speed [m/s]", ylabel="coronal speed [m/s]")
        axes.margins(0.08, 0.2)
        axes.legend(loc="upper center", ncols=3, bbox_to_anchor=(0.5, 1.12))
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)
