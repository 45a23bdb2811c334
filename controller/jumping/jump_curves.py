"""What every joint would do in windup and push of a jump."""

from dataclasses import dataclass

from controller.jumping.jump_plan import JumpPlan
from hil.interface import Floats

RATE = 300
"""Steps a second."""


@dataclass(frozen=True, slots=True)
class JumpCurves:
    """Joint curves over K steps of 1/RATE, joints in the order of the description."""

    position: Floats
    """[rad], (K, n)."""
    velocity: Floats
    """[rad/s], (K, n)."""
    torque: Floats
    """[N·m], (K, n)."""
    com: Floats
    """Centre of mass [m], (K, 3)."""
    push_begin: int
    """Step at which the push begins."""
    plan: JumpPlan
    """Of a robot whose feet's centre is at x = y = 0, on a floor at z = 0."""
