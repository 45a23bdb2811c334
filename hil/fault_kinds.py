"""Every fault that a virtual robot can be given, as data: its plane, its values, what it does."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

Plane = Literal["servo", "board", "bus"]
"""What a fault sits on: one servo, one sensor board, or one wire with its adapter."""


@dataclass(frozen=True, slots=True)
class Value:
    """One value of a fault, a number or a word that stands for one."""

    name: str
    default: float
    low: float = 0.0
    high: float = 1e9
    words: Mapping[str, float] = field(default_factory=dict)
    """Words that may stand for numbers; where there are any, other numbers are refused."""

    @property
    def form(self) -> str:
        """How to write it."""
        return "|".join(self.words) if self.words else self.name


@dataclass(frozen=True, slots=True)
class FaultKind:
    """One kind of fault."""

    name: str
    effect: str
    """What the virtual robot does."""
    values: tuple[Value, ...] = ()
    momentary: bool = False
    """Happens at one moment, so that it has no duration."""

    @property
    def form(self) -> str:
        """How to write it, as in `drop[=P[,DIRECTION]]`."""
        return (
            self.name
            + "".join(
                ("[=" if i == 0 else "[,") + value.form for i, value in enumerate(self.values)
            )
            + "]" * len(self.values)
        )


BOTH, TO_SERVOS, TO_HOST = 0.0, 1.0, 2.0
"""Which way the packets go that a wire fault hits."""
CORNERS = {"front_left": 0.0, "front_right": 1.0, "rear_left": 2.0, "rear_right": 3.0}
ERRORS = {"input_voltage": 1.0, "overheating": 4.0, "encoder": 8.0, "electrical_shock": 16.0,
          "overload": 32.0}  # fmt: skip
"""Bits of Hardware Error Status (70)."""
CELLS, FEET = 0.0, 1.0
"""What `swapped` exchanges."""

_SHARE = Value("P", 1.0, 0.0, 1.0)
_WAY = Value("DIRECTION", BOTH, words={"both": BOTH, "tx": TO_SERVOS, "rx": TO_HOST})
_CORNER = Value("CORNER", 0.0, words=CORNERS)

_WIRE = (
    FaultKind("drop", "a packet is lost", (_SHARE, _WAY)),
    FaultKind("flip", "one bit of a packet is inverted", (_SHARE, _WAY)),
    FaultKind("truncate", "a packet loses its end, anywhere", (_SHARE, _WAY)),
    FaultKind("duplicate", "a packet comes twice", (_SHARE, _WAY)),
    FaultKind("garbage", "1 to 16 random bytes come before a packet", (_SHARE, _WAY)),
    FaultKind(
        "delay", "a packet comes late, and everything behind it",
        (_SHARE, Value("MS", 4.0, 0.0, 1e4), _WAY),
    ),
    FaultKind("disconnect", "the USB adapter is pulled out; the port fails until reopened"),
)  # fmt: skip
_BUS = (
    *_WIRE,
    FaultKind("echo", "the host receives what it sends", (_SHARE,)),
    FaultKind("collide", "another sender talks at the same time: bits are ANDed", (_SHARE, _WAY)),
)
_SERVO = (
    FaultKind("silent", "hears and answers nothing; its watchdog runs", (_SHARE,)),
    FaultKind("frozen", "answers, but its measured registers and its tick stand still"),
    FaultKind("reboot", "restarts: RAM reset, torque off, silent while it boots", momentary=True),
    FaultKind(
        "alert", "latches a hardware error; one in the Shutdown mask ends the torque",
        (Value("ERROR", ERRORS["overload"], words=ERRORS),), momentary=True,
    ),
    FaultKind(
        "overheat", "its temperature reads CELSIUS, reached in RISE_S",
        (Value("CELSIUS", 90.0, -40.0, 200.0), Value("RISE_S", 0.0, 0.0, 1e4)),
    ),
    FaultKind("undervoltage", "its supply reads VOLTS", (Value("VOLTS", 8.0, 0.0, 30.0),)),
    FaultKind(
        "wrong_model", "it is another model, by its number", (Value("NUMBER", 1060.0, 0.0, 65535),)
    ),
    FaultKind(
        "wrong_id", "it has another id, perhaps that of a neighbour: their answers collide",
        (Value("ID", 1.0, 0.0, 252.0),),
    ),
    FaultKind(
        "old_firmware", "its firmware is of this version, and lacks what came later",
        (Value("VERSION", 38.0, 0.0, 255.0),), momentary=True,
    ),
    FaultKind("lost_torque", "its Torque Enable goes to 0, without an alert", momentary=True),
    FaultKind("watchdog_trip", "its bus watchdog trips: it stops, goals locked", momentary=True),
    FaultKind(
        "drift", "its encoder drifts; its position loop follows",
        (Value("DEG_PER_S", 5.0, -1e4, 1e4),),
    ),
)  # fmt: skip
_BOARD = (
    *_WIRE,
    FaultKind("stale", "sends nothing"),
    FaultKind("stuck", "sends the values of the first moment for ever, in fresh frames"),
    FaultKind("clock_jump", "its clock jumps", (Value("S", 1.0, -1e3, 1e3),), momentary=True),
    FaultKind("slow", "sends every N-th frame", (Value("N", 2.0, 2.0, 1000.0),)),
)
_FOOT = (
    *_BOARD,
    FaultKind(
        "swapped", "its left and right cells are exchanged, or the two feet",
        (Value("WHAT", CELLS, words={"cells": CELLS, "feet": FEET}),),
    ),
    FaultKind("open_cell", "a cell's wire is off: full scale, marked invalid", (_CORNER,)),
    FaultKind("saturated", "a cell reads full scale, marked valid", (_CORNER,)),
)  # fmt: skip

FAULT_KINDS: dict[Plane, dict[str, FaultKind]] = {
    "servo": {kind.name: kind for kind in _SERVO},
    "board": {kind.name: kind for kind in _FOOT},
    "bus": {kind.name: kind for kind in _BUS},
}
IMU_KINDS = frozenset(kind.name for kind in _BOARD)
"""What an IMU board can have; the rest needs load cells."""
WIRE_KINDS = frozenset(kind.name for kind in _BUS)


def all_kinds() -> Iterator[tuple[Plane, FaultKind]]:
    """Every fault with its plane."""
    for plane, kinds in FAULT_KINDS.items():
        for kind in kinds.values():
            yield plane, kind
