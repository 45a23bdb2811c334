"""Virtual time of a virtual robot: wire events and the physics grid on one axis."""

from collections.abc import Callable, Sequence
from heapq import heappop, heappush
from itertools import count

from hil.interface import Readable
from sim_backends.plant import Plant

Callback = Callable[[], None]


class VirtualClock:
    """A discrete-event clock that steps a plant; implements `hil.interface.Clock`.

    Time advances only inside `sleep_until_ns` and `wait_readable`. On the way, physics substeps
    and scheduled callbacks happen in order of time; at a grid point the physics comes first, and
    events of one time happen in the order in which they were scheduled. So a callback between two
    grid points sees the state of the first, and what it changes acts from the second.
    """

    def __init__(self, plant: Plant) -> None:
        self.plant = plant
        self._now_ns = plant.time_ns
        self._grid_ns = plant.grid_time_ns(plant.substep_index + 1)
        self._events: list[tuple[int, int, Callback]] = []
        self._order = count()
        self.deliveries = 0
        """Times that a port was given bytes; whoever gives them counts here."""

    def now_ns(self) -> int:
        """Current time [ns]."""
        return self._now_ns

    def schedule(self, time_ns: int, callback: Callback) -> None:
        """Call back at an absolute time, or as soon as time advances if it is past."""
        heappush(self._events, (time_ns, next(self._order), callback))

    def next_ns(self) -> int:
        """Time of the next event or grid point [ns]."""
        events = self._events
        return min(events[0][0], self._grid_ns) if events else self._grid_ns

    def sleep_until_ns(self, time_ns: int) -> None:
        """Advance to an absolute time; return at once if it is past."""
        self._advance(time_ns, stops=False)

    def wait_readable(self, ports: Sequence[Readable], deadline_ns: int) -> None:
        """Advance until one of the ports has bytes, or to the deadline."""
        if _readable(ports):
            return
        while self._advance(deadline_ns, stops=True):
            if _readable(ports):
                return

    def _advance(self, limit_ns: int, *, stops: bool) -> bool:
        """Advance to a time; True at the first delivery, if it is to stop there."""
        events, seen = self._events, self.deliveries
        while True:
            if events and events[0][0] < self._grid_ns:
                if events[0][0] > limit_ns:
                    break
                self._run_event()
                if stops and self.deliveries != seen:
                    return True
            elif self._grid_ns <= limit_ns:
                self._run_substep()
            else:
                break
        if limit_ns > self._now_ns:
            self._now_ns = limit_ns
        return False

    def _run_event(self) -> None:
        time_ns, _, callback = heappop(self._events)
        if time_ns > self._now_ns:
            self._now_ns = time_ns
        callback()

    def _run_substep(self) -> None:
        plant = self.plant
        self._now_ns = self._grid_ns
        plant.substep()
        self._grid_ns = plant.grid_time_ns(plant.substep_index + 1)

    def advance_once(self, limit_ns: int) -> bool:
        """One event or substep up to a time; False when there is none and the time is reached."""
        next_ns = self.next_ns()
        if next_ns > limit_ns:
            self._now_ns = max(self._now_ns, limit_ns)
            return False
        events = self._events
        if events and events[0][0] < self._grid_ns:
            self._run_event()
        else:
            self._run_substep()
        return True


def _readable(ports: Sequence[Readable]) -> bool:
    """Whether one of them has bytes, or is lost: reading from it will tell."""
    try:
        for port in ports:
            if port.in_waiting:
                return True
    except OSError:
        return True
    return False
