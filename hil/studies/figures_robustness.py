"""The figure of `stride study robustness`: how many robots survived each condition."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import LEFT, RIGHT, STYLE
from hil.studies.study import Result

COLOURS = (LEFT, RIGHT, "#6a6f75", "#9a9ea4")


def draw_robustness(title: str, rows: list[Result], path: Path) -> None:
    """A bar a condition and rate: the share of robots that came to the end."""
    conditions = list(dict.fromkeys(row["condition"] for row in rows))
    rates = list(dict.fromkeys(row["rate_hz"] for row in rows))
    height = 0.8 / len(rates)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8, 1.2 + 0.34 * len(conditions)), layout="constrained")
        axes = figure.add_subplot()
        for order, rate_hz in enumerate(rates):
            shares = []
            for name in conditions:
                chosen = [r for r in rows if (r["condition"], r["rate_hz"]) == (name, rate_hz)]
                shares.append(100.0 * sum(r["survived"] is True for r in chosen) / len(chosen))
            places = [index + (order - (len(rates) - 1) / 2) * height for index in
                      range(len(conditions))]  # fmt: skip
            colour = COLOURS[order % len(COLOURS)]
            axes.barh(places, shares, 0.9 * height, color=colour, label=f"{rate_hz} Hz")
        axes.set_yticks(range(len(conditions)), conditions)
        axes.invert_yaxis()
        axes.set(xlabel="robots that came to the end [%]", xlim=(0, 100))
        axes.legend(loc="upper center", ncols=4, bbox_to_anchor=(0.5, 1.0 + 1.2 / len(conditions)))
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)
