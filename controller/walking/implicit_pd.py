"""Implicit PD: the whole control law, cascade included, evaluated at the end of the tick.

Stable PD (Tan, Liu, Turk 2011) applied to the linearised law of all joints together, as the low
rates of seed 000_bd1305a0ae731442 need it; the seed names it as future work.
"""

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.selection import selection
from controller.walking.joint_groups import JointGroups
from controller.walking.linear_law import LinearLaw
from controller.walking.pose_tracking import PoseTracking
from hil.interface import Floats, Ints


class ImplicitPd:
    """Torques Q' − C·a with (M + C)·a = Q' − bias + f, from the law's torques Q'.

    The law is Q = −A·q̇ − B·δq near the present state (`LinearLaw`), C = h·A + h²·B: the law's
    matrix with the gains h·kd + h²·kp. Q' is the law with errors predicted one tick ahead
    (`PoseTracking` with lead h), so that Q' − C·a is the law at the end of the tick.

    f are the generalised contact forces, observed over the last tick as M·Δq̇/h + bias − Q.
    """

    def __init__(
        self,
        robot: RobotModel,
        groups: JointGroups,
        tracking: PoseTracking,
        others: Ints,
        dt: float,
    ) -> None:
        self._robot, self._dt = robot, dt
        self._law = LinearLaw(robot, groups, tracking, others)
        nv = robot.model.nv
        self._dofs = selection(robot.dof_addresses)
        self._gain = (dt * tracking.damping + dt * dt * tracking.stiffness)[:, None, :]
        self._mass = np.zeros((nv, nv))
        self._bias = np.zeros(nv)
        self._applied = np.zeros(nv)
        self._last_velocity: Floats | None = None

    def correct(
        self,
        torques: Floats,
        hips: tuple[int, int],
        shares: tuple[float, float],
        standing: bool = True,
    ) -> Floats:
        """Torques of the joints [N·m], shape (n,), from those of the law, shape (n,).

        `hips` are the groups of stance and swing hip, `shares` their parts of the root balance;
        `standing` says that the stance foot is on the floor.
        """
        robot = self._robot
        model, data = robot.model, robot.data
        force = self._observed_force()
        mujoco.mj_makeM(model, data)
        mujoco.mj_fullM(model, data, self._mass)
        mujoco.mj_rne(model, data, 0, self._bias)
        law = np.zeros(model.nv)
        law[self._dofs] = torques
        coupling = self._law.matrix(self._gain, hips, shares, standing)
        acceleration = np.linalg.solve(self._mass + coupling, law - self._bias + force)
        self._applied = law - coupling @ acceleration
        self._last_velocity = data.qvel.copy()
        applied: Floats = self._applied[self._dofs].copy()
        return applied

    def note_applied(self, torques: Floats) -> None:
        """Joint torques that are applied in place of what `correct` returned [N·m], (n,)."""
        self._applied[self._dofs] = torques

    def _observed_force(self) -> Floats:
        """Generalised contact force of the last tick [N, N·m], shape (nv,)."""
        if self._last_velocity is None:
            return np.zeros_like(self._bias)
        change = (self._robot.data.qvel - self._last_velocity) / self._dt
        observed: Floats = self._mass @ change + self._bias - self._applied
        return observed
