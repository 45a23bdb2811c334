"""Implicit PD: the whole control law, cascade included, evaluated at the end of the tick.

Stable PD (Tan, Liu, Turk 2011) applied to the linearised law of all joints together, as the low
rates of seed 000_bd1305a0ae731442 need it; the seed names it as future work.
"""

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.selection import selection
from controller.walking.joint_groups import JointGroups
from controller.walking.pose_tracking import PoseTracking
from hil.interface import Floats, Ints


class ImplicitPd:
    """Torques Q' − C·a with (M + C)·a = Q' − bias + f, from the law's torques Q'.

    The law is Q = −A·q̇ − B·δq near the present state, C = h·A + h²·B. Q' is the law with
    errors predicted one tick ahead (`PoseTracking` with lead h), so that Q' − C·a is the law at
    the end of the tick. Row i of C is axis_iᵀ·K_g·J_g with K_g = h·kd + h²·kp of its joint g in
    world axes and J_g the relative or absolute angular Jacobian of that joint; a hip has in
    addition minus its share of the root balance, K_root·J_root + K_swing·J_swing + Σ K_b·J_b.

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
        self._robot, self._groups, self._tracking, self._dt = robot, groups, tracking, dt
        self._balanced = [[tracking.root, group, *others.tolist()] for group in range(len(groups))]
        model = robot.model
        nv = model.nv
        self._masks = self._dof_masks()
        self._joint_masks: Floats = self._masks[groups.of_joint]
        self._dofs = selection(robot.dof_addresses)
        self._joints_of = [selection(joints) for joints in groups.joints]
        self._balanced_masks = [self._masks[rows][:, None, :] for rows in self._balanced]
        self._shares = np.zeros((len(groups.of_joint), 1))
        self._axes: Floats = robot.data.cdof[:, :3]
        self._gain = (dt * tracking.damping + dt * dt * tracking.stiffness)[:, None, :]
        self._mass = np.zeros((nv, nv))
        self._bias = np.zeros(nv)
        self._coupling = np.zeros((nv, nv))
        self._applied = np.zeros(nv)
        self._last_velocity: Floats | None = None

    def _dof_masks(self) -> Floats:
        """Degrees of freedom that turn each tracked row, shape (groups + 1, nv)."""
        robot, groups = self._robot, self._groups
        masks = np.zeros((len(groups) + 1, robot.model.nv))
        base = slice(robot.base_dof, robot.base_dof + 6)
        beyond = groups.descends()
        for row in range(len(groups) + 1):
            relative = bool(self._tracking.relative[row])
            if not relative:
                masks[row, base] = 1.0
            if row < len(groups):
                own = np.arange(len(groups)) == row if relative else beyond[row]
                masks[row, robot.dof_addresses] = own[groups.of_joint]
        return masks

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
        coupling = self._law_coupling(hips, shares, standing)
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

    def _law_coupling(
        self, hips: tuple[int, int], shares: tuple[float, float], standing: bool
    ) -> Floats:
        """The matrix C, shape (nv, nv)."""
        frames, axes = self._tracking.frames, self._axes
        own, across = axes[self._dofs], axes.T.copy()
        world = (frames * self._gain) @ frames.transpose(0, 2, 1)
        rows = np.vecmat(own, world.take(self._groups.of_joint, axis=0)) @ across
        rows *= self._joint_masks
        if standing:
            rows[self._joints_of[hips[0]]] = 0.0  # the stance hip has no PD of its own
        masked = across * self._balanced_masks[hips[1]]
        gains = world.take(self._balanced[hips[1]], axis=0).transpose(1, 0, 2).reshape(3, -1)
        balance = gains @ masked.reshape(-1, len(axes))
        self._shares[:] = 0.0
        for hip, share in zip(hips, shares, strict=True):
            self._shares[self._joints_of[hip]] = share
        rows -= (self._shares * own) @ balance
        self._coupling[self._dofs] = rows
        return self._coupling
