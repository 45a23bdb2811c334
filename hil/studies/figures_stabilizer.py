"""The figure of `stride study stabilizer`: model errors, disequilibrium and time."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import RIGHT, STYLE
from hil.studies.study import Result


def draw_stabilizer(title: str, rows: list[Result], path: Path) -> None:
    """Above: error of each model. Below: disequilibrium and time of every variant."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 6), layout="constrained")
        above, below, time = figure.subplots(3, 1)
        errors = {
            row["model"]: row["model_error_pct"]
            for row in rows
            if row["model_error_pct"] is not None
        }
        above.bar(list(errors), list(errors.values()), color=RIGHT, width=0.5)
        for axes in (above, below, time):
            axes.set_axisbelow(True)
        above.set(title="Error of the predicted forces against M0 [%]")
        _bars(below, rows, "disequilibrium_pct")
        below.set(title="Ticks in disequilibrium after foot-flat [%]")
        below.legend()
        _bars(time, rows, "controller_steps")
        time.set(title="Controller's time a tick, as multiples of one mj_step")
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _bars(axes: Axes, rows: list[Result], key: str) -> None:
    """A bar a variant and ankle rule; none where it fell."""
    names = list(dict.fromkeys(row["variant"] for row in rows))
    rules = list(dict.fromkeys(row["ankle"] for row in rows))
    width = 0.8 / len(rules)
    for number, rule in enumerate(rules):
        of_rule = {row["variant"]: row for row in rows if row["ankle"] == rule}
        chosen = [name for name in names if name in of_rule]
        walked = [of_rule[name]["stopped_s"] is None for name in chosen]
        values = [
            of_rule[name][key] or 0.0 if ended else 0.0
            for name, ended in zip(chosen, walked, strict=True)
        ]
        places = np.array([names.index(name) for name in chosen]) + (number + 0.5) * width - 0.4
        axes.bar(places, values, width=0.95 * width, label=f"ankle: {rule}")
        for place, ended in zip(places, walked, strict=True):
            if not ended:
                axes.annotate("fell", (place, 0.0), rotation=90, ha="center", fontsize=7)
    axes.set_xticks(range(len(names)), names)
