"""Speed and heading against what was asked for, and the speed within a step."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.compare import STRIDE_BINS, stride_profile
from hil.figure_style import BODY, LEFT, RIGHT, WARNING
from hil.figures import draw_speed, forward_speed
from hil.plots.plotted_run import PlottedRun
from hil.trace import Trace


def draw_speeds(figure: Figure, run: PlottedRun) -> None:
    """Sagittal speed, heading, and the mean speed over the phase of a stride."""
    grid = figure.add_gridspec(2, 3)
    top = figure.add_subplot(grid[0, :])
    bottom, within = figure.add_subplot(grid[1, :2]), figure.add_subplot(grid[1, 2])
    draw_speed(top, run.trace)
    _draw_heading(bottom, run.trace)
    _draw_within(within, run)


def _draw_heading(axes: Axes, trace: Trace) -> None:
    yaw = np.degrees(trace.yaw)
    axes.plot(trace.time_s, yaw, color=BODY, linewidth=1.0, label="root body")
    axes.plot(trace.time_s, np.degrees(trace.heading), color=WARNING, ls="--", label="tracked")
    axes.set(title="Heading", xlabel="time [s]", ylabel="[°]")
    low, high = min(yaw.min(), -5.0), max(yaw.max(), 5.0)
    axes.set_ylim(low - 0.1 * (high - low), high + 0.25 * (high - low))
    axes.margins(x=0)
    axes.legend(loc="upper right", ncols=2)


def _draw_within(axes: Axes, run: PlottedRun) -> None:
    """A body on legs speeds up and slows down in every step; what the controller wants of that is
    its learnt curve, where it has one (seed 000_bd1305a0ae731442, section 3).
    """
    trace = run.trace
    stride = (np.arange(STRIDE_BINS) + 0.5) / STRIDE_BINS
    half = STRIDE_BINS // 2
    observed = stride_profile(trace, forward_speed(trace))
    for part, colour, side in ((slice(0, half), LEFT, "left"), (slice(half, None), RIGHT, "right")):
        axes.plot(stride[part], observed[part], color=colour, label=f"{side} stance")
    wanted = _wanted(run)
    if wanted is not None:
        axes.plot(stride, stride_profile(trace, wanted), color=WARNING, ls="--", label="learnt")
    else:
        axes.plot(stride, stride_profile(trace, trace.speed), color=WARNING, ls="--", label="asked")
    axes.set(title="Speed within a stride", xlabel="stride: left, right stance", ylabel="[m/s]")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.35 * (high - low))
    axes.legend(loc="upper center", ncols=3, fontsize=7, handlelength=1.2)


def _wanted(run: PlottedRun) -> np.ndarray | None:
    """Speed wanted by a learnt curve at every walking tick [m/s]; None where there is none."""
    rows = run.rows
    if "wanted_speed" not in (rows["status"].dtype.names or ()):
        return None
    walking = (rows["time_s"] >= 0) & rows["safety"]["walking"]
    wanted: np.ndarray = rows["status"]["wanted_speed"][walking]
    return wanted if np.isfinite(wanted).any() else None
