"""Setting up servos: what will change, then changing it."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from hil.bringup.facts import ServoPlan
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.description import RobotDescription
from hil.errors import InputError


class SetUp:
    """Plans for some servos of a robot, and the open ports to carry them out on."""

    def __init__(
        self,
        bench: commissioning.RobotBench,
        plans: list[ServoPlan],
        line: commissioning.ServoLine | None = None,
    ) -> None:
        """`line`: the port of a servo that is set up alone; else each is on its bus."""
        self._bench = bench
        self._line = line
        self.plans = plans

    @property
    def changing(self) -> list[ServoPlan]:
        """Plans that change something."""
        return [plan for plan in self.plans if plan.changes]

    @property
    def blocked(self) -> list[ServoPlan]:
        """Servos that answer and must not be touched."""
        return [plan for plan in self.plans if plan.problem and not is_absent(plan)]

    @property
    def left_out(self) -> dict[str, str]:
        """Why a bus is not open, by name; none for a servo that is set up alone."""
        if self._line is not None:
            return {}
        buses = self._bench.description.buses
        return {bus: why for bus, why in self._bench.closed.items() if bus in buses}

    def apply(self, done: Callable[[ServoPlan], None]) -> None:
        """Carry all plans out, reading back. Raises BackendError at the first that fails."""
        for plan in self.changing:
            bus, servo = self._bench.find(plan.joint)
            commissioning.apply_plan(self._line or self._bench.lines[bus], servo, plan)
            done(plan)


def is_absent(plan: ServoPlan) -> bool:
    """Whether nobody answered: legal, a robot may be built leg by leg."""
    return plan.problem == commissioning.SILENT


@contextmanager
def robot_set_up(
    description: RobotDescription, ports: dict[str, str], joints: Sequence[str]
) -> Iterator[SetUp]:
    """The servos in place. Raises InputError, UnknownNameError or BackendError."""
    with _bench(description, ports) as bench:
        bench.require_bus()
        yield SetUp(bench, commissioning.plan_robot(bench, joints))


@contextmanager
def replacement_set_up(
    description: RobotDescription, ports: dict[str, str], joint: str
) -> Iterator[SetUp]:
    """The one stranger on a joint's bus, to take its place."""
    with _bench(description, ports) as bench:
        bench.require_bus()
        yield SetUp(bench, [commissioning.plan_replacement(bench, joint)])


@contextmanager
def single_set_up(description: RobotDescription, port: str, joint: str) -> Iterator[SetUp]:
    """The only servo on a port, to become a joint's."""
    with _bench(description, {}) as bench:
        bench.find(joint)
        line = commissioning.open_line(port, MonotonicClock())
        try:
            yield SetUp(bench, [commissioning.plan_new(line, bench, joint)], line)
        finally:
            line.close()


def _bench(description: RobotDescription, ports: dict[str, str]) -> commissioning.RobotBench:
    if description.actuation != "servo":
        raise InputError(f"{description.name} has no servos to set up")
    return commissioning.RobotBench(description, ports, MonotonicClock(), boards=False)
