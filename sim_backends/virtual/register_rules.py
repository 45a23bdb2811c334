"""Which registers a write reaches, and which values they take: the rules of the control table.

X-series e-manual, control table and Protocol 2.0 status errors. A value outside a register's
own range is a data range error; a goal beyond the limit that another register sets is a data
limit error.
"""

from collections.abc import Callable
from functools import cache
from typing import Protocol

from drivers.dynamixel.control_table import (
    BAUD_CODES,
    WATCHDOG_TRIPPED,
    Access,
    Register,
    RegisterSpec,
)
from drivers.dynamixel.protocol import StatusError
from drivers.dynamixel.servo_models import ServoModel
from sim_backends.virtual.firmware import Firmware

Rows = tuple[RegisterSpec, ...]
PROTOCOL_TYPES = (1, 2, 20, 21, 22)
"""Values of Protocol Type (13): Protocol 1.0 and 2.0, S.BUS, iBUS, RC-PWM."""


class Table(Protocol):
    """A control table as the rules see it."""

    model: ServoModel
    firmware: Firmware
    goal_bounds: tuple[int, int]

    def __getitem__(self, register: Register) -> int:
        """Value of a register."""
        ...


Rule = Callable[[Table, int], StatusError]


@cache
def _rows(registers: frozenset[Register]) -> Rows:
    """Registers by address."""
    return tuple(register.spec for register in Register if register in registers)


@cache
def write_plan(registers: frozenset[Register], address: int, length: int) -> Rows | StatusError:
    """Registers that a write covers, or the error that it gets whatever the values.

    Reserved bytes between registers are skipped; a write to nothing but those, or to a read-only
    register, is an access error, a write to part of a register a data length error.
    """
    end = address + length
    rows = [
        row for row in _rows(registers) if row.address < end and row.address + row.size > address
    ]
    if not rows or any(row.access is Access.READ for row in rows):
        return StatusError.ACCESS
    if rows[0].address < address or rows[-1].address + rows[-1].size > end:
        return StatusError.DATA_LENGTH
    return tuple(rows)


def check_value(row: RegisterSpec, value: int, table: Table) -> StatusError:
    """Whether a register of a table takes a value."""
    low, high = row.minimum, row.maximum
    if (low is not None and value < low) or (high is not None and value > high):
        return StatusError.DATA_RANGE
    rule = _RULES.get(row.address)
    return StatusError.NONE if rule is None else rule(table, value)


def _one_of(choices: Callable[[ServoModel], tuple[int, ...]]) -> Rule:
    def rule(table: Table, value: int) -> StatusError:
        return StatusError.NONE if value in choices(table.model) else StatusError.DATA_RANGE

    return rule


def _between(bounds: Callable[[ServoModel], tuple[int, int]]) -> Rule:
    def rule(table: Table, value: int) -> StatusError:
        low, high = bounds(table.model)
        return StatusError.NONE if low <= value <= high else StatusError.DATA_RANGE

    return rule


def _limited_by(limit: Register) -> Rule:
    def rule(table: Table, value: int) -> StatusError:
        return StatusError.NONE if abs(value) <= table[limit] else StatusError.DATA_LIMIT

    return rule


def _goal_position(table: Table, value: int) -> StatusError:
    low, high = table.goal_bounds
    return StatusError.NONE if low <= value <= high else StatusError.DATA_LIMIT


def _drive_mode(table: Table, value: int) -> StatusError:
    return StatusError.DATA_RANGE if value & ~table.firmware.drive_modes else StatusError.NONE


def _watchdog(table: Table, value: int) -> StatusError:
    """Once tripped it must be cleared by 0 before it takes a time again (assumed)."""
    tripped = table[Register.BUS_WATCHDOG] == WATCHDOG_TRIPPED
    return StatusError.DATA_RANGE if tripped and value else StatusError.NONE


_RULES: dict[int, Rule] = {
    Register.BAUD_RATE.address: _one_of(lambda model: tuple(BAUD_CODES[b] for b in model.bauds)),
    Register.OPERATING_MODE.address: _one_of(lambda model: model.modes),
    Register.DRIVE_MODE.address: _drive_mode,
    Register.PROTOCOL_TYPE.address: _one_of(lambda _: PROTOCOL_TYPES),
    Register.MIN_VOLTAGE_LIMIT.address: _between(lambda model: model.voltage_limits),
    Register.MAX_VOLTAGE_LIMIT.address: _between(lambda model: model.voltage_limits),
    Register.CURRENT_LIMIT.address: _between(lambda model: (0, model.current_limit or 0)),
    Register.BUS_WATCHDOG.address: _watchdog,
    Register.GOAL_PWM.address: _limited_by(Register.PWM_LIMIT),
    Register.GOAL_CURRENT.address: _limited_by(Register.CURRENT_LIMIT),
    Register.GOAL_VELOCITY.address: _limited_by(Register.VELOCITY_LIMIT),
    Register.GOAL_POSITION.address: _goal_position,
}
