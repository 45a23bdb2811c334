"""The picture of a run: the walk from the side, speed, corner forces, timing."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.description import RobotDescription
from hil.figure_robot import Outline
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, STYLE, WARNING, WATER
from hil.gait_report import gait_figures
from hil.interface import CORNERS, Floats
from hil.report_words import ON_THE_GROUND
from hil.trace import Trace

INSTANTS = 10
STRIP_STEPS = 4
FORCE_WINDOW_S = 4.0


def draw_run(trace: Trace, description: RobotDescription, meta: dict[str, Any], path: Path) -> None:
    """Write the picture of a run to a file whose suffix says the format."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(12, 8.4), layout="constrained")
        draw_run_figure(figure, trace, description, meta)
        figure.savefig(path, dpi=130)


def draw_run_figure(
    figure: Figure, trace: Trace, description: RobotDescription, meta: dict[str, Any]
) -> None:
    """The picture of a run in a figure that is empty."""
    grid = figure.add_gridspec(3, 6, height_ratios=(1.25, 1, 1))
    draw_strip(figure.add_subplot(grid[0, :]), trace, description)
    draw_speed(figure.add_subplot(grid[1, :4]), trace)
    draw_timing(figure.add_subplot(grid[1, 4:]), trace, meta)
    left, right = figure.add_subplot(grid[2, :3]), figure.add_subplot(grid[2, 3:])
    for foot, axes in enumerate((left, right)):
        draw_corners(axes, trace, foot, meta["weight_n"])
    right.sharey(left)
    right.set_ylabel("")
    figure.suptitle(title(trace, meta), x=0.01, ha="left", fontsize=12, fontweight="bold")


def title(trace: Trace, meta: dict[str, Any]) -> str:
    """What the picture shows, in one line."""
    figures = gait_figures(trace, meta["weight_n"])
    what = f"{meta['robot']}, {meta['rung']}, {meta['rate_hz']} Hz, seed {meta['seed']}: "
    duration = f"{trace.time_s[-1]:.0f} s"
    if meta["rung"] not in ON_THE_GROUND:
        return f"{what}{figures['steps']} steps in {duration}"
    return (
        f"{what}{figures['steps']} steps, {figures['distance_m']:.2f} m in {duration}, "
        f"{figures['mean_speed_mps']:.3f} m/s (commanded {figures['target_speed_mps']:.3f})"
    )


def draw_strip(axes: Axes, trace: Trace, description: RobotDescription) -> None:
    """Outlines at instants of two strides, set apart so that each can be seen."""
    outline = Outline(description)
    ticks = strip_ticks(trace)
    height = float(trace.base_position[ticks, 2].max())
    spacing = 1.15 * height
    for place, tick in enumerate(ticks):
        outline.draw(axes, trace, int(tick), place * spacing)
        label = f"{trace.time_s[tick]:.2f} s"
        _draw_water(axes, place * spacing, 0.45 * spacing, float(trace.water_level[tick]))
        axes.text(place * spacing, -0.12 * height, label, ha="center", va="top", color=LIMIT)
    axes.axhline(0.0, color="#9a9ea4", linewidth=1.0, zorder=0)
    axes.set_xlim(-0.75 * spacing, (len(ticks) - 0.25) * spacing)
    axes.set_aspect("equal")
    axes.autoscale_view(scalex=False)
    axes.set_ylim(-0.3 * height, None)
    axes.axis("off")
    for place, (name, colour) in enumerate((("left", LEFT), ("right", RIGHT))):
        axes.text(0.0, 0.97 - 0.1 * place, name, color=colour, transform=axes.transAxes, va="top")


def _draw_water(axes: Axes, centre: float, half: float, level: float) -> None:
    """The liquid around one outline, its surface a line; nothing on dry land [m]."""
    if level > 0:
        sides = (centre - half, centre + half)
        axes.fill_between(sides, 0.0, level, color=WATER, alpha=0.3, linewidth=0, zorder=8)
        axes.plot(sides, (level, level), color=WATER, linewidth=1.2, zorder=8)


def strip_ticks(trace: Trace) -> np.ndarray:
    """Ticks of evenly spaced instants over two strides after half of the walk."""
    steps = trace.steps
    first = int(np.searchsorted(steps, steps[len(steps) // 2]))
    last = int(np.searchsorted(steps, steps[first] + STRIP_STEPS))
    if steps[-1] < steps[first] + STRIP_STEPS:
        first, last = 0, len(trace) - 1
    return np.linspace(first, min(last, len(trace) - 1), INSTANTS).astype(int)


def draw_speed(axes: Axes, trace: Trace) -> None:
    """COM speed along the heading, raw and over a stride, and what was commanded."""
    along = forward_speed(trace)
    axes.plot(trace.time_s, along, color="#c9ccd1", linewidth=0.8, label="centre of mass")
    axes.plot(trace.time_s, over_a_stride(trace, along), color=BODY, label="over one stride")
    axes.plot(trace.time_s, trace.speed, color=WARNING, linestyle="--", label="commanded")
    axes.set(title="Speed along the heading", xlabel="time [s]", ylabel="[m/s]")
    low, high = axes.get_ylim()
    axes.margins(x=0)
    axes.set_ylim(low - 0.15 * (high - low), high)  # room for the legend
    axes.legend(loc="lower right", ncols=3)


def forward_speed(trace: Trace) -> Floats:
    """COM speed along the commanded heading [m/s], shape (T,)."""
    vx, vy = trace.com_velocity[:, 0], trace.com_velocity[:, 1]
    return vx * np.cos(trace.heading) + vy * np.sin(trace.heading)


def over_a_stride(trace: Trace, values: Floats) -> Floats:
    """Moving mean over two mean step times, shortened at both ends."""
    steps = int(trace.steps[-1])
    window = max(1, round(2 * len(trace) / steps)) if steps else 1
    totals = np.concatenate(([0.0], np.cumsum(values)))
    ticks = np.arange(len(values))
    begin = np.maximum(ticks - window // 2, 0)
    end = np.minimum(ticks + window // 2 + 1, len(values))
    return np.asarray((totals[end] - totals[begin]) / (end - begin))


def draw_corners(axes: Axes, trace: Trace, foot: int, weight_n: float) -> None:
    """The four corner forces of a foot at the end of the walk, and their sum."""
    window = trace.time_s >= trace.time_s[-1] - FORCE_WINDOW_S
    time, forces = trace.time_s[window], trace.foot_force[window, foot]
    total = forces.sum(axis=1) + trace.toe_force[window, foot]
    axes.fill_between(time, total, color="#eceef0", label="sum")
    for corner, colour in enumerate((LEFT, RIGHT, "#e9b872", "#7fb2cf")):
        axes.plot(time, forces[:, corner], color=colour, linewidth=1.0)
        axes.plot([], [], color=colour, label=CORNERS[corner].replace("_", " "))
    axes.axhline(weight_n, color=LIMIT, linestyle=":", linewidth=1.0)
    axes.text(time[0], weight_n, " weight", fontsize=8, color=LIMIT, va="bottom")
    side = ("Left", "Right")[foot]
    axes.set(title=f"{side} foot: corner forces", xlabel="time [s]", ylabel="[N]")
    axes.margins(x=0)
    axes.set_ylim(0, 1.15 * float(trace.foot_force.sum(axis=2)[window].max(initial=weight_n)))
    axes.legend(loc="upper right", ncols=5, fontsize=7, handlelength=1.2, columnspacing=0.9)


def draw_timing(axes: Axes, trace: Trace, meta: dict[str, Any]) -> None:
    """Histograms of the wall time of the controller's step and of the whole tick."""
    period_ms = 1e3 / meta["rate_hz"]
    columns = (("controller", trace.control_ns, LEFT), ("whole tick", trace.cycle_ns, RIGHT))
    lowest = max(1e-3, min(float(values.min()) for _, values, _ in columns) * 1e-6)
    highest = max(float(values.max()) for _, values, _ in columns) * 1e-6
    bins = np.geomspace(lowest, max(highest, 2 * period_ms) * 1.05, 70).tolist()
    for label, values, colour in columns:
        axes.hist(values * 1e-6, bins=bins, color=colour, alpha=0.75, label=label)
    axes.set_ylim(0, 1.3 * axes.get_ylim()[1])  # room for the legend
    axes.axvline(period_ms, color=LIMIT, linestyle=":", linewidth=1.0)
    clock = "lockstep" if meta["lockstep"] else "real time"
    axes.set(xscale="log", title=f"Wall time of a tick ({clock})", xlabel="[ms]", ylabel="ticks")
    axes.annotate(
        "period", (period_ms, 0.97), xycoords=("data", "axes fraction"), rotation=90,
        ha="right", va="top", fontsize=8, color=LIMIT,
    )  # fmt: skip
    axes.legend(loc="upper left")
