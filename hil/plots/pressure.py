"""Where the load acts in the sole, against the band in which every side carries 15 %."""

import mujoco
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hil.description import RobotDescription
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, WARNING
from hil.gait_report import SIDE_SHARE, disequilibrium_ticks
from hil.interface import SIDES, Bools, Floats
from hil.plots.plotted_run import LAST_S, PlottedRun
from hil.trace import Trace

SIDE_NAMES = ("left", "right", "front", "rear")
MOST_POINTS = 4000


def draw_pressure(figure: Figure, run: PlottedRun) -> None:
    """Both soles from above, and the load shares of the stance foot's sides over time."""
    left, right, shares = figure.subplots(1, 3, width_ratios=(1, 1, 2.6))
    trace = run.trace
    counted, _ = disequilibrium_ticks(trace, run.meta["weight_n"])
    sides = side_shares(trace)
    for foot, axes in enumerate((left, right)):
        own = counted & (trace.stance == foot)
        _draw_sole(axes, foot, sides[own], half_sizes(run.description, foot))
    _draw_shares(shares, trace, sides, counted)


def side_shares(trace: Trace) -> Floats:
    """Share of the stance foot's load on its left, right, front and rear side, (T, 4).

    Front and rear count the toe with the front, left and right leave it out, as the seed's measure
    of disequilibrium does (000_bd1305a0ae731442). NaN where the foot carries nothing.
    """
    ticks = np.arange(len(trace))
    corners, toe = trace.foot_force[ticks, trace.stance], trace.toe_force[ticks, trace.stance]
    front_left, front_right, rear_left, _ = corners.T
    sole = corners.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        left = (front_left + rear_left) / sole
        front = (front_left + front_right + toe) / (sole + toe)
    return np.column_stack((left, 1.0 - left, front, 1.0 - front))


def half_sizes(description: RobotDescription, foot: int) -> tuple[float, float]:
    """Half length and half width of a sole [m]."""
    model = mujoco.MjModel.from_xml_path(str(description.model_path))
    sole = description.feet["right" if foot else "left"].sole
    sizes = model.geom_size[model.geom(sole).id]
    return float(sizes[0]), float(sizes[1])


def _draw_sole(axes: Axes, foot: int, sides: Floats, half: tuple[float, float]) -> None:
    """The centre of pressure of a sole whose corners carry: their shares times its half sizes."""
    length, width = 1e3 * half[0], 1e3 * half[1]
    side = SIDES[foot].capitalize()
    x, y = length * (2.0 * sides[:, 2] - 1.0), width * (2.0 * sides[:, 0] - 1.0)
    outside = sides.min(axis=1, initial=1.0) < SIDE_SHARE
    every = max(1, len(x) // MOST_POINTS)
    for chosen, colour in ((~outside, (LEFT, RIGHT)[foot]), (outside, WARNING)):
        axes.plot(y[chosen][::every], x[chosen][::every], ".", ms=2.5, color=colour, alpha=0.35)
    band = 1.0 - 2.0 * SIDE_SHARE
    for share, line in ((1.0, "-"), (band, "--")):
        corner = (-share * width, -share * length)
        size = (2 * share * width, 2 * share * length)
        axes.add_patch(Rectangle(corner, *size, fill=False, ec=BODY, ls=line, lw=1.2))
    left_over = 100.0 * float(outside.mean()) if len(outside) else 0.0
    axes.set(title=f"{side} sole, {left_over:.1f} % out", xlabel="to the left [mm]", aspect="equal")
    axes.set(xlim=(1.25 * width, -1.25 * width), ylim=(-1.1 * length, 1.1 * length))
    if foot == 0:
        axes.set_ylabel("to the front [mm]")


def _draw_shares(axes: Axes, trace: Trace, sides: Floats, counted: Bools) -> None:
    shown = trace.time_s >= trace.time_s[-1] - LAST_S
    time = trace.time_s[shown]
    colours = (LEFT, RIGHT, BODY, "#8a9a5b")
    for column, (name, colour) in enumerate(zip(SIDE_NAMES, colours, strict=True)):
        share = np.where(counted, sides[:, column], np.nan)[shown]
        axes.plot(time, 100.0 * share, color=colour, linewidth=1.0, label=name)
    axes.axhspan(0, 100.0 * SIDE_SHARE, color=WARNING, alpha=0.08, linewidth=0)
    axes.axhline(100.0 * SIDE_SHARE, color=LIMIT, linestyle=":", linewidth=1.0)
    axes.set(title="Share of the stance foot's load, after foot-flat", xlabel="time [s]")
    axes.set(ylabel="[%]", ylim=(0, 115), xlim=(time[0], time[-1]))
    axes.legend(loc="upper right", ncols=4)
