"""The figure of `stride study turns`: time and overshoot over the angle."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import STYLE, WARNING
from hil.studies.study import Result

PANELS = (
    ("time_to_95_s", "Time to 95 % of the turn [s]"),
    ("overshoot_pct", "Overshoot [%]"),
    ("final_error_deg", "Final heading error [deg]"),
)


def draw_turns(title: str, rows: list[Result], path: Path) -> None:
    """A line for each rate, turn rate and law; falls as crosses at the bottom."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(12, 3.2), layout="constrained")
        for place, (key, label) in enumerate(PANELS, start=1):
            axes = figure.add_subplot(1, 3, place)
            for kind in dict.fromkeys(map(_kind, rows)):
                points = [row for row in rows if _kind(row) == kind and row[key] is not None]
                x = [row["angle_deg"] for row in points]
                axes.plot(x, [row[key] for row in points], "o-", label=kind)
            fallen = [row["angle_deg"] for row in rows if row["stopped_s"] is not None]
            bottom = axes.get_ylim()[0]
            axes.plot(fallen, [bottom] * len(fallen), "x", color=WARNING, label="fell")
            axes.set(title=label, xlabel="angle [deg]")
        figure.legend(*axes.get_legend_handles_labels(), loc="outside right center", fontsize=8)
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _kind(row: Result) -> str:
    rate = f"{row['turn_rate_radps']:g} rad/s" if row["turn_rate_radps"] else "at once"
    return ", ".join(filter(None, (f"{row['rate_hz']} Hz", row["pd"], rate)))
