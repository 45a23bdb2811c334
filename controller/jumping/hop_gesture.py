"""The gesture of a hop: where trunk and legs are at every share of the push."""

import math
from dataclasses import dataclass

import numpy as np

from controller.estimation.rotation import from_matrix
from controller.jumping.hop_settings import HopSettings
from controller.jumping.posture import Posture, standing
from controller.robot_model import RobotModel
from controller.walking.leg_chain import ORDER, LegChain
from controller.walking.rotations import about_y
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import SIDES, Ints

HALVINGS = 24
"""Of the search for the crouch: to a ten-millionth of the knee's range."""
KNEE_RESERVE = 0.05
"""The crouch stays so far from the end of the knees' range [rad]."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Both legs alike, in the sagittal plane."""

    knee: float
    """Bend from straight [rad]."""
    forward: float
    """Hips ahead of the ankles [m]."""
    foot: float = 0.0
    """Pitch of the feet, toes down [rad]: they turn about their front edge, which stays."""
    trunk: float = 0.0
    """Pitch of the trunk, forward [rad]."""


def from_rest(share: float, softness: float) -> float:
    """Way of a motor at full duty, from 0 to 1 over a share of the time from 0 to 1.

    Its speed comes up as 1 − e^(−u/ε) with the softness ε, so the way is
    (u − ε·(1 − e^(−u/ε))) / (1 − ε·(1 − e^(−1/ε))).
    """
    if share <= 0.0:
        return 0.0

    def way(u: float) -> float:
        return u - softness * (1.0 - math.exp(-u / softness))

    return way(share) / way(1.0)


class HopGesture:
    """Shapes over the push, and the postures that they are.

    The knees stretch from the crouch to the take-off and the hips move from over the ankles
    towards the toes; in the last part the heels rise. All go the way of motors at full duty
    (`from_rest`). How fast this is played is another matter: the velocity at the end is the
    inverse of the duration, times what the gesture says.
    """

    def __init__(
        self, description: RobotDescription, robot: RobotModel, settings: HopSettings, depth: float
    ) -> None:
        """`depth`: how far the centre of mass rises [m]. Raises InputError if knees end before."""
        self._robot, self._settings = robot, settings
        self._start = np.array(description.start_position)
        self._chains = [LegChain(robot, leg) for leg in range(2)]
        names = description.joint_names
        self._legs: list[Ints] = [
            np.array([names.index(f"{side}_{joint}") for joint in ORDER]) for side in SIDES
        ]
        robot.place_at_zero()
        self._hips = robot.hip_positions - robot.root_position
        standing(robot, self._start)
        self._ankles = robot.ankle_positions.copy()
        self._edge = robot.corner_positions[:, :2].mean(axis=1)
        """Middle of the front edge of each sole [m], (2, 3)."""
        self._crouch = settings.take_off_knee
        self._crouch = self._find_crouch(description, depth)

    def shape(self, share: float) -> Shape:
        """At a share of the push from 0 to 1."""
        own, leg = self._settings, self._robot.leg_length
        bend = self._crouch - own.take_off_knee
        way = from_rest(share, own.softness)
        late = (share - own.heel_begin) / (1.0 - own.heel_begin)
        heel = own.heel_rise * from_rest(late, own.heel_softness)
        return Shape(
            own.take_off_knee + bend * (1.0 - way),
            leg * (own.hip_begin + way * (own.hip_end - own.hip_begin)),
            heel,
            -own.trunk_back * heel,
        )

    def drawn_up(self) -> Shape:
        """What the joints are given as goals in the air."""
        own = self._settings
        return Shape(
            own.drawn_up_knee,
            own.hip_end * self._robot.leg_length,
            own.drawn_up_foot,
            own.drawn_up_trunk,
        )

    def landed(self) -> Shape:
        """Where a landing comes to rest."""
        own = self._settings
        return Shape(own.drawn_up_knee, own.landing_hip * self._robot.leg_length)

    def posture(self, shape: Shape) -> Posture:
        """On the ground, the soles' centre at x = y = 0 when they are flat."""
        robot = self._robot
        a, b = robot.thigh_length, robot.shank_length
        squared = a * a + b * b + 2.0 * a * b * math.cos(shape.knee)
        trunk, foot = about_y(shape.trunk), about_y(shape.foot)
        ankles = self._edge + (self._ankles - self._edge) @ foot.T
        level = (trunk.T @ foot).tolist()
        joints = self._start.copy()
        aside = self._hips[:, 1] - ankles[:, 1]
        root = np.zeros(3)
        for leg, chain in enumerate(self._chains):
            up = math.sqrt(max(squared - shape.forward**2 - aside[leg] ** 2, 0.0))
            hip = ankles[leg] + (shape.forward, aside[leg], up)
            joints[self._legs[leg]] = chain.solve((trunk.T @ (ankles[leg] - hip)).tolist(), level)
            root += (hip - trunk @ self._hips[leg]) / 2.0
        return Posture(root, from_matrix(trunk), joints)

    def height(self, shape: Shape) -> float:
        """Of the centre of mass above the ground [m]; leaves the model there."""
        self._robot.set_state(self.posture(shape))
        return float(self._robot.com[2])

    def _find_crouch(self, description: RobotDescription, depth: float) -> float:
        """Bend of the knees in the crouch [rad]."""
        knee = description.joints[int(self._legs[0][ORDER.index("knee")])]
        low = self._settings.take_off_knee
        high = knee.range[1] - self._robot.knee_offset - KNEE_RESERVE
        forward = self._settings.hip_begin * self._robot.leg_length
        goal = self.height(self.shape(1.0)) - depth
        if self.height(Shape(high, forward)) > goal:
            most = goal + depth - self.height(Shape(high, forward))
            raise InputError(f"--push-depth: the knees bend for {most:.3f} m (got {depth:g})")
        for _ in range(HALVINGS):
            middle = (low + high) / 2.0
            if self.height(Shape(middle, forward)) > goal:
                low = middle
            else:
                high = middle
        return high
