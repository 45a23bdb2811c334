"""Pose tracking: proportional-derivative torques towards target orientations, all joints at once.

Seed 000_bd1305a0ae731442, section 3; frames as in the first author's stored code: torso, head and
feet are tracked in the heading frame, the other joints in the frame of their parent, the root in
the heading frame.
"""

from collections.abc import Mapping

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from controller.walking.rotations import rotation_vectors
from controller.walking.torque_config import TorqueWalkingConfig
from hil.interface import Floats, Ints
from hil.joint_gains import GainSet, kind_of


class PoseTracking:
    """World torque τ = R_f·s⊙[kp·e + kd·(ω* − R_fᵀω)] on the child of every joint, and the root.

    R_f is the tracking frame, e = log(R*·(R_fᵀR_child)ᵀ) the orientation error in it, ω the
    angular velocity relative to the parent (parent frame) or absolute (heading frame), s the
    axis scales. The last row is the root, whose ω is the mean of this tick's and the last one's.
    With `lead` h > 0 the error is predicted one tick ahead, e + h·(ω* − R_fᵀω): implicit PD.
    """

    def __init__(
        self,
        robot: RobotModel,
        groups: JointGroups,
        config: TorqueWalkingConfig,
        gains: GainSet,
        lead: float = 0.0,
    ) -> None:
        count = len(groups) + 1
        kinds = [kind_of(name) for name in groups.names]
        self._robot = robot
        self.root = count - 1
        """Row of the root."""
        self.relative = np.array([config.tracking[k].frame == "parent" for k in kinds] + [False])
        """Rows tracked in the parent's frame, shape (groups + 1,)."""
        scales = [config.side_scales.get(n, config.tracking[kind_of(n)].scale)
                  for n in groups.names] + [config.root_balance.scale]  # fmt: skip
        self.stiffness, self.damping = _scaled(gains, [*kinds, "root"], np.array(scales))
        self._child = np.append(groups.child, robot.root_body)
        self._parent = np.append(groups.parent, 0)
        self._carrier = np.where(self.relative, self._parent, 0)
        self.target = np.tile(np.eye(3), (count, 1, 1))
        """Target orientations R* in the tracking frames, shape (groups + 1, 3, 3)."""
        self.target_rate = np.zeros((count, 3))
        """Target angular velocities ω* in the tracking frames [rad/s]."""
        self.frames = np.tile(np.eye(3), (count, 1, 1))
        """Tracking frames R_f, frame to world."""
        self._rate_gain = self.damping + lead * self.stiffness
        self._absolute: list[int] = np.flatnonzero(~self.relative).tolist()
        self._orientations: Floats = robot.data.xmat.reshape(-1, 3, 3)
        entries = np.arange(9).reshape(3, 3).T + 9 * self._child[:, None, None]
        self._transposed: Ints = entries
        """Where R_childᵀ is in the orientations of all bodies, shape (groups + 1, 3, 3)."""
        self._last_root_rate = [0.0, 0.0, 0.0]

    def set_frames(self, heading: Floats, special: Mapping[int, Floats]) -> None:
        """Place the tracking frames; `special` gives rows a frame of their own."""
        np.take(self._orientations, self._parent, axis=0, out=self.frames, mode="clip")
        for row in self._absolute:
            self.frames[row] = heading
        for row, frame in special.items():
            self.frames[row] = frame

    def torques(self) -> Floats:
        """World torque vectors of all rows [N·m], shape (groups + 1, 3)."""
        rates, frames = self._robot.angular_velocities, self.frames
        to_child = self._orientations.take(self._transposed)
        local = rotation_vectors(self.target @ (to_child @ frames))
        omega = rates.take(self._child, axis=0)
        x, y, z = root_rate = omega[self.root].tolist()
        u, v, w = self._last_root_rate
        omega[self.root] = 0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)
        self._last_root_rate = root_rate
        omega -= rates.take(self._carrier, axis=0)  # the world, body 0, does not turn
        rate = self.target_rate - np.vecmat(omega, frames)
        rate *= self._rate_gain
        local *= self.stiffness
        local += rate
        torque: Floats = np.matvec(frames, local)
        return torque


def _scaled(gains: GainSet, kinds: list[str], scales: Floats) -> tuple[Floats, Floats]:
    table = np.array([gains[kind] for kind in kinds])
    return scales * table[:, :1], scales * table[:, 1:]
