"""The figure of `stride study water`: speeds reached and feet lifted, by level."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, STYLE, WARNING
from hil.studies.study import Result

SHADES = ("#9ecae1", "#6baed6", "#4292c6", "#2171b5", "#08519c", "#08306b")


def draw_water(title: str, rows: list[Result], path: Path) -> None:
    """Left: speeds over levels, rings commanded, dots reached, crosses falls. Right: lift."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 3.8), layout="constrained")
        left, right = figure.subplots(1, 2)
        walked = [row for row in rows if row["speed_mps"] is not None]
        fallen = [row for row in rows if row["speed_mps"] is None]
        for chosen, key, style, label in (
            (walked, "target_mps", {"marker": "o", "mfc": "none", "mec": BODY, "ms": 9},
             "commanded"),
            (walked, "speed_mps", {"marker": ".", "color": LEFT}, "reached"),
            (fallen, "target_mps", {"marker": "x", "color": WARNING, "ms": 8}, "did not walk"),
        ):  # fmt: skip
            x, y = [row["level_m"] for row in chosen], [row[key] for row in chosen]
            left.plot(x, y, linestyle="none", label=label, **style)
        left.set(xlabel="level above the floor [m]", ylabel="speed [m/s]")
        left.margins(0.08, 0.15)
        left.legend(loc="upper center", ncols=3, bbox_to_anchor=(0.5, 1.14))
        speeds = sorted({row["target_mps"] for row in walked})
        for speed, shade in zip(speeds, _shades(len(speeds)), strict=True):
            of_speed = [row for row in walked if row["target_mps"] == speed]
            x, y = [row["level_m"] for row in of_speed], [row["lift_m"] for row in of_speed]
            right.plot(x, y, marker="o", color=shade, label=f"{speed:g} m/s")
        right.set(xlabel="level above the floor [m]", ylabel="lift of the sole [m]")
        right.set_ylim(bottom=0.0)
        if speeds:
            right.legend(loc="upper left")
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _shades(count: int) -> list[str]:
    return [SHADES[min(i, len(SHADES) - 1)] for i in range(count)]
