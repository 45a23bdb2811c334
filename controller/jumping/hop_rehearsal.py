"""The hop of a servo robot before anything moves: its gesture in time, and the torques."""

from dataclasses import dataclass
from itertools import pairwise

import mujoco
import numpy as np

from controller.jumping.hop_gesture import HopGesture
from controller.jumping.hop_settings import HopSettings
from controller.jumping.jump_curves import RATE, JumpCurves
from controller.jumping.jump_plan import JumpPlan
from controller.jumping.path import JumpTarget, estimate_path
from controller.jumping.posture import Posture, standing
from controller.jumping.whole_body import BodyTask, WholeBody
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats
from hil.smoothstep import smoothstep

INERT = 1e9
"""Slack that lets a row of `WholeBody` do nothing."""
NOWHERE_WEIGHT = 1e-3
"""The root gives way where the ground cannot give what a motion needs, the joints do not."""
STEP = 1e-4
"""Share of the push over which velocities are differences."""


@dataclass(frozen=True, slots=True)
class HopCurves(JumpCurves):
    """With what the joints are told in the air."""

    drawn_up: Floats
    """Goals of the joints in the air [rad], (n,)."""
    landed: Floats
    """And where they come to rest after it [rad], (n,)."""
    ahead: int
    """So many steps before the end the knees get theirs."""
    landing_steps: int
    """Of the way from the one to the other."""
    return_steps: int
    """Of the way from there back to the start pose."""


def rehearse_hop(
    description: RobotDescription, target: JumpTarget, settings: HopSettings | None = None
) -> HopCurves:
    """Windup and push of a hop on the spot.

    The gesture is played so fast that the centre of mass leaves with the velocity of the path,
    v = ½·g·t − d/t, d being how much lower it is over the soles at touch-down than at take-off,
    since the legs are drawn up. Torques are those of the equations of motion, with
    reflected rotors, on the ground's forces that this motion needs. Raises InputError for a target
    that is not the spot, or a push that has no room.
    """
    settings = settings or HopSettings()
    if any(target.displacement):
        raise InputError("--target: a robot with servos hops on the spot: X, Y and Z must be 0")
    body = WholeBody(description, target.gravity)
    robot = body.robot
    gesture = HopGesture(description, robot, settings, target.push_depth)
    end, before = gesture.shape(1.0), gesture.shape(1.0 - STEP)
    rate = (gesture.height(end) - gesture.height(before)) / STEP
    shift = (0.0, 0.0, -settings.drop * robot.leg_length)
    gesture.height(gesture.shape(0.0))
    path = estimate_path(target, robot.mass, start=robot.com.copy(), posture_shift=shift)
    duration = rate / float(path.take_off_velocity[2])
    still = np.zeros(3)
    plan = JumpPlan(path, path.start, still, still)
    pace = float(np.sqrt(target.gravity / robot.leg_length))
    postures = _windup(description, body, gesture, settings, pace)
    begin = len(postures)
    steps = round(duration * RATE)
    postures += [gesture.posture(gesture.shape(k / steps)) for k in range(1, steps + 1)]
    heel = begin + settings.heel_begin * steps
    position, velocity, torque, com = _inverse(body, postures, heel)
    low, high = np.array([joint.range for joint in description.joints]).T
    air, rest = (
        np.clip(gesture.posture(shape).joint_position, low, high)
        for shape in (gesture.drawn_up(), gesture.landed())
    )
    times = (settings.draw_up_ahead, settings.landing_time, settings.return_time)
    return HopCurves(
        position,
        velocity,
        torque,
        com,
        begin,
        plan,
        air,
        rest,
        *(round(time / pace * RATE) for time in times),
    )


def _windup(
    description: RobotDescription,
    body: WholeBody,
    gesture: HopGesture,
    settings: HopSettings,
    pace: float,
) -> list[Posture]:
    """From the start pose to the crouch, and the pause there, a posture a step."""
    start = np.array(description.start_position)
    crouch = gesture.posture(gesture.shape(0.0))
    steps = round(settings.windup_time / pace * RATE)
    way = crouch.joint_position - start
    down = [standing(body.robot, start + smoothstep(k / steps) * way) for k in range(steps)]
    return down + [crouch] * (1 + round(settings.pause / pace * RATE))


def _inverse(
    body: WholeBody, postures: list[Posture], heel: float
) -> tuple[Floats, Floats, Floats, Floats]:
    """Positions, velocities and torques of the joints and the way of the centre of mass.

    From step `heel` on the ground only touches the front edges of the soles. Velocities are
    differences over one step, accelerations of these.
    """
    robot, model = body.robot, body.robot.model
    places = []
    for posture in postures:
        robot.set_state(posture)
        places.append(robot.data.qpos.copy())
    speeds = np.zeros((len(places) + 1, model.nv))
    for step, (here, there) in enumerate(pairwise(places)):
        mujoco.mj_differentiatePos(model, speeds[step + 1], 1.0 / RATE, here, there)
    accelerations = np.diff(speeds, axis=0) * RATE
    velocities = speeds[:-1]
    weight = np.ones(model.nv)
    weight[body.base] = NOWHERE_WEIGHT
    task = BodyTask(model.nv, weight)
    task.foot_slack = task.level_slack = INERT
    v, joints = robot.base_dof, robot.dof_addresses
    torques, com = [], []
    for step, posture in enumerate(postures):
        posture.base_linear_velocity = velocities[step, v : v + 3]
        posture.base_angular_velocity = velocities[step, v + 3 : v + 6]
        posture.joint_velocity = velocities[step, joints]
        body.set_state(posture)
        task.bearing[:] = True
        task.bearing[:, 2:] = step < heel
        _press(body, task, accelerations[min(step, len(postures) - 2)])
        torques.append(body.torques(task))
        com.append(robot.com.copy())
    position = np.array([posture.joint_position for posture in postures])
    return position, velocities[:, joints], np.array(torques), np.array(com)


def _press(body: WholeBody, task: BodyTask, acceleration: Floats) -> None:
    """Ask for the ground's force and its moment about the centre of mass that a motion needs."""
    robot, base = body.robot, body.base
    load = body.mass_matrix[base] @ acceleration + body.bias[base]
    task.force[:] = load[:3]
    arm = robot.com - robot.root_position
    task.moment[:] = robot.root_rotation @ load[3:] - np.cross(arm, load[:3])
    task.posture[:] = acceleration
