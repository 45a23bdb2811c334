"""The windup and the push of a jump, computed before anything moves: what every joint would do."""

import mujoco
import numpy as np

from controller.estimation.sensors import empty_estimate
from controller.jumping.flight import Flight
from controller.jumping.hop_rehearsal import rehearse_hop
from controller.jumping.jump_controller import JumpController
from controller.jumping.jump_curves import RATE, JumpCurves
from controller.jumping.path import JumpTarget
from controller.jumping.posture import standing
from controller.jumping.thrust import Push
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Estimate, Floats, Reference

LONGEST_S = 6.0
"""No windup and push take longer."""


def rehearse(description: RobotDescription, target: JumpTarget) -> JumpCurves:
    """Windup and push with the jump's own law on a body that does exactly what it is asked.

    No contacts, no friction, no motors: the accelerations that the law finds are integrated, the
    feet held by it. So the curves are the plan's own, and cost no simulation. Robots with servos
    have `rehearse_hop`. Raises InputError for a jump that has no path, or that topples the body.
    """
    if description.actuation == "servo":
        return rehearse_hop(description, target)
    controller = JumpController(description, RATE, target)
    robot, reference = controller.body.robot, Reference()
    estimate = _standing_estimate(robot, description)
    columns: tuple[list[Floats], ...] = ([], [], [], [])
    push_begin = 0
    for step in range(round(LONGEST_S * RATE)):
        controller.step(estimate, reference)
        if isinstance(controller.stage, Flight):
            break
        if not controller.status.walking:
            raise InputError("the body loses its balance before it leaves the ground")
        if isinstance(controller.stage, Push) and not push_begin:
            push_begin = step
        row = (estimate.joint_position, estimate.joint_velocity, controller.asked, robot.com)
        for column, values in zip(columns, row, strict=True):
            column.append(values.copy())
        _integrate(robot, controller.body.acceleration, estimate)
    if controller.plan is None:  # a windup of no steps
        raise InputError("the jump has no windup")
    position, velocity, torques, com = (np.array(column) for column in columns)
    return JumpCurves(position, velocity, torques, com, push_begin, controller.plan)


def _standing_estimate(robot: RobotModel, description: RobotDescription) -> Estimate:
    """At rest in the start pose, on both feet."""
    estimate = empty_estimate(len(description.joints))
    estimate.contact[:] = True
    start = standing(robot, np.array(description.start_position))
    estimate.base_position[:] = start.base_position
    estimate.base_orientation[:] = start.base_orientation
    estimate.joint_position[:] = start.joint_position
    return estimate


def _integrate(robot: RobotModel, acceleration: Floats, estimate: Estimate) -> None:
    """One step from the model's state, into the estimate."""
    data, q, v = robot.data, robot.base_qpos, robot.base_dof
    data.qvel[:] += acceleration / RATE
    mujoco.mj_integratePos(robot.model, data.qpos, data.qvel, 1.0 / RATE)
    estimate.base_position[:] = data.qpos[q : q + 3]
    estimate.base_orientation[:] = data.qpos[q + 3 : q + 7]
    estimate.joint_position[:] = data.qpos[robot.qpos_addresses]
    estimate.base_linear_velocity[:] = data.qvel[v : v + 3]
    estimate.base_angular_velocity[:] = data.qvel[v + 3 : v + 6]
    estimate.joint_velocity[:] = data.qvel[robot.dof_addresses]
