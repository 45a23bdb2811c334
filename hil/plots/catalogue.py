"""Every plot of a run: its name, its heading, what it says, and when there is something to draw."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import STYLE
from hil.figures import draw_run_figure
from hil.plots.gait import draw_gait
from hil.plots.joints import draw_tracking, tracking_height
from hil.plots.plotted_run import PlottedRun
from hil.plots.pressure import draw_pressure
from hil.plots.servos import draw_servos, has_servos
from hil.plots.speed import draw_speeds
from hil.plots.supervision import draw_supervision
from hil.plots.timing import draw_timing_parts
from hil.plots.torque import draw_torque, torque_height
from hil.plots.water import draw_water, is_wet

WIDTH_IN = 12.0


def _walked(run: PlottedRun) -> bool:
    return run.walked


@dataclass(frozen=True, slots=True)
class Plot:
    """One plot of a run."""

    heading: str
    caption: str
    """How to read it."""
    draw: Callable[[Figure, PlottedRun], None]
    height: Callable[[PlottedRun], float]
    """[in]"""
    applies: Callable[[PlottedRun], bool] = _walked


def _inches(height: float) -> Callable[[PlottedRun], float]:
    return lambda _: height


PLOTS: Mapping[str, Plot] = {
    "walk": Plot(
        "The walk",
        "Two strides from the side, and at a glance whether it went as it was told to.",
        lambda figure, run: draw_run_figure(figure, run.trace, run.description, run.meta),
        _inches(8.4),
    ),
    "speed": Plot(
        "Speed and heading",
        "Dashed: what was commanded. Within a stride: the mean over all strides after the first "
        "5 s, and the learnt curve of a controller that has one.",
        draw_speeds,
        _inches(5.0),
    ),
    "gait": Plot(
        "Gait",
        "The darker, the more a corner carries; full colour is half the weight. A foot carries "
        "where its load is above 5 % of the weight.",
        draw_gait,
        _inches(3.4),
    ),
    "pressure": Plot(
        "Pressure in the soles",
        "Where the load acts in the stance foot after foot-flat. Dashed: inside, each side carries "
        "15 % of the load or more; dots outside are red.",
        draw_pressure,
        _inches(3.6),
    ),
    "joints": Plot(
        "Joint tracking",
        "Dashed: the target that was sent. Titles: rms error over the walk.",
        draw_tracking,
        tracking_height,
    ),
    "torque": Plot(
        "Torque against limits",
        "Measured torque and speed of both sides. Dotted: what the actuator can do, of a servo at "
        "the lowest supply of the run. Titles: rms over the walk, of the torque at standstill.",
        draw_torque,
        torque_height,
    ),
    "servos": Plot(
        "Servos", "Of real servos measured, of virtual ones modelled.", draw_servos,
        _inches(2.8), has_servos,
    ),
    "timing": Plot(
        "Timing",
        "Wall times are this computer's, ages are on the robot's own clock. Dotted: the period.",
        draw_timing_parts,
        _inches(3.0),
        lambda run: len(run.rows) > 1,
    ),
    "safety": Plot(
        "Supervisor and limits",
        "Limits act on commands on their way to the actuators; saturation is the servo's own.",
        draw_supervision,
        _inches(3.2),
        lambda run: len(run.rows) > 1,
    ),
    "water": Plot(
        "Liquid", "What the robot was told of the liquid around it.", draw_water, _inches(2.8),
        lambda run: run.walked and is_wet(run),
    ),
}  # fmt: skip


def draw_plot(name: str, run: PlottedRun, target: Path | BinaryIO, dpi: int = 110) -> None:
    """Write one plot to a file whose suffix says the format, or as PNG to a stream."""
    plot = PLOTS[name]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH_IN, plot.height(run)), layout="constrained")
        plot.draw(figure, run)
        figure.savefig(target, dpi=dpi)
