"""Joint torques that give the body a wanted ground force, from its own equations of motion."""

import mujoco
import numpy as np

from controller.jumping.ground_force import GroundForce
from controller.robot_model import BodyState, RobotModel
from hil.description import RobotDescription
from hil.interface import Bools, Floats

TINY = 1e-9
"""Keeps the system of equations regular when a robot has fallen apart from its plan."""
CARRIED = 0.9
"""Share of a joint's limit that may go into carrying the ground's force."""


class BodyTask:
    """What the body shall do in one tick; filled in anew for the next."""

    def __init__(self, nv: int, weight: Floats) -> None:
        """`weight`: how much the posture of every degree of freedom matters, (nv,)."""
        self.force = np.zeros(3)
        """Wanted ground force [N]."""
        self.moment = np.zeros(3)
        """Its moment about the centre of mass [N·m]."""
        self.bearing: Bools = np.zeros((2, 4), dtype=np.bool_)
        """Which corners may carry."""
        self.foot_acceleration = np.zeros((2, 6))
        """Angular [rad/s²] and linear [m/s²], of the feet at their ankles."""
        self.foot_slack, self.level_slack = 0.0, 0.0
        """ε of the rows of the feet and of the root's attitude: a leg that is all but straight
        cannot follow everything.
        """
        self.cautious = False
        """No foot takes more than its leg's joints can carry."""
        self.posture = np.zeros(nv)
        """Wanted acceleration of every degree of freedom, where it is free [SI]."""
        self.weight = weight


class WholeBody:
    """Inverse dynamics of a body on its feet, or in the air.

    The equations of motion are M q̈ + h = Sᵀ τ + J_cᵀ f. Their six rows of the free base say which
    accelerations go with the ground forces f; the feet move as they are told, J q̈ = a − J̇ q̇; the
    root turns as it should, ω̇ = α. Of all accelerations that satisfy these rows A q̈ = b, each as
    far as its slack ε says, the one nearest to the wanted posture q̈₀ is taken,

        q̈ = q̈₀ + W⁻¹ Aᵀ (A W⁻¹ Aᵀ + ε)⁻¹ (b − A q̈₀),

    and the joints' rows give the torques τ = M q̈ + h − J_cᵀ f: those of a joint carry everything
    distal of it, from the trunk to the foot. (The seed 004_2880d7939e94ed85, section 3.3, divides
    a torque by a mass; the row of the mass matrix is what it stands for.) In flight f = 0.
    """

    def __init__(
        self, description: RobotDescription, gravity: float, friction: float = 0.6
    ) -> None:
        """`gravity` [m/s²]; `friction` coefficient that the feet may use."""
        self.robot = robot = RobotModel(description)
        model = robot.model
        model.opt.gravity[:] = (0.0, 0.0, -gravity)
        self.gravity = gravity
        nv = model.nv
        self.mass_matrix = np.zeros((nv, nv))
        self.bias = np.zeros(nv)
        self.base = slice(robot.base_dof, robot.base_dof + 6)
        self.foot_jacobian = np.zeros((12, nv))
        """Angular and linear rows of the left foot, then the right."""
        self.foot_velocity = np.zeros((2, 6))
        """Angular [rad/s] and linear velocity of the ankles [m/s]."""
        self._turning = np.zeros((3, nv))
        """Picks the root's angular acceleration."""
        self._turning[range(3), range(robot.base_dof + 3, robot.base_dof + 6)] = 1.0
        self._momentum = np.zeros((3, nv))
        self._angular, self._linear = np.zeros((3, nv)), np.zeros((3, nv))
        self._foot_bias = np.zeros(12)
        self.corners = np.zeros((2, 4, 3))
        """Corners of the soles in the world [m]."""
        self.angular_momentum = np.zeros(3)
        """About the centre of mass [kg·m²/s]."""
        self.forces = np.zeros((2, 4, 3))
        """Corner forces of the last `torques` [N]."""
        self.ground = GroundForce(robot.mass * gravity, robot.leg_length, friction)
        self._limits = np.array([joint.torque_limit for joint in description.joints])
        self.acceleration = np.zeros(nv)
        """Of every degree of freedom, as the last `torques` asked for it."""

    def set_state(self, state: BodyState) -> None:
        """Place the model, and compute what the equations need."""
        robot, model, data = self.robot, self.robot.model, self.robot.data
        robot.set_state(state)
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, self.mass_matrix)
        mujoco.mj_rne(model, data, 0, self.bias)
        mujoco.mj_angmomMat(model, data, self._momentum, robot.root_body)
        np.dot(self._momentum, data.qvel, out=self.angular_momentum)
        self.corners[:] = robot.corner_positions
        for foot in range(2):
            rows = slice(6 * foot, 6 * foot + 6)
            point, body = robot.ankles[foot], int(robot.foot_bodies[foot])
            mujoco.mj_jac(model, data, self._linear, self._angular, point, body)
            self.foot_jacobian[rows][:3], self.foot_jacobian[rows][3:] = self._angular, self._linear
            mujoco.mj_jacDot(model, data, self._linear, self._angular, point, body)
            self._foot_bias[rows][:3] = self._angular @ data.qvel
            self._foot_bias[rows][3:] = self._linear @ data.qvel
        np.dot(self.foot_jacobian, data.qvel, out=self.foot_velocity.ravel())

    def torques(self, task: BodyTask) -> Floats:
        """Joint torques [N·m], (n,), in the order of the description."""
        base = self.base
        rows = np.vstack((self.mass_matrix[base], self.foot_jacobian, self._turning))
        feet = task.foot_acceleration.ravel() - self._foot_bias
        wanted = np.concatenate((-self.bias[base], feet, task.posture[base][3:]))
        slack = np.concatenate((np.zeros(6), np.full(12, task.foot_slack), [task.level_slack] * 3))
        pressed = np.zeros(len(self.bias))
        if task.bearing.any():
            pressed = self._press(task)
            wanted[:6] += pressed[base]
        return self._solve(task, rows, wanted, slack, pressed)

    def _press(self, task: BodyTask) -> Floats:
        """What the ground's forces put on every degree of freedom, (nv,)."""
        levers = (self.corners - self.robot.com).reshape(8, 3)
        wrench = np.concatenate((task.force, task.moment))
        forces = self.ground.spread(wrench, levers, task.bearing.ravel()).reshape(2, 4, 3)
        if task.cautious:
            self._ease(forces)
        self.forces[:] = forces
        pressed: Floats = self.foot_jacobian.T @ self._foot_wrenches(forces)
        return pressed

    def _ease(self, forces: Floats) -> None:
        """Lessen the forces under a foot, (2, 4, 3), to what its leg's joints carry.

        A knee that gives way under more lets its hip sink, and the pelvis rolls.
        """
        wrenches = self._foot_wrenches(forces).reshape(2, 6)
        for foot in range(2):
            rows = slice(6 * foot, 6 * foot + 6)
            load = (self.foot_jacobian[rows].T @ wrenches[foot])[self.robot.dof_addresses]
            forces[foot] /= max(1.0, float(np.abs(load / self._limits).max()) / CARRIED)

    def _solve(
        self, task: BodyTask, rows: Floats, wanted: Floats, slack: Floats, pressed: Floats
    ) -> Floats:
        """Torques of the accelerations nearest to the posture's that satisfy the rows."""
        spread = (rows / task.weight).T
        square = rows @ spread
        square.flat[:: len(rows) + 1] += slack + TINY
        multipliers = np.linalg.solve(square, wanted - rows @ task.posture)
        self.acceleration[:] = task.posture + spread @ multipliers
        load = self.mass_matrix @ self.acceleration + self.bias - pressed
        torques: Floats = load[self.robot.dof_addresses]
        return torques

    def _foot_wrenches(self, forces: Floats) -> Floats:
        """Moment about the ankle and force of each foot, (12,)."""
        wrenches = np.zeros((2, 6))
        wrenches[:, 3:] = forces.sum(axis=1)
        for foot in range(2):
            arms = self.corners[foot] - self.robot.ankles[foot]
            wrenches[foot, :3] = np.cross(arms, forces[foot]).sum(axis=0)
        return wrenches.ravel()
