"""Torque and speed of every joint against what its actuator can do."""

import numpy as np
from matplotlib.figure import Figure

from hil.compose import driver_motors
from hil.figure_style import LIMIT
from hil.interface import Floats
from hil.joint_gains import kinds
from hil.plots.joints import COLUMNS, side_colour
from hil.plots.plotted_run import PlottedRun

MOST_POINTS = 3000


def torque_height(run: PlottedRun) -> float:
    """Height of the figure [in]."""
    return 2.5 * -(-len(kinds(run.joints)) // COLUMNS) + 0.2


def draw_torque(figure: Figure, run: PlottedRun) -> None:
    """A panel a kind of joint: dots are ticks of the walk, dotted lines the limits.

    Of a servo they are what its motor has at full duty, ±k·V/R − (k²/R)·q̇ at the lowest supply V of
    the run; of a torque joint, the robot file's.
    """
    rows = run.rows
    walking = rows[(rows["time_s"] >= 0) & rows["safety"]["walking"]]
    every = max(1, len(walking) // MOST_POINTS)
    speed, torque = walking["frame"]["joint_velocity"], walking["frame"]["joint_torque"]
    stall, slope = _limits(run)
    used = 100.0 * np.sqrt(np.mean(torque**2, axis=0)) / stall
    groups = kinds(run.joints)
    lines = -(-len(groups) // COLUMNS)
    panels = figure.subplots(lines, COLUMNS, squeeze=False)
    for axes in panels.flat[len(groups) :]:
        axes.set_visible(False)
    for axes, (kind, places) in zip(panels.flat, groups.items(), strict=False):
        for place in places:
            colour, points = side_colour(run.joints[place]), (speed[::every], torque[::every])
            axes.plot(*(part[:, place] for part in points), ".", ms=2, color=colour, alpha=0.4)
        reach = 1.1 * float(np.abs(speed[:, places]).max(initial=0.1))
        ends = np.array([-reach, reach])
        for sign in (1.0, -1.0):
            limit = sign * stall[places].min() - slope[places].max() * ends
            axes.plot(ends, limit, color=LIMIT, linestyle=":", linewidth=1.2)
        axes.set_xlim(-reach, reach)
        axes.set_title(f"{kind.replace('_', ' ')}, rms {used[places].max():.0f} %", fontsize=9)
        axes.set_xlabel("[rad/s]")
    for axes in panels[:, 0]:
        axes.set_ylabel("torque [N·m]")


def _limits(run: PlottedRun) -> tuple[Floats, Floats]:
    """Torque at standstill [N·m] and its loss with speed [N·m·s/rad], (n,) each."""
    description = run.description
    if description.actuation == "torque" or description.supply is None:
        limits = np.array([joint.torque_limit for joint in description.joints])
        return limits, np.zeros(len(limits))
    motors = driver_motors(description)
    voltage = run.rows["frame"]["joint_voltage"]
    known = voltage[np.isfinite(voltage) & (voltage > 0)]
    lowest = float(known.min()) if known.size else description.supply.voltage
    return motors.stall_torque(lowest), motors.back_emf_damping()
