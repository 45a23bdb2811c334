"""Looking at a robot again and again, without touching it."""

from collections.abc import Iterator

from hil.bringup.facts import RobotReading
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.description import RobotDescription
from hil.signals import StopSignals


def watch(
    description: RobotDescription,
    ports: dict[str, str],
    rate_hz: float,
    duration_s: float | None,
) -> Iterator[tuple[float, RobotReading]]:
    """Readings with their times [s], until the duration is over or a signal says stop.

    A look that takes longer than its period delays the next one. Raises InputError where no bus
    opens, and BackendError for a port that is lost.
    """
    clock, signals = MonotonicClock(), StopSignals()
    calibration = commissioning.calibration_of(description)
    with signals.caught(), commissioning.RobotBench(description, ports, clock) as bench:
        bench.require_bus()
        view = commissioning.Watch(bench, calibration)
        began_ns = clock.now_ns()
        while signals.first() is None:
            now_ns = clock.now_ns()
            time_s = (now_ns - began_ns) * 1e-9
            if duration_s is not None and time_s > duration_s:
                return
            yield time_s, view.read()
            clock.sleep_until_ns(now_ns + round(1e9 / rate_hz))
