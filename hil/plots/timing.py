"""What a tick cost, part by part, and how old its measurements were."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, WARNING
from hil.interface import NEVER_NS, Floats
from hil.plots.plotted_run import PlottedRun

PARTS = ("read", "estimate", "safety", "control", "write", "truth", "cycle")
WORST_OVER_S = 0.1


def draw_timing_parts(figure: Figure, run: PlottedRun) -> None:
    """Percentiles of every part of a tick, ages of samples, and the worst ticks over time."""
    parts, ages, ticks = figure.subplots(1, 3, width_ratios=(1.2, 1, 1.4))
    _draw_parts(parts, run)
    _draw_ages(ages, run)
    _draw_ticks(ticks, run)


def _draw_parts(axes: Axes, run: PlottedRun) -> None:
    timing = run.rows["timing"]
    costs = [timing[f"{part}_ns"] * 1e-6 for part in PARTS]
    middle, high, worst = np.array([np.percentile(cost, (50, 99, 100)) for cost in costs]).T
    place = np.arange(len(PARTS))
    axes.barh(place, high, color="#c9ccd1", height=0.65, label="99 %")
    axes.barh(place, middle, color=RIGHT, height=0.65, label="median")
    axes.plot(worst, place, "|", color=WARNING, ms=11, mew=1.5, label="worst")
    axes.axvline(1e3 / run.meta["rate_hz"], color=LIMIT, linestyle=":", linewidth=1.0)
    axes.set_yticks(place, [*PARTS[:-1], "whole tick"])
    axes.set_ylim(len(PARTS) + 0.5, -0.6)  # downwards, with room for the legend
    clock = "lockstep" if run.meta["lockstep"] else "real time"
    axes.set(xscale="log", title=f"Wall time of a tick's parts ({clock})", xlabel="[ms]")
    axes.set_xlim(1e-3, None)
    axes.legend(loc="lower left", ncols=3, fontsize=7)


def _draw_ages(axes: Axes, run: PlottedRun) -> None:
    """On the robot's clock: what the buses achieved, in lockstep too."""
    frame = run.rows["frame"]
    kinds = (
        ("joints", frame["joint_age_ns"], LEFT),
        ("feet", frame["foot_age_ns"], RIGHT),
        ("IMU", frame["imu_age_ns"], BODY),
    )
    known = {name: _milliseconds(ages) for name, ages, _ in kinds}
    longest = max((float(np.percentile(ages, 99.9)) for ages in known.values() if ages.size),
                  default=1.0)  # fmt: skip
    bins = np.linspace(0.0, 1.05 * max(longest, 1e3 / run.meta["rate_hz"]), 60).tolist()
    for name, _, colour in kinds:
        if known[name].size:
            share = np.full(known[name].size, 100.0 / known[name].size)
            axes.hist(
                known[name], bins, weights=share, color=colour, histtype="step", lw=1.5, label=name
            )
    axes.axvline(1e3 / run.meta["rate_hz"], color=LIMIT, linestyle=":", linewidth=1.0)
    axes.set(title="Age of a sample at its tick", xlabel="[ms]", ylabel="[%]")
    axes.legend(loc="upper right", fontsize=7)


def _milliseconds(ages: np.ndarray) -> Floats:
    known = ages[ages < NEVER_NS // 2]
    return np.asarray(known * 1e-6)


def _draw_ticks(axes: Axes, run: PlottedRun) -> None:
    """The longest tick and the latest start of every tenth of a second."""
    window = max(1, round(WORST_OVER_S * run.meta["rate_hz"]))
    begins = np.arange(0, len(run.rows), window)
    time = run.time_s[begins]
    for name, label, colour in (("cycle_ns", "whole tick", RIGHT), ("late_ns", "late by", LEFT)):
        worst = np.maximum.reduceat(run.rows["timing"][name], begins) * 1e-6
        if worst.max() > 0:
            axes.step(time, worst, where="post", color=colour, linewidth=1.0, label=label)
    period_ms = 1e3 / run.meta["rate_hz"]
    axes.axhline(period_ms, color=LIMIT, linestyle=":", linewidth=1.0)
    axes.text(time[0], period_ms, " period", fontsize=8, color=LIMIT, va="bottom")
    axes.set(title="Worst in every 0.1 s", xlabel="time [s]", ylabel="[ms]")
    axes.set_ylim(0, 1.2 * axes.get_ylim()[1])
    axes.margins(x=0)
    axes.legend(loc="upper right", ncols=2, fontsize=7)
