"""How bad something is, and what was found: the words of the safety chain."""

from dataclasses import dataclass
from enum import IntEnum


class Severity(IntEnum):
    """Ordered: the higher one wins. From SOFT_STOP on, what is reached stays (is latched)."""

    OK = 0
    WARN = 1
    """Told and recorded; the walk goes on."""
    SOFT_STOP = 2
    """Sit down, then torque off."""
    LAND = 3
    """A fall has begun: fold the legs, soft, then torque off."""
    TORQUE_OFF = 4
    """Now."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that a monitor found in one tick."""

    source: str
    """Joint, board, bus, `body`, `program` or `operator`."""
    name: str
    """What it is, as `report.json` lists it."""
    severity: Severity


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that went wrong, as `report.json` lists it."""

    time_s: float
    source: str
    name: str
    reaction: str
