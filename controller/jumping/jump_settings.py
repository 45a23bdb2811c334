"""How a robot with joint torques jumps: how low it bends, how fast it winds up, how it leans."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class JumpSettings:
    """Bends are heights of the centre of mass below that on straight legs, in leg lengths."""

    push_depth: float = 0.32
    """How deep it crouches for its push if nobody says, in leg lengths."""
    standing_bend: float = 0.06
    take_off_bend: float = 0.16
    """A straight leg can neither push nor be drawn up; a bent one turns slower at a given speed."""
    touch_down_bend: float = 0.18
    rest_bend: float = 0.23
    """Where a landing comes to rest, before the body rises."""
    lean: float = 0.3
    """How far the trunk leans forward in the crouch [rad]."""
    windup_time: float = 3.6
    """In √(L/g)."""
