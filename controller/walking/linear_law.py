"""The control law of a torque robot, linearised: what joint torques answer to small motions.

Pose tracking and root balance (seed 000_bd1305a0ae731442, section 3) near the present state; used
by implicit PD and by the closed-form ceiling of gains.
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.selection import selection
from controller.walking.joint_groups import JointGroups
from controller.walking.pose_tracking import PoseTracking
from hil.interface import Floats, Ints


class LinearLaw:
    """The matrix G of Q = −G·x: with gains kd, x is the velocity; with kp, the displacement.

    Row i of G is axis_iᵀ·K_g·J_g, with K_g the gains of its joint g in world axes and J_g the
    relative or absolute angular Jacobian of that joint; a hip has in addition minus its share of
    the root balance, K_root·J_root + K_swing·J_swing + Σ K_b·J_b.
    """

    def __init__(
        self,
        robot: RobotModel,
        groups: JointGroups,
        tracking: PoseTracking,
        others: Ints,
    ) -> None:
        """`others` are the groups that hang on the root beside the hips."""
        self._robot, self._groups, self._tracking = robot, groups, tracking
        self._balanced = [[tracking.root, group, *others.tolist()] for group in range(len(groups))]
        nv = robot.model.nv
        self._masks = self._dof_masks()
        self._joint_masks: Floats = self._masks[groups.of_joint]
        self._dofs = selection(robot.dof_addresses)
        self._joints_of = [selection(joints) for joints in groups.joints]
        self._balanced_masks = [self._masks[rows][:, None, :] for rows in self._balanced]
        self._shares = np.zeros((len(groups.of_joint), 1))
        self._axes: Floats = robot.data.cdof[:, :3]
        self._matrix = np.zeros((nv, nv))

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

    def matrix(
        self,
        gains: Floats,
        hips: tuple[int, int],
        shares: tuple[float, float],
        standing: bool = True,
    ) -> Floats:
        """G, shape (nv, nv); the next call overwrites it.

        `gains` are about x, y, z of each row's tracking frame, shape (groups + 1, 1, 3). `hips`
        are the groups of stance and swing hip, `shares` their parts of the root balance;
        `standing` says that the stance foot is on the floor.
        """
        frames, axes = self._tracking.frames, self._axes
        own, across = axes[self._dofs], axes.T.copy()
        world = (frames * gains) @ frames.transpose(0, 2, 1)
        rows = np.vecmat(own, world.take(self._groups.of_joint, axis=0)) @ across
        rows *= self._joint_masks
        if standing:
            rows[self._joints_of[hips[0]]] = 0.0  # the stance hip has no PD of its own
        masked = across * self._balanced_masks[hips[1]]
        chosen = world.take(self._balanced[hips[1]], axis=0).transpose(1, 0, 2).reshape(3, -1)
        balance = chosen @ masked.reshape(-1, len(axes))
        self._shares[:] = 0.0
        for hip, share in zip(hips, shares, strict=True):
            self._shares[self._joints_of[hip]] = share
        rows -= (self._shares * own) @ balance
        self._matrix[self._dofs] = rows
        return self._matrix
