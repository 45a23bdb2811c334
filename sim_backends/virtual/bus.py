"""One emulated servo bus: half-duplex wire, who answers when, and the watchdog's silence."""

from collections.abc import Callable, Sequence
from functools import partial

from drivers.dynamixel.control_table import BAUD_CODES
from drivers.dynamixel.protocol import Instruction, PacketReader
from sim_backends.latency import wire_time_ns
from sim_backends.virtual.adapter import UsbAdapter
from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.dispatch import Dispatcher, Reply
from sim_backends.virtual.host_timing import HostTiming
from sim_backends.virtual.servo import EmulatedServo
from sim_backends.virtual.wire_faults import WireFaults

_INSTRUCTION_BYTE = 7
_GOAL_WRITES = {Instruction.SYNC_WRITE, Instruction.BULK_WRITE}


class ServoBus:
    """Servos on one wire behind one adapter.

    Every byte takes ten bit times at the host's baud. A servo at another baud hears nothing. An
    answer begins a turnaround and the servo's Return Delay Time after the packet, or after the
    answer before it in a chain. What the host sends while servos talk is lost, as on the real
    half-duplex wire; what it sends while it is itself still sending follows on.
    """

    def __init__(
        self,
        servos: Sequence[EmulatedServo],
        adapter: UsbAdapter,
        host: HostTiming,
        clock: VirtualClock,
    ) -> None:
        self._servos = tuple(servos)
        self._adapter = adapter
        self._host = host
        self._clock = clock
        self._dispatcher = Dispatcher(self._servos)
        self._reader = PacketReader()
        self._baud = 0
        self._host_until_ns = self._servos_until_ns = 0
        self._heard_ns = clock.now_ns()
        self._look_ns: int | None = None
        """When the watchdogs are looked at next."""
        self._faults: WireFaults | None = None
        self.on_packet: Callable[[str], None] | None = None
        """Told `heard` for every packet, `collided` for host bytes that were lost."""
        self.collisions = 0
        """Host transmissions that were lost because servos were talking."""
        for servo in self._servos:
            servo.on_watchdog = self._watch

    def host_wrote(self, data: bytes, baud: int) -> None:
        """Bytes leave the host now: through the adapter, along the wire, to the servos."""
        goals = len(data) > _INSTRUCTION_BYTE and data[_INSTRUCTION_BYTE] in _GOAL_WRITES
        leave_ns = self._host.departure_ns(goals)
        if self._faults is None:
            self._transmit(data, baud, leave_ns)
            return
        echoes = self._faults.echoes()
        delay_ns, left = self._faults.to_devices(data)
        if left:
            begin_ns = self._transmit(left, baud, leave_ns + delay_ns)
            if echoes:
                self._adapter.forward([(begin_ns, left)], baud)

    def wire(self) -> WireFaults:
        """Faults of the wire; there is a list of them from the first call on."""
        if self._faults is None:
            self._faults = WireFaults()
        return self._faults

    def _transmit(self, data: bytes, baud: int, leave_ns: int) -> int:
        """Put bytes on the wire as soon as they may leave and it is free; when they begin."""
        begin_ns = max(leave_ns + self._adapter.transfer_ns(), self._host_until_ns)
        end_ns = begin_ns + wire_time_ns(len(data), baud)
        self._host_until_ns = end_ns
        self._clock.schedule(end_ns, partial(self._arrive, data, baud, begin_ns))
        return begin_ns

    def _arrive(self, data: bytes, baud: int, begin_ns: int) -> None:
        if begin_ns < self._servos_until_ns:
            self.collisions += 1
            if self.on_packet is not None:
                self.on_packet("collided")
            return
        if baud != self._baud:
            self._baud = baud
            self._reader.reset()
        now_ns = self._clock.now_ns()
        for packet in self._reader.feed(data):
            self._heard_ns = now_ns
            if self.on_packet is not None:
                self.on_packet("heard")
            if self._faults is not None:
                self._faults.draw()
            self._answer(self._dispatcher.handle(packet, BAUD_CODES.get(baud, -1), now_ns))

    def _answer(self, replies: Sequence[Reply]) -> None:
        """Put answers on the wire one after another."""
        end_ns = begin_ns = self._clock.now_ns()
        segments = []
        for reply in replies:
            start_ns = max(end_ns + reply.gap_ns, begin_ns + reply.slot_ns)
            end_ns = start_ns + wire_time_ns(len(reply.data), self._baud)
            segments.append((start_ns, reply.data))
        if segments:
            self._servos_until_ns = end_ns
            if self._faults is not None:
                segments = self._faults.to_host(segments, self._baud)
            self._adapter.forward(segments, self._baud)

    def _watch(self) -> None:
        """Look at the watchdogs when the first of them may trip."""
        periods = [servo.watchdog_ns for servo in self._servos if servo.watchdog_ns]
        if not periods:
            return
        now_ns, shortest = self._clock.now_ns(), min(periods)
        due_ns = self._heard_ns + shortest
        # One that is silent for longer already has its torque off and will not trip: look later.
        due_ns = due_ns if due_ns > now_ns else now_ns + shortest
        if self._look_ns is None or due_ns < self._look_ns:
            self._look_ns = due_ns
            self._clock.schedule(due_ns, partial(self._look, due_ns))

    def _look(self, due_ns: int) -> None:
        if due_ns != self._look_ns:
            return  # A period became shorter: an earlier look took this one's place.
        self._look_ns = None
        silence_ns = self._clock.now_ns() - self._heard_ns
        for servo in self._servos:
            if 0 < servo.watchdog_ns <= silence_ns:
                servo.trip()
        self._watch()
