"""Velocity control: a virtual force on the body, realised by the torques of the supporting legs.

Seed 000_bd1305a0ae731442, section 3 (velocity component after Coros 2010 and Carensac 2015).
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.heading_frame import Pair
from controller.walking.joint_groups import JointGroups
from controller.walking.leg_kinematics import Vector
from controller.walking.torque_config import VirtualForceConfig
from hil.interface import Floats

LEG_KINDS = ("ankle", "knee", "hip")


class VirtualForce:
    """F = m·K·(V*_eff − v), horizontal and at most F_max, as torques by mass-weighted levers.

    Leg chain: for joint j, r_j = Σ m_i(c_i − p_j)/M over the bodies of the leg above j and the
    pelvis. The child of j, which is below, gets −share·r_j × F without the vertical component,
    so that only the lever's height counts: share·r_z·(F_y, −F_x, 0).
    Torso chain, apart: r = m_torso(c_torso − p_back)/M and the torso gets +r × F. M is the mass
    of thigh, shank, pelvis and torso.
    """

    def __init__(
        self, config: VirtualForceConfig, robot: RobotModel, groups: JointGroups, back: int
    ) -> None:
        self._back = back
        self._centres: Floats = robot.data.xipos
        self._anchors: Floats = robot.data.xanchor
        self._gain = (robot.mass * config.gain[0], robot.mass * config.gain[1])
        self._limit = config.limit * robot.weight
        legs = np.array([groups.legs(kind) for kind in LEG_KINDS])
        self._groups: list[list[int]] = legs.tolist()
        self._leg_anchors = groups.anchor_joint[legs]
        self._back_anchor = int(groups.anchor_joint[back])
        mass = robot.model.body_mass
        shank, thigh = groups.child[legs[1]], groups.child[legs[2]]
        self._bodies = np.array([shank, thigh, np.full(2, robot.root_body)])
        masses = mass[self._bodies]
        self._torso = int(groups.child[back])
        total = float(masses[:, 0].sum() + mass[self._torso])
        above = np.triu(np.ones((3, 3)))
        self._weights = above * masses[:, 0] / total
        """Mass fraction of body i (column) for joint j (row), both from the ankle up."""
        self._sums = self._weights.sum(axis=1)[:, None]
        self._torso_share = float(mass[self._torso]) / total

    def force(self, wanted: Pair, velocity: Pair, heading: Floats) -> Vector:
        """World force [N] of speeds in the heading frame [m/s]."""
        (gain_x, gain_y), limit = self._gain, self._limit
        x = min(max(gain_x * (wanted[0] - velocity[0]), -limit), limit)
        y = min(max(gain_y * (wanted[1] - velocity[1]), -limit), limit)
        (xx, xy, _), (yx, yy, _), (zx, zy, _) = heading.tolist()
        return xx * x + xy * y, yx * x + yy * y, zx * x + zy * y

    def lever_heights(self) -> Floats:
        """Heights r_z of the levers of ankle, knee and hip of both legs [m], shape (3, 2)."""
        heights: Floats = self._weights @ self._centres[:, 2].take(self._bodies)
        heights -= self._sums * self._anchors[:, 2].take(self._leg_anchors)
        return heights

    def add_torques(self, torques: Floats, force: Vector, shares: Pair) -> None:
        """Add the torque vectors to `torques`, shape (groups, 3); `shares` of the legs sum to 1."""
        fx, fy, _ = force
        for heights, groups in zip(self.lever_heights().tolist(), self._groups, strict=True):
            for height, group, share in zip(heights, groups, shares, strict=True):
                torques[group, 0] += fy * share * height
                torques[group, 1] -= fx * share * height
        lever = self._centres[self._torso] - self._anchors[self._back_anchor]
        rx, ry, rz = (self._torso_share * lever).tolist()
        torques[self._back] += (-rz * fy, rz * fx, rx * fy - ry * fx)
