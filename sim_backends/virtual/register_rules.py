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
    Access,
    Register,
    RegisterSpec,
)
from drivers.dynamixel.protocol import StatusError
from drivers.dynamixel.servo_models import SERVO_MODELS, ServoModel

Rows = tuple[RegisterSpec, ...]


class Table(Protocol):
    """A control table as the rules see it."""

    model: ServoModel
    goal_bounds: tuple[int, int]

    def __getitem__(self, register: Register) -> int:
        """Value of a register."""
        ...


Rule = Callable[[Table, int], StatusError]


@cache
def _rows(model_name: str) -> Rows:
    """Registers that a model has, by address."""
    model = SERVO_MODELS[model_name]
    missing: set[Register] = set()
    if model.current_limit is None:
        missing |= {Register.CURRENT_LIMIT, Register.GOAL_CURRENT}
    if model.pwm_slope is None:
        missing.add(Register.PWM_SLOPE)
    return tuple(register.spec for register in Register if register not in missing)


@cache
def write_plan(model_name: str, address: int, length: int) -> Rows | StatusError:
    """Registers that a write covers, or the error that it gets whatever the values.

    Reserved bytes between registers are skipped; a write to nothing but those, or to a read-only
    register, is an access error, a write to part of a register a data length error.
    """
    end = address + length
    rows = [
        row for row in _rows(model_name) if row.address < end and row.address + row.size > address
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


_RULES: dict[int, Rule] = {
    Register.BAUD_RATE.address: _one_of(lambda model: tuple(BAUD_CODES[b] for b in model.bauds)),
    Register.OPERATING_MODE.address: _one_of(lambda model: model.modes),
    Register.MIN_VOLTAGE_LIMIT.address: _between(lambda model: model.voltage_limits),
    Register.MAX_VOLTAGE_LIMIT.address: _between(lambda model: model.voltage_limits),
    Register.CURRENT_LIMIT.address: _between(lambda model: (0, model.current_limit or 0)),
    Register.GOAL_PWM.address: _limited_by(Register.PWM_LIMIT),
    Register.GOAL_CURRENT.address: _limited_by(Register.CURRENT_LIMIT),
    Register.GOAL_VELOCITY.address: _limited_by(Register.VELOCITY_LIMIT),
    Register.GOAL_POSITION.address: _goal_position,
}
