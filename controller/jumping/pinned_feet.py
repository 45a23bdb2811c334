"""Legs that follow the hip while both feet stay where they are."""

from controller.estimation.rotation import to_matrix
from controller.jumping.ccd import solve_ccd
from controller.jumping.chain import JointChain, leg_chain
from controller.jumping.posture import Posture
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Floats

TOLERANCE = 1e-5
"""Distance of a foot's points from their places, as a share of the leg."""
EDGE = 0.03
"""A joint this close to a limit is at it [rad]."""


class PinnedFeet:
    """Inverse kinematics of both legs by cyclic coordinate descent, feet as they are at a start.

    Orientation of the root and angles of all other joints stay as they are.
    """

    def __init__(self, robot: RobotModel, description: RobotDescription, start: Posture) -> None:
        self._legs = [leg_chain(robot, description, foot) for foot in range(2)]
        self._tolerance = TOLERANCE * robot.leg_length
        self._places = [
            leg.points(start.joint_position[leg.joints]) @ to_matrix(start.base_orientation).T
            + start.base_position
            for leg in self._legs
        ]

    def moved(self, posture: Posture, travel: Floats) -> Posture | None:
        """The posture with its root moved by `travel` [m], or None if a foot would not stay."""
        base, joints = posture.base_position + travel, posture.joint_position.copy()
        for leg, places in zip(self._legs, self._places, strict=True):
            targets = (places - base) @ to_matrix(posture.base_orientation)
            begin = joints[leg.joints]
            found = solve_ccd(leg, begin, targets, tolerance=self._tolerance)
            if not found.converged:
                return None
            joints[leg.joints] = found.angles
        return Posture(base, posture.base_orientation, joints)

    def at_limits(self, posture: Posture) -> tuple[int, ...]:
        """Joints of the legs at a limit, indices in description order."""
        return tuple(joint for leg in self._legs for joint in _at_limits(leg, posture))


def _at_limits(leg: JointChain, posture: Posture) -> list[int]:
    angles = posture.joint_position[leg.joints]
    held = (angles - leg.lower < EDGE) | (leg.upper - angles < EDGE)
    found: list[int] = leg.joints[held].tolist()
    return found
