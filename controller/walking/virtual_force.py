"""Velocity control: a virtual force on the body, realised by the torques of the supporting legs.

Seed 000_bd1305a0ae731442, section 3 (velocity component after Coros 2010 and Carensac 2015).
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
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
        self._robot, self._groups, self._back = robot, groups, back
        self._gain = robot.mass * np.array(config.gain)
        self._limit = config.limit * robot.weight
        self._legs = np.array([groups.legs(kind) for kind in LEG_KINDS])
        mass = robot.model.body_mass
        shank, thigh = groups.child[self._legs[1]], groups.child[self._legs[2]]
        self._bodies = np.array([shank, thigh, np.full(2, robot.root_body)])
        masses = mass[self._bodies]
        self._torso = int(groups.child[back])
        total = float(masses[:, 0].sum() + mass[self._torso])
        above = np.triu(np.ones((3, 3)))
        self._weights = above * masses[:, 0] / total
        """Mass fraction of body i (column) for joint j (row), both from the ankle up."""
        self._sums = self._weights.sum(axis=1)[:, None]
        self._torso_share = float(mass[self._torso]) / total

    def force(self, wanted: Floats, velocity: Floats, heading: Floats) -> Floats:
        """World force [N], shape (3,), of speeds in the heading frame [m/s], shape (2,)."""
        force = self._gain * (wanted - velocity)
        np.minimum(np.maximum(force, -self._limit), self._limit, out=force)
        world: Floats = heading[:, :2] @ force
        return world

    def lever_heights(self) -> Floats:
        """Heights r_z of the levers of ankle, knee and hip of both legs [m], shape (3, 2)."""
        data = self._robot.data
        joints = data.xanchor[self._groups.anchor_joint[self._legs], 2]
        heights: Floats = self._weights @ data.xipos[self._bodies, 2] - self._sums * joints
        return heights

    def add_torques(self, torques: Floats, force: Floats, shares: Floats) -> None:
        """Add the torque vectors to `torques`, shape (groups, 3); `shares` of the legs sum to 1."""
        leg = self.lever_heights() * shares
        fx, fy = float(force[0]), float(force[1])
        torques[self._legs, 0] += fy * leg
        torques[self._legs, 1] -= fx * leg
        data = self._robot.data
        anchor = data.xanchor[self._groups.anchor_joint[self._back]]
        rx, ry, rz = self._torso_share * (data.xipos[self._torso] - anchor)
        torques[self._back] += (-rz * fy, rz * fx, rx * fy - ry * fx)
