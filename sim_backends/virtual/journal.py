"""What emulated servos heard and did, and when: what a test of the safety chain looks at."""

from collections import deque
from collections.abc import Callable, Mapping
from functools import partial

from sim_backends.virtual.bus import ServoBus
from sim_backends.virtual.servo import EmulatedServo

PACKETS, DEEDS = 20_000, 2_000
"""Events kept, the newest: some seconds of packets, and what servos did with torque in hours."""

Event = tuple[int, str, str]
"""Time [ns], who, what."""


class Journal:
    """Two rings in memory: packets that a bus heard (or lost), and what servos did about torque.

    The question is never whether a host called stop, but what the servos ended up doing. A packet
    is `heard` when its last byte has arrived; host bytes that servos talked into are `collided`.
    A servo is told `torque on` or `torque off` in every write, changed or not, and `stopped` when
    its bus watchdog trips.
    """

    def __init__(
        self,
        servos: Mapping[str, EmulatedServo],
        buses: Mapping[str, ServoBus],
        now_ns: Callable[[], int],
    ) -> None:
        """Begin to write down; `now_ns` on whatever clock the reader wants."""
        self._now_ns = now_ns
        self._packets: deque[Event] = deque(maxlen=PACKETS)
        self._deeds: deque[Event] = deque(maxlen=DEEDS)
        for name, servo in servos.items():
            servo.drive.on_torque = partial(self._torque, name)
            servo.on_trip = partial(self._note, self._deeds, name, "stopped")
        for name, bus in buses.items():
            bus.on_packet = partial(self._note, self._packets, name)

    def content(self, *, packets: bool = True) -> dict[str, list[Event]]:
        """The rings, oldest first, as JSON takes them; `deeds` alone are few."""
        return {"packets": list(self._packets) if packets else [], "deeds": list(self._deeds)}

    def _torque(self, name: str, on: bool) -> None:
        self._note(self._deeds, name, "torque on" if on else "torque off")

    def _note(self, ring: deque[Event], name: str, what: str) -> None:
        ring.append((self._now_ns(), name, what))
