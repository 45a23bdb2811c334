"""How fast a robot's loop may run here: its buses' wire time and this computer's own."""

import tempfile
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hil.bus_report import with_buses
from hil.compose import build, bus_budgets
from hil.cycle import TickRecord
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats, Readable
from hil.loop import Loop
from hil.recorder import Recorder
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.run_folder import make_meta
from hil.timing import stopwatch_ns

MARGIN = 0.1
"""Share of the period that stays free, for what was not measured."""
BAUDS = (1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000)


@dataclass(frozen=True, slots=True)
class Phase:
    """One part of a tick."""

    name: str
    kind: str
    """`bus` for computed wire time, `computer` for measured time."""
    p50_ms: float
    p99_ms: float


@dataclass(frozen=True, slots=True)
class RobotBudget:
    """The phases of a robot's tick on this computer."""

    robot: str
    phases: tuple[Phase, ...]
    tick_p50_ms: float
    """Bus time, and the computer's in every other tick."""
    tick_p99_ms: float
    """Bus time, and the computer's in 99 of 100 ticks."""

    @property
    def highest_rate_hz(self) -> int:
        """The highest rate that leaves MARGIN of the period free."""
        return int(1e3 * (1 - MARGIN) / self.tick_p99_ms)

    @property
    def quiet_rate_hz(self) -> int:
        """The same, were this computer never slower than in the better half of the ticks."""
        return int(1e3 * (1 - MARGIN) / self.tick_p50_ms)

    @property
    def limit(self) -> str:
        """The phase that takes most of the tick."""
        return max(self.phases, key=lambda phase: phase.p99_ms).name


@dataclass(frozen=True, slots=True)
class BaudRow:
    """Whether a robot's buses carry a rate at one speed."""

    baud: int
    ports: int
    needed_ms: float
    free_pct: float
    """Of the period, beside bus and planned computing time; negative where it does not fit."""
    bus_free_pct: float
    """Of the period, beside the bus alone."""
    highest_rate_hz: int


class HostTimes:
    """A sink that keeps what the computer itself did in every tick [ms].

    In lockstep the time of the simulation hides in waiting: it is measured and taken off.
    """

    def __init__(self) -> None:
        self._rows: list[tuple[int, int, int, int, int]] = []
        self._waited_ns = 0

    def watch(
        self, wait: Callable[[Sequence[Readable], int], None]
    ) -> Callable[[Sequence[Readable], int], None]:
        """A clock's `wait_readable` whose time is not the computer's."""

        def timed(ports: Sequence[Readable], deadline_ns: int) -> None:
            started = stopwatch_ns()
            wait(ports, deadline_ns)
            self._waited_ns += stopwatch_ns() - started

        return timed

    def put(self, record: TickRecord) -> None:
        """Take one walking tick."""
        timing, waited_ns = record.timing, self._waited_ns
        self._waited_ns = 0
        if timing.tick < 0:
            return
        rest = timing.cycle_ns - timing.truth_ns - timing.read_ns - timing.estimate_ns
        rest -= timing.control_ns + timing.write_ns
        read_ns = timing.read_ns - waited_ns
        parts = read_ns, timing.estimate_ns, timing.control_ns, timing.write_ns, rest
        self._rows.append(parts)

    @property
    def table_ms(self) -> Floats:
        """Read, estimate, control, write and the rest, shape (ticks, 5)."""
        return np.array(self._rows, dtype=np.float64) * 1e-6


def measure_budget(robot: str, overrides: tuple[str, ...], duration_s: float) -> RobotBudget:
    """Walk in lockstep and add the wire time that the buses need. Raises InputError."""
    description = load_robot(robot, overrides)
    if not description.buses:
        raise InputError(f"{description.name} has no servo bus, so no budget")
    request = RunRequest.checked(
        robot=robot, backend="bus", duration_s=duration_s, overrides=overrides
    )
    session, times = build(request), HostTimes()
    clock = session.backend.clock
    vars(clock)["wait_readable"] = times.watch(clock.wait_readable)
    with tempfile.TemporaryDirectory() as folder:
        recorder = Recorder(Path(folder), make_meta(session), truth=True, progress=False)
        with closing(session), recorder:
            session.backend.open()
            Loop(session, (times, recorder)).run()
    budgets = bus_budgets(description)
    wire = {
        "read on the wire": max(budget.read_ns for budget in budgets) * 1e-6,
        "write on the wire": max(budget.write_ns for budget in budgets) * 1e-6,
        "idle read on the wire": max(budget.idle_ns for budget in budgets) * 1e-6,
    }
    table = times.table_ms
    phases = [Phase(name, "bus", ms, ms) for name, ms in wire.items()]
    names = ("decode, convert", "estimate", "control", "map, encode", "judge, record")
    phases += [
        Phase(name, "computer", float(np.median(row)), float(np.percentile(row, 99)))
        for name, row in zip(names, table.T, strict=True)
    ]
    p50_ms, p99_ms = sum(wire.values()) + np.percentile(table.sum(axis=1), (50, 99))
    return RobotBudget(description.name, tuple(phases), float(p50_ms), float(p99_ms))


def baud_table(description: RobotDescription, rate_hz: int) -> list[BaudRow]:
    """Every speed, with the robot's own buses and with all servos on one."""
    rows = []
    for baud in BAUDS:
        for ports in sorted({1, len(description.buses)}):
            changed = with_buses(description, baud, ports)
            worst = max(bus_budgets(changed), key=lambda budget: budget.needed_ns)
            period_ns = 1_000_000_000 // rate_hz
            rows.append(
                BaudRow(
                    baud, ports, worst.needed_ns * 1e-6,
                    100 * worst.slack_ns(rate_hz) / period_ns,
                    100 * (period_ns - worst.bus_ns) / period_ns,
                    worst.highest_rate_hz,
                )
            )  # fmt: skip
    return rows
