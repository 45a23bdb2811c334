"""From open buses to their hot path: check the servos, then set up for what they can do."""

from collections.abc import Sequence
from dataclasses import dataclass

from drivers.assembly import BusParts, bus_budgets
from drivers.dynamixel.bus import LEAST_MARGIN_NS, ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.idle_read import IdleReader, idle_blocks
from drivers.dynamixel.port import latency_warning
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.states import ServoStates
from hil.description import RobotDescription
from hil.errors import BackendError
from hil.interface import Clock


@dataclass(frozen=True, slots=True)
class StartedBuses:
    """Buses that are ready for ticks."""

    group: BusGroup
    changes: list[str]
    """Servo settings that were corrected, and what is wrong with an adapter."""


def start_buses(
    description: RobotDescription,
    parts: Sequence[BusParts],
    states: ServoStates,
    clock: Clock,
    rate_hz: int,
) -> StartedBuses:
    """Audit every bus and make its hot path. Raises BackendError or InputError.

    A tick's time that is not needed goes to waiting for late answers, but for what the read in
    idle time takes.
    """
    results = {part.name: part.audit() for part in parts}
    problems = [problem for result in results.values() for problem in result.problems]
    if problems:
        raise BackendError("; ".join(problems))
    fast = {name: result.fast_reads for name, result in results.items()}
    budgets = {budget.bus: budget for budget in bus_budgets(description, fast)}
    buses = []
    for part in parts:
        budget = budgets[part.name]
        budget.check(rate_hz)
        part.read_slow(states)
        spare_ns = budget.slack_ns(rate_hz) + budget.idle_ns
        ids = [servo.id for servo in part.servos]
        idle = IdleReader(ids, idle_blocks(spare_ns, part.timing.baud), part.timing.baud)
        servos = [BusServo(*pair) for pair in zip(ids, part.joints, strict=True)]
        margin_ns = max(LEAST_MARGIN_NS, spare_ns - idle.duration_ns)
        buses.append(
            ServoBus(
                part.name, part.port, part.timing, servos, states, fast[part.name], idle, margin_ns
            )
        )
    changes = [change for result in results.values() for change in result.changes]
    planned = [(part.port, description.buses[part.name].latency_timer_ms) for part in parts]
    warnings = (latency_warning(*pair) for pair in planned)
    changes += [warning for warning in warnings if warning is not None]
    return StartedBuses(BusGroup(buses, clock), changes)
