"""The figure of `stride study gains`: sums of the gains by rate, and the range of each joint."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import LEFT, RIGHT, STYLE
from hil.studies.gain_sets import sum_of
from hil.studies.study import Result


def draw_gain_range(title: str, rows: list[Result], path: Path) -> None:
    """Above, ΣKp + 10·ΣKd of the smallest and largest sets (figure 2 of the seed); below, the
    range of each joint in percent of its mean (figure 3, bottom)."""
    rates = [str(rate) for rate in dict.fromkeys(row["rate_hz"] for row in rows)]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 7), layout="constrained")
        above, below = figure.subplots(2, 1)
        _draw_sums(above, rates, rows)
        _draw_ranges(below, rates, rows)
        figure.suptitle(f"{title}: acceptable gains", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _draw_sums(axes: Axes, rates: list[str], rows: list[Result]) -> None:
    of_rate = {str(row["rate_hz"]): row for row in rows}
    for name, colour, shift in (("min", RIGHT, -0.2), ("max", LEFT, 0.2)):
        sums = [of_rate[rate][f"sum_{name}"] or 0.0 for rate in rates]
        axes.bar([place + shift for place in range(len(rates))], sums, 0.38, color=colour, zorder=2,
                 label=f"{name}imal")  # fmt: skip
    axes.set_xticks(range(len(rates)), rates)
    axes.set(ylabel="ΣKp + 10·ΣKd", xlabel="control rate [Hz]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _draw_ranges(axes: Axes, rates: list[str], rows: list[Result]) -> None:
    joints = list(dict.fromkeys(row["joint_group"] for row in rows))
    width = 0.8 / len(rates)
    for place, rate in enumerate(rates):
        shares = [_share(row) for row in rows if str(row["rate_hz"]) == rate]
        places = [joint + (place + 0.5) * width - 0.4 for joint in range(len(joints))]
        shade = mpl.colormaps["viridis_r"](0.1 + 0.8 * place / max(1, len(rates) - 1))
        axes.bar(places, shares, width, color=shade, zorder=2, label=f"{rate} Hz")
    axes.set_xticks(range(len(joints)), joints)
    axes.set(ylabel="range, % of its mean")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _share(row: Result) -> float:
    """Range of a joint's Kp + 10·Kd in percent of the middle."""
    if row["kp_max"] is None:
        return 0.0
    low = sum_of((row["kp_min"], row["kd_min"]))
    high = sum_of((row["kp_max"], row["kd_max"]))
    return 200.0 * (high - low) / (high + low) if high + low > 0.0 else 0.0
