"""How a virtual robot is put together wrongly, as it is asked for: `WHAT=VALUES`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hil.description import RobotDescription
from hil.errors import InputError, UnknownNameError
from hil.interface import CORNERS
from hil.validation import Config


@dataclass(frozen=True, slots=True)
class MiswireKind:
    """One way to put a robot together wrongly."""

    form: str
    effect: str
    check: Callable[[tuple[str, ...], RobotDescription], None]


class Miswire(Config):
    """One thing that is wrong."""

    kind: str
    values: tuple[str, ...]


def _joint(name: str, description: RobotDescription) -> None:
    _known("joint", name, description.joint_names)


def _known(what: str, name: str, valid: Sequence[str]) -> None:
    if name not in valid:
        raise UnknownNameError(f"{what} in --miswire", name, valid)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--miswire: {text!r} is not a number") from None


def _count(values: tuple[str, ...], count: int) -> None:
    if len(values) != count:
        raise InputError(f"--miswire: needs {count} value(s), got {', '.join(values) or 'none'}")


def _check_swap(values: tuple[str, ...], description: RobotDescription) -> None:
    _count(values, 2)
    groups = (description.joint_names, tuple(description.buses), tuple(description.boards))
    for group in groups:
        if values[0] in group:
            _known("partner", values[1], group)
            return
    _known("joint, bus or board", values[0], [name for group in groups for name in group])


def _check_mirror(values: tuple[str, ...], description: RobotDescription) -> None:
    _count(values, 1)
    _joint(values[0], description)


def _check_number_of_joint(values: tuple[str, ...], description: RobotDescription) -> None:
    _count(values, 2)
    _joint(values[0], description)
    _number(values[1])


def _check_model(values: tuple[str, ...], description: RobotDescription) -> None:
    _count(values, 2)
    _joint(values[0], description)


def _check_cells(values: tuple[str, ...], description: RobotDescription) -> None:
    _count(values, 3)
    _known("foot board", values[0], [n for n, one in description.boards.items()
                                     if one.kind == "foot"])  # fmt: skip
    for corner in values[1:]:
        _known("corner", corner, CORNERS)


def _check_imu(values: tuple[str, ...], description: RobotDescription) -> None:
    if description.imu is None:
        raise InputError(f"--miswire: {description.name} has no IMU")
    _count(values, 3)
    for value in values:
        _number(value)


def _check_volts(values: tuple[str, ...], _: RobotDescription) -> None:
    _count(values, 1)
    if _number(values[0]) <= 0:
        raise InputError("--miswire: volts must be above 0")


MISWIRE_KINDS = {
    "swap": MiswireKind(
        "swap=A,B", "the plugs of two buses or boards, or the ids of two servos, are exchanged",
        _check_swap,
    ),
    "mirror": MiswireKind("mirror=JOINT", "its servo is mounted the other way round",
                          _check_mirror),
    "offset": MiswireKind("offset=JOINT,DEG", "its horn is put on so much turned",
                          _check_number_of_joint),
    "cells": MiswireKind("cells=BOARD,CORNER,CORNER", "the wires of two cells are exchanged",
                         _check_cells),
    "imu": MiswireKind("imu=ROLL,PITCH,YAW", "the IMU is mounted turned [°]; 180,0,0 is upside "
                       "down", _check_imu),
    "model": MiswireKind("model=JOINT,MODEL", "another servo model is there", _check_model),
    "firmware": MiswireKind("firmware=JOINT,VERSION", "it has another firmware",
                            _check_number_of_joint),
    "volts": MiswireKind("volts=V", "the wrong pack is plugged in", _check_volts),
}  # fmt: skip
"""Everything that can be wrong, by name."""


def parse_miswires(texts: Sequence[str], description: RobotDescription) -> tuple[Miswire, ...]:
    """What `--miswire` says. Raises InputError that names the valid choices."""
    found = []
    for text in texts:
        name, separator, rest = text.partition("=")
        if name not in MISWIRE_KINDS or not separator:
            forms = ", ".join(kind.form for kind in MISWIRE_KINDS.values())
            raise InputError(f"--miswire: {text!r} is not one of {forms}")
        values = tuple(part.strip() for part in rest.split(","))
        MISWIRE_KINDS[name].check(values, description)
        found.append(Miswire(kind=name, values=values))
    return tuple(found)
