"""The ceiling of a servo joint's gains: what the servo's loop and the bus can close.

The servo's counterpart of `gain_ceiling` (seed 000_bd1305a0ae731442, section 5.2).
"""

import math
from collections.abc import Sequence

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.linear_stance import StancePose, mass_matrix, standing_on
from hil.description import RobotDescription
from hil.interface import Floats


def delayed_bound(ticks: int) -> float:
    """Largest a of v⁺ = v − a·v₋d that does not grow: 2·cos(d·π/(2d + 1)) (Levin and May 1976).

    2 without delay, 1 for one tick, 0.618 for two.
    """
    return 2.0 * math.cos(ticks * math.pi / (2 * ticks + 1))


class ServoCeiling:
    """Bounds of single joints with the mobility w_j = (M⁻¹)_jj, the largest over poses.

    Stiffness is closed in the servo at its own period h_s: h_s²·kp·w ≤ 4, the explicit bound of
    an undamped oscillator. The motor's back-EMF damping is physics and has no ceiling. Damping
    that the host adds acts a bus cycle of d ticks late: h·kd·w ≤ 2·cos(d·π/(2d + 1)). M stands on
    the stance foot and holds the rotors; `armature` replaces them [kg·m²].
    """

    def __init__(
        self, description: RobotDescription, poses: Sequence[StancePose], armature: float | None
    ) -> None:
        robot = RobotModel(description)
        if armature is not None:
            robot.model.dof_armature[robot.dof_addresses] = armature
        self.mobility: Floats = np.max([_mobility(robot, pose) for pose in poses], axis=0)
        """w [1/(kg·m²)], shape (n,)."""

    def stiffness(self, servo_period_s: float) -> Floats:
        """[N·m/rad], shape (n,)."""
        value: Floats = 4.0 / (servo_period_s**2 * self.mobility)
        return value

    def host_damping(self, rate_hz: float, delay_s: float) -> Floats:
        """Beyond the motor's own, with goals that act `delay_s` late [N·m·s/rad], shape (n,)."""
        value: Floats = delayed_bound(math.ceil(delay_s * rate_hz)) * rate_hz / self.mobility
        return value


def _mobility(robot: RobotModel, pose: StancePose) -> Floats:
    robot.set_state(pose)
    free = standing_on(robot, pose.stance)
    inverse = free @ np.linalg.solve(free.T @ mass_matrix(robot) @ free, free.T)
    value: Floats = np.diagonal(inverse)[robot.dof_addresses]
    return value
