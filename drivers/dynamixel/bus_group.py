"""All servo buses in one tick: send all requests, then receive all answers."""

from collections.abc import Sequence

from drivers.dynamixel.bus import ServoBus
from hil.interface import Clock
from hil.servo import ServoGoals


class BusGroup:
    """The buses of a robot, talked to at the same time by one thread."""

    def __init__(self, buses: Sequence[ServoBus], clock: Clock) -> None:
        self.buses = tuple(buses)
        self._clock = clock

    def send_reads(self) -> None:
        """Send every bus's request of this tick."""
        for bus in self.buses:
            bus.begin_read(self._clock.now_ns())

    def receive(self) -> None:
        """Wait for the answers, at most until each bus's deadline."""
        waiting = [bus for bus in self.buses if not bus.collect()]
        while waiting:
            deadline_ns = min(bus.deadline_ns for bus in waiting)
            self._clock.wait_readable([bus.port.stream for bus in waiting], deadline_ns)
            now_ns = self._clock.now_ns()
            waiting = [bus for bus in waiting if not bus.collect() and now_ns < bus.deadline_ns]
        for bus in self.buses:
            bus.finish_read()

    def write(self, goals: ServoGoals | None, spare_ns: int) -> None:
        """Send the goals, if there are any, on every bus; `spare_ns` are left until the next
        tick."""
        for bus in self.buses:
            bus.write(goals, spare_ns)

    def arm(self, armed: bool) -> None:
        """Torque was switched on or off on every bus."""
        for bus in self.buses:
            bus.arm(armed)
