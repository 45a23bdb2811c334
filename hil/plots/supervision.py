"""What the supervisor decided, and which limits changed the commands."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from hil.figure_style import BODY, LIMIT, WARNING
from hil.interface import Floats, Limit
from hil.plots.joints import side_colour
from hil.plots.plotted_run import PlottedRun
from hil.safety.severity import Severity

SHADES = LinearSegmentedColormap.from_list("share", ["white", WARNING])
NAME_ROOM = 0.03
"""Width of a fault's name, as a share of the axis."""
LEAST_SHOWN = 0.5
"""Smaller shares have no number [%]."""


def draw_supervision(figure: Figure, run: PlottedRun) -> None:
    """Severity and joints that were not heard over time; shares of limited ticks by joint."""
    over_time, limits = figure.subplots(1, 2, width_ratios=(3, 2))
    _draw_severity(over_time, run)
    _draw_limits(limits, run)


def _draw_severity(axes: Axes, run: PlottedRun) -> None:
    severity = run.rows["safety"]["severity"]
    axes.step(run.time_s, severity, where="post", color=WARNING, linewidth=1.5)
    axes.set_yticks(list(Severity), [one.name.lower().replace("_", " ") for one in Severity])
    axes.set_ylim(-1.2, max(Severity) + 0.4)
    _draw_silence(axes, run)
    _mark_faults(axes, run)
    axes.set(title="The supervisor's severity, start-up included", xlabel="time [s]")
    axes.margins(x=0)


def _mark_faults(axes: Axes, run: PlottedRun) -> None:
    """A line a fault; one that comes too soon after another has no room for its name."""
    room = NAME_ROOM * float(run.time_s[-1] - run.time_s[0])
    named_s = -np.inf
    for fault in sorted(run.faults, key=lambda fault: float(fault["time_s"])):
        time_s = float(fault["time_s"])
        axes.axvline(time_s, color=LIMIT, linestyle=":", linewidth=1.0)
        if time_s - named_s > room:
            named_s = time_s
            axes.text(
                time_s, max(Severity) + 0.3, f"{fault['source']}: {fault['name']} ",
                rotation=90, ha="right", va="top", fontsize=7, color=LIMIT,
            )  # fmt: skip


def _draw_silence(axes: Axes, run: PlottedRun) -> None:
    """A strip at the foot of the panel: the share of joints that were not heard in a tick."""
    silent = (~run.rows["frame"]["joint_valid"]).mean(axis=1)
    if silent.any():
        axes.fill_between(
            run.time_s, -1.1, -1.1 + silent, step="post", color=BODY, linewidth=0,
            label="share of joints not heard in the tick",
        )  # fmt: skip
        axes.legend(loc="upper left", fontsize=7)


def _draw_limits(axes: Axes, run: PlottedRun) -> None:
    """A field a joint and kind of limit: the share of walking ticks in which it acted."""
    shares = limit_shares(run)
    values = np.array(list(shares.values()))
    axes.imshow(values, aspect="auto", cmap=SHADES, vmin=0.0, vmax=100.0)
    for (row, column), share in np.ndenumerate(values):
        if share >= LEAST_SHOWN:
            axes.text(column, row, f"{share:.0f}", ha="center", va="center", fontsize=7)
    names = [joint.replace("_", " ") for joint in run.joints]
    axes.set_xticks(np.arange(len(names)), names, rotation=60, ha="right", fontsize=7)
    for label, joint in zip(axes.get_xticklabels(), run.joints, strict=True):
        label.set_color(side_colour(joint))
    axes.set_yticks(np.arange(len(shares)), list(shares))
    axes.grid(visible=False)
    axes.set_title("Walking ticks in which a limit acted [%]")


def limit_shares(run: PlottedRun) -> dict[str, Floats]:
    """Share of walking ticks in which each kind of limit acted [%], (n,) each."""
    rows = run.rows
    flags = rows["applied"]["limit"][(rows["time_s"] >= 0) & rows["safety"]["walking"]]
    kinds = [limit for limit in Limit if limit not in (Limit.NONE, Limit.HELD)]
    count = max(1, len(flags))
    return {
        str(kind.name).lower(): 100.0 * ((flags & int(kind)) != 0).sum(axis=0) / count
        for kind in kinds
    }
