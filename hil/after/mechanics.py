"""What a recording says of every servo's mechanics: dry friction and rotor inertia."""

from dataclasses import dataclass

import numpy as np

from hil.after.fitting import fit
from hil.after.load_model import LoadModel
from hil.after.measured_motion import measured_motion
from hil.after.motor_signs import MotorSigns
from hil.after.recorded import RecordedRun
from hil.after.smoothing import parabolas, smooth
from hil.body_motion import BodyMotion
from hil.interface import Floats

MOVING = (0.1, 0.2)
"""A joint must turn faster than this [rad/s] for such a share of the time."""
UPRIGHT = 0.7
"""A joint whose axis is so far along the vertical."""
REVERSAL_SPEED = 0.05
"""Friction changes its sign over this speed [rad/s]: two grains of the measured velocity."""


@dataclass(frozen=True, slots=True)
class Mechanics:
    """Found values and their standard deviations, shape (n,) each, and what led to them."""

    friction: tuple[Floats, Floats]
    """[N·m]"""
    inertia: tuple[Floats, Floats]
    """[kg·m²]"""
    motion: BodyMotion
    torques: Floats
    """Torques that are left for rotor, friction and whatever the model has wrong [N·m], (T, n)."""
    excess: Floats
    """The same without the found rotor and friction, (T, n)."""
    table: tuple[Floats, Floats, Floats]
    """Joint angles, speeds and accelerations, (T, n) each."""


def mechanics(run: RecordedRun, model: LoadModel, motors: MotorSigns) -> Mechanics:
    """Signs of every joint.

    The motor's torque, which is the measured current times the found torque constant, less what
    the robot's model needs for the measured movement, is J·q̈ + f·sgn q̇ + rest: least squares over
    all steady ticks, everything through the same smoothing. How a sole twists against the floor
    no load cell measures: of joints that turn about the vertical nothing is said (NaN), nor of
    joints that hardly move.
    """
    rows, rate_hz = run.steady, run.rate_hz
    motion = measured_motion(rows, rate_hz, model.mass)
    angles, speeds, accelerations = parabolas(rows["frame"]["joint_position"], rate_hz)
    constant = np.nan_to_num(motors.torque_constant[0], nan=1.0)
    needed = model.torques(motion, angles, speeds, accelerations)
    left = smooth(rows["frame"]["joint_torque"] * constant - needed, rate_hz)
    bends = smooth(accelerations, rate_hz)
    signs = smooth(np.tanh(rows["frame"]["joint_velocity"] / REVERSAL_SPEED), rate_hz)
    one = np.ones(len(rows))
    values, deviations = np.empty((2, angles.shape[1], 3))
    excess = left.copy()
    for joint in range(angles.shape[1]):
        table = np.column_stack((signs[:, joint], bends[:, joint], one))
        values[joint], deviations[joint] = fit(table, left[:, joint])
        excess[:, joint] -= table[:, :2] @ values[joint, :2]
    unknown = np.abs(model.turning_axes()[:, 2]) > UPRIGHT
    unknown |= (np.abs(speeds) > MOVING[0]).mean(axis=0) < MOVING[1]
    values[unknown], deviations[unknown] = np.nan, np.inf
    friction, inertia = ((values[:, i], deviations[:, i]) for i in (0, 1))
    return Mechanics(friction, inertia, motion, left, excess, (angles, speeds, accelerations))
