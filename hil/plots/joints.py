"""Every joint against its target over the last seconds of the walk."""

import numpy as np
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, RIGHT, WARNING
from hil.interface import Floats, Limit
from hil.plots.plotted_run import PlottedRun

COLUMNS = 6
SHOWN_S = 2.0


def side_colour(joint: str) -> str:
    """The colour of a joint's side."""
    return LEFT if joint.startswith("left_") else RIGHT if joint.startswith("right_") else BODY


def tracking_height(run: PlottedRun) -> float:
    """Height of the figure [in]."""
    return 2.1 * -(-len(run.joints) // COLUMNS) + 0.4


def draw_tracking(figure: Figure, run: PlottedRun) -> None:
    """Targets dashed, measured angles as lines; titles have the rms error of the whole walk."""
    lines = -(-len(run.joints) // COLUMNS)
    panels = figure.subplots(lines, COLUMNS, sharex=True, squeeze=False)
    rows = run.last[run.last["time_s"] >= run.last["time_s"][-1] - SHOWN_S]
    errors = tracking_errors(run)
    for place, axes in enumerate(panels.flat):
        if place >= len(run.joints):
            axes.set_visible(False)
            continue
        joint = run.joints[place]
        goal, angle = rows["applied"]["position"][:, place], rows["frame"]["joint_position"]
        if _has_goal(rows["applied"]["stiffness"][:, place]):
            axes.plot(rows["time_s"], np.degrees(goal), color=WARNING, ls="--", lw=1.0)
        axes.plot(rows["time_s"], np.degrees(angle[:, place]), color=side_colour(joint), lw=1.2)
        error = f", {errors[place]:.1f}°" if np.isfinite(errors[place]) else ""
        axes.set_title(joint.replace("_", " ") + error, fontsize=9)
        axes.margins(x=0)
        if place % COLUMNS == 0:
            axes.set_ylabel("[°]")
        if place + COLUMNS >= len(run.joints):
            axes.set_xlabel("time [s]")


def tracking_errors(run: PlottedRun) -> Floats:
    """Root mean square of target minus angle over the walk [°], (n,); NaN without targets."""
    rows = run.rows
    walking = rows[(rows["time_s"] >= 0) & rows["safety"]["walking"]]
    error = walking["applied"]["position"] - walking["frame"]["joint_position"]
    goals = (walking["applied"]["stiffness"] > 0) & (
        (walking["applied"]["limit"] & int(Limit.HELD)) == 0
    )
    counts = goals.sum(axis=0)
    with np.errstate(invalid="ignore"):
        squares = np.where(goals, error**2, 0.0).sum(axis=0) / counts
    return np.asarray(np.degrees(np.sqrt(squares)))


def _has_goal(stiffness: Floats) -> bool:
    """A joint of stiffness 0 takes torques alone."""
    return bool((stiffness > 0).any())
