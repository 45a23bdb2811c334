"""What every monitor is given in a tick, and what it is."""

from dataclasses import dataclass
from typing import Protocol

from hil.interface import AppliedCommand, Estimate, SensorFrame, Truth
from hil.safety.severity import Event


@dataclass(slots=True)
class Situation:
    """One tick as the monitors see it, before its command is made. Reused by the next one."""

    now_ns: int
    frame: SensorFrame
    motion: Truth | Estimate
    """The truth where it is known."""
    applied: AppliedCommand
    """What was sent in the tick before."""
    walking: bool = False
    """From T = 0 until the robot begins to sit down."""


class Monitor(Protocol):
    """Looks for one kind of trouble."""

    def look(self, situation: Situation) -> list[Event]:
        """The events of this tick; an empty list nearly always."""
        ...
