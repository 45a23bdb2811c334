"""The modelled compute time of the host: when goals leave that were computed from an answer."""

from collections.abc import Callable, Sequence

from sim_backends.virtual.host_port import HostPort


class HostTiming:
    """In lockstep computing takes no virtual time, so goals wait here for as long as it should.

    Goals (sync and bulk writes) leave no sooner than `compute_ns` after the host last took bytes
    from a bus. Other packets need no computing and leave at once. With `compute_ns` 0 the host
    is a real one whose own time counts.
    """

    def __init__(
        self, compute_ns: int, bus_ports: Sequence[HostPort], now_ns: Callable[[], int]
    ) -> None:
        """`now_ns`: the host's time; a virtual robot may be a little ahead of a real host."""
        self._compute_ns = compute_ns
        self._ports = tuple(bus_ports)
        self._now_ns = now_ns

    def departure_ns(self, goals: bool) -> int:
        """When a packet that the host writes now leaves it [ns]."""
        now_ns = self._now_ns()
        if not goals or not self._compute_ns:
            return now_ns
        last_ns = max([port.last_read_ns for port in self._ports])
        return max(now_ns, last_ns + self._compute_ns)
