"""The body: fallen, or about to fall."""

import math

from hil.interface import Estimate, Truth
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

MAX_TILT_RAD = 1.0
"""Tilt of the root body beyond which it counts as fallen."""
MIN_HEIGHT_SHARE = 0.6
"""Share of the starting height of the root body below which it counts as fallen."""
MIN_HEIGHT_SHARE_LEAP = 0.35
"""The same of a robot that jumps: the crouch of the human is at 0.6, after 0.15 m down at 0.5."""
LOOK_AHEAD_S = 0.15
"""A fall is predicted from the tilt that is reached so much later at the present rate."""
PREDICTED_TILT_RAD = 0.75
"""Larger than any tilt from which a walk was seen to recover (0.45 rad, pushes of minibiped)."""

FELL = Event("body", "fell", Severity.TORQUE_OFF)
FALLING = Event("body", "falling", Severity.LAND)


class BodyMonitor:
    """Tilt θ and height of the root body; predicted tilt θ + θ̇·t.

    With the body's own vertical u (world axes), cos θ = u_z, and its rate is that of u_z, taken
    from the last two ticks. A fall is only predicted for a body that tilts further.
    """

    def __init__(self, *, predicts: bool, leaps: bool = False) -> None:
        """`predicts`: whether a fall that has begun is an event, for a robot that can land.
        `leaps`: it crouches deep, and may land lower than it stood.
        """
        self._share = MIN_HEIGHT_SHARE_LEAP if leaps else MIN_HEIGHT_SHARE
        self._predicts = predicts
        self._min_height = -math.inf
        self._tilt, self._time_ns = 0.0, 0

    def begin_walking(self, base_height: float) -> None:
        """From now on a low root body counts as a fall; its height at T = 0 [m]."""
        self._min_height = self._share * base_height

    def begin_sitting(self) -> None:
        """From now on a low root body is what is wanted."""
        self._min_height = -math.inf

    def look(self, situation: Situation) -> list[Event]:
        """FELL, or FALLING, or nothing."""
        motion = situation.motion
        before, before_ns = self._tilt, self._time_ns
        self._tilt, self._time_ns = tilt(motion), situation.now_ns
        if self._tilt > MAX_TILT_RAD or motion.base_position[2] < self._min_height:
            return [FELL]
        elapsed_s = (situation.now_ns - before_ns) * 1e-9
        if not (self._predicts and situation.walking) or elapsed_s <= 0:
            return []
        rate = (self._tilt - before) / elapsed_s
        if rate > 0 and self._tilt + rate * LOOK_AHEAD_S > PREDICTED_TILT_RAD:
            return [FALLING]
        return []


def tilt(motion: Truth | Estimate) -> float:
    """Angle between the root body's vertical and the world's [rad]."""
    _, x, y, _ = motion.base_orientation.tolist()
    return math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y))))
