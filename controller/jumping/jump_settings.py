"""How a kind of robot jumps: how low it bends, how fast it winds up, how far it leans."""

from dataclasses import dataclass

from hil.description import RobotDescription


@dataclass(frozen=True, slots=True)
class JumpSettings:
    """Bends are heights of the centre of mass below that on straight legs, in leg lengths."""

    standing_bend: float
    take_off_bend: float
    """A straight leg can neither push nor be drawn up; a bent one turns slower at a given speed."""
    touch_down_bend: float
    rest_bend: float
    """Where a landing comes to rest, before the body rises."""
    lean: float
    """How far the trunk leans forward in the crouch [rad]."""
    windup_time: float
    """In √(L/g)."""

    @classmethod
    def of(cls, description: RobotDescription) -> "JumpSettings":
        """Of a robot with torques, or with servos, which are slow and would rather lift more."""
        if description.actuation == "torque":
            return cls(0.06, 0.16, 0.18, 0.23, 0.3, 2.6)
        return cls(0.06, 0.28, 0.28, 0.30, 0.0, 10.0)
