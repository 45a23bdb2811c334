"""The liquid in which a robot walked."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import BODY, LIMIT, WATER
from hil.figures import forward_speed
from hil.plots.plotted_run import PlottedRun


def is_wet(run: PlottedRun) -> bool:
    """Whether there was any liquid."""
    return bool(run.rows["reference"]["water_level"].any())


def draw_water(figure: Figure, run: PlottedRun) -> None:
    """Level with the height of the root body, and the speed against the level."""
    level, speed = figure.subplots(1, 2, width_ratios=(3, 2))
    _draw_level(level, run)
    _draw_speed(speed, run)


def _draw_level(axes: Axes, run: PlottedRun) -> None:
    rows = run.rows
    levels = rows["reference"]["water_level"]
    axes.fill_between(run.time_s, levels, color=WATER, alpha=0.6, linewidth=0, label="level")
    root = rows["truth" if "truth" in (rows.dtype.names or ()) else "estimate"]["base_position"]
    axes.plot(run.time_s, root[:, 2], color=BODY, linewidth=1.0, label="root body")
    last = rows["reference"][-1]
    facts = f"{last['liquid_density']:.0f} kg/m³, viscosity × {last['liquid_viscosity']:g}"
    axes.text(0.02, 0.05, facts, transform=axes.transAxes, fontsize=8, color=LIMIT)
    axes.set(title="Liquid above the floor", xlabel="time [s]", ylabel="[m]")
    axes.set_ylim(0, 1.25 * float(max(levels.max(), root[:, 2].max())))
    axes.margins(x=0)
    axes.legend(loc="upper right", ncols=2)


def _draw_speed(axes: Axes, run: PlottedRun) -> None:
    """Mean speed of every step against the level it was walked in."""
    rows, trace = run.rows, run.trace
    walking = (rows["time_s"] >= 0) & rows["safety"]["walking"]
    levels = rows["reference"]["water_level"][walking]
    begins = np.flatnonzero(np.diff(trace.steps, prepend=trace.steps[0] - 1))
    counts = np.diff(np.append(begins, len(trace)))
    mean = [np.add.reduceat(values, begins) / counts for values in (levels, forward_speed(trace))]
    axes.plot(*mean, "o", ms=4, color=BODY, alpha=0.7)
    axes.set(title="Speed of every step against the level", xlabel="[m]", ylabel="[m/s]")
