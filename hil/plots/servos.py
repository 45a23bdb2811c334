"""Temperatures of the servos, and the supply that they see."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import BODY, LIMIT, WARNING
from hil.interface import Floats
from hil.plots.joints import side_colour
from hil.plots.plotted_run import PlottedRun

NAMED = 3
"""Hottest servos that are named at the end of their line."""


def has_servos(run: PlottedRun) -> bool:
    """Whether anything was ever heard of a servo's temperature or supply."""
    frame = run.rows["frame"]
    return bool(
        np.isfinite(frame["joint_temperature"]).any() or np.isfinite(frame["joint_voltage"]).any()
    )


def draw_servos(figure: Figure, run: PlottedRun) -> None:
    """Every temperature left, the supply right, over the whole recording."""
    heat, supply = figure.subplots(1, 2)
    _draw_heat(heat, run)
    _draw_supply(supply, run)


def _draw_heat(axes: Axes, run: PlottedRun) -> None:
    values = run.rows["frame"]["joint_temperature"]
    axes.set(title="Temperature of every servo", xlabel="time [s]", ylabel="[°C]")
    if not np.isfinite(values).any():
        _draw_nothing(axes)
        return
    last = np.array([_last_known(values[:, place]) for place in range(len(run.joints))])
    for place, joint in enumerate(run.joints):
        axes.plot(run.time_s, values[:, place], color=side_colour(joint), linewidth=1.0)
    hottest = np.argsort(-np.nan_to_num(last, nan=-np.inf))[:NAMED]
    lines = [f"{run.joints[place].replace('_', ' ')} {last[place]:.0f} °C" for place in hottest]
    axes.text(
        0.02, 0.96, "hottest: " + ", ".join(lines), transform=axes.transAxes, va="top", fontsize=8,
    )  # fmt: skip
    low, high = np.nanmin(values), np.nanmax(values)
    axes.set_ylim(low - 2.0, high + 5.0)
    axes.margins(x=0)


def _draw_supply(axes: Axes, run: PlottedRun) -> None:
    values = run.rows["frame"]["joint_voltage"]
    axes.set(title="Supply at the servos", xlabel="time [s]", ylabel="[V]")
    known = np.isfinite(values).any(axis=1)
    if not known.any():
        _draw_nothing(axes)
        return
    time, seen = run.time_s[known], values[known]
    axes.fill_between(
        time, np.nanmin(seen, axis=1), np.nanmax(seen, axis=1), color="#c9ccd1", linewidth=0,
        label="lowest to highest servo",
    )  # fmt: skip
    axes.plot(time, np.nanmean(seen, axis=1), color=BODY, linewidth=1.0, label="mean")
    if run.description.supply is not None:
        nominal = run.description.supply.voltage
        axes.axhline(nominal, color=LIMIT, linestyle=":", linewidth=1.0)
        axes.text(time[0], nominal, " nominal", fontsize=8, color=LIMIT, va="bottom")
    lowest = float(np.nanmin(seen))
    axes.plot(time[np.nanargmin(np.nanmin(seen, axis=1))], lowest, "v", color=WARNING, ms=5,
              label=f"lowest, {lowest:.1f} V")  # fmt: skip
    axes.margins(x=0, y=0.25)
    axes.legend(loc="lower right", ncols=3, fontsize=7)


def _draw_nothing(axes: Axes) -> None:
    """Slow registers are read in turn: a short run may hear of one kind alone."""
    axes.text(0.5, 0.5, "not heard", transform=axes.transAxes, ha="center", color=LIMIT)


def _last_known(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known[-1]) if known.size else float("nan")
