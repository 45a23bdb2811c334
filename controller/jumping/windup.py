"""The windup: the legs bend until their muscles push as the jump asks, over balanced feet.

Seed 004_2880d7939e94ed85, section 3.2: proportional-derivative control of the hip's place on the
errors of force and balance; inverse kinematics keeps the feet where they are.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from controller.jumping.balance import balance_error
from controller.jumping.muscles import Muscles
from controller.jumping.pinned_feet import PinnedFeet
from controller.jumping.posture import Posture
from controller.jumping.support_polygon import SupportPolygon
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats

STILL = 1e-4
"""Travel of the hip below which a blocked windup has ended, as a share of the leg."""
SHARES = (1.0, 0.5, 0.25, 0.06, 0.0)
"""Of the vertical travel, tried in turn until the legs can follow."""


@dataclass(frozen=True, slots=True)
class WindupSettings:
    """Numbers of the controller. All lengths are shares of the leg, so that one set fits all."""

    kp: float = 0.3
    kd: float = 0.1
    tolerance: float = 0.002
    """ε: largest |E_all|, which holds both errors as lengths."""
    force_tolerance: float = 0.01
    """Largest E_force as a share of the wanted force: next to straight legs it is the stricter."""
    iterations: int = 200
    travel: float = 0.05
    """Most that the hip moves in one iteration."""

    def __post_init__(self) -> None:
        above = (self.kp, self.tolerance, self.force_tolerance, self.travel)
        if min(above) <= 0.0 or self.kd < 0.0:
            raise InputError(f"windup: kp, ε and travel must be above 0, kd at least 0: {self}")
        if self.iterations < 1:
            raise InputError(f"windup: at least one iteration (got {self.iterations})")


@dataclass(frozen=True, slots=True)
class WindupFrame:
    """One iterate: what an animator would call a key frame."""

    posture: Posture
    com: Floats
    """[m], shape (3,)."""
    force: float
    """What the muscles push with [N]."""
    force_error: float
    """Wanted less present force [N]."""
    balance_error: Floats
    """Middle of the support less centre of mass [m], shape (2,)."""
    margin: float
    """Of the centre of mass to the edge of the support [m], below 0 outside."""
    error: Floats
    """E_all as a place that the hip should go to [m], shape (3,)."""


@dataclass(frozen=True, slots=True)
class Windup:
    """All iterates, from the start to the crouch."""

    frames: tuple[WindupFrame, ...]
    converged: bool
    blocked_by: tuple[str, ...]
    """Joints at their limits where it could not go on."""
    wanted_force: float
    """[N]"""
    support: SupportPolygon

    @property
    def com(self) -> Floats:
        """Centre of mass in the crouch [m], shape (3,)."""
        return self.frames[-1].com

    @property
    def depth(self) -> float:
        """How far the centre of mass went down [m]."""
        return float(self.frames[0].com[2] - self.com[2])

    @property
    def least_margin(self) -> float:
        """Closest that the centre of mass came to the edge of the support [m]."""
        return min(frame.margin for frame in self.frames)


def wind_up(
    robot: RobotModel,
    description: RobotDescription,
    start: Posture,
    force: float,
    muscles: Muscles,
    settings: WindupSettings,
) -> Windup:
    """Bend from a posture on both flat feet until the legs would push with `force` [N].

    E_all = (E_balance, −c·E_force) [m], c the hip's travel per newton at the wanted bend;
    the hip moves by u(i) = kp·E_all(i−1) + kd·(E_all(i−1) − E_all(i−2)) until |E_all| < ε.
    It ends early where the feet would not stay.
    Leaves the model in the last posture. Raises InputError for a force that no bend gives.
    """
    return _Controller(robot, description, start, force, muscles, settings).run()


class _Controller:
    """One windup under way."""

    def __init__(
        self,
        robot: RobotModel,
        description: RobotDescription,
        start: Posture,
        force: float,
        muscles: Muscles,
        settings: WindupSettings,
    ) -> None:
        self._compliance = 1.0 / muscles.stiffening(muscles.bend(force))
        self._robot, self._names = robot, description.joint_names
        self._force, self._muscles, self._settings = force, muscles, settings
        self._feet = PinnedFeet(robot, description, start)
        robot.set_state(start)
        self._support = SupportPolygon.of(robot.corner_positions)
        self._leg = robot.leg_length
        self._frame = self._measured(start)

    def run(self) -> Windup:
        frames = [self._frame, *self._iterates()]
        converged = self._done(self._frame)
        blocked = () if converged else self._feet.at_limits(self._frame.posture)
        names = tuple(self._names[joint] for joint in blocked)
        return Windup(tuple(frames), converged, names, self._force, self._support)

    def _iterates(self) -> Iterator[WindupFrame]:
        before = self._frame.error
        for _ in range(self._settings.iterations):
            if self._done(self._frame):
                return
            error = self._frame.error
            moved = self._moved(self._limited(error, before))
            if moved is None:
                return
            before, self._frame = error, self._measured(moved)
            yield self._frame

    def _limited(self, error: Floats, before: Floats) -> Floats:
        """The controller's output: how far the hip shall go [m], shape (3,)."""
        settings = self._settings
        output: Floats = settings.kp * error + settings.kd * (error - before)
        size, most = float(np.linalg.norm(output)), settings.travel * self._leg
        return output if size <= most else output * (most / size)

    def _moved(self, travel: Floats) -> Posture | None:
        """The posture with the hip moved as far as the legs follow, or None if they do not."""
        for share in SHARES:
            step = travel * (1.0, 1.0, share)
            if np.linalg.norm(step) < STILL * self._leg and share < 1.0:
                return None
            posture = self._feet.moved(self._frame.posture, step)
            if posture is not None:
                return posture
        return None

    def _measured(self, posture: Posture) -> WindupFrame:
        self._robot.set_state(posture)
        force = self._muscles.force(posture.joint_position)
        balance = balance_error(self._robot, self._support)
        missing = self._force - force
        com = self._robot.com.copy()
        error = np.array((*balance, -self._compliance * missing))
        margin = self._support.margin(com)
        return WindupFrame(posture, com, force, missing, balance, margin, error)

    def _done(self, frame: WindupFrame) -> bool:
        settings = self._settings
        close = float(np.linalg.norm(frame.error)) < settings.tolerance * self._leg
        return close and abs(frame.force_error) < settings.force_tolerance * self._force
