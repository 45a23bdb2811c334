"""What a jump is asked to be: target, airtime, push and gravity."""

from pydantic import PositiveFloat

from hil.interface import GRAVITY
from hil.validation import Config


class JumpOrder(Config):
    """One jump; the robot's own axes at the start: x forward, y left, z up."""

    target: tuple[float, float, float]
    """Displacement of the feet's centre; z is the height of the landing surface [m]."""
    airtime: PositiveFloat
    """[s]"""
    push_depth: PositiveFloat
    """How far the centre of mass rises while the feet push [m]."""
    gravity: PositiveFloat = GRAVITY
    """[m/s²]"""
    run_up: PositiveFloat | None = None
    """Walk at this speed before the jump and after it [m/s]; none jumps from a stand."""
