"""Injects the faults of a plan into a virtual robot, each at its time on the virtual clock."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from random import Random

from hil.description import RobotDescription
from hil.fault_kinds import WIRE_KINDS
from hil.fault_spec import FaultSpec, check_faults
from sim_backends.virtual.board_faults import BoardFaults
from sim_backends.virtual.boards import SensorBoard
from sim_backends.virtual.bus import ServoBus
from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.host_port import HostPort
from sim_backends.virtual.servo import EmulatedServo
from sim_backends.virtual.servo_faults import End, ServoFaults
from sim_backends.virtual.wire_faults import WireFault


class Injector:
    """Begins and ends faults. Each draws from a stream of its own, by seed and order.

    Nothing of it runs while no fault is active: the parts look at one reference a packet.
    """

    def __init__(
        self,
        description: RobotDescription,
        clock: VirtualClock,
        seed: int,
        servos: Mapping[str, EmulatedServo],
        lines: Mapping[str, ServoBus | SensorBoard],
        ports: Mapping[str, HostPort],
    ) -> None:
        self._description, self._clock, self._seed = description, clock, seed
        self._lines, self._ports = lines, ports
        self._servos = {}
        for joint in description.joints:
            bus = lines.get(joint.bus or "")
            if isinstance(bus, ServoBus):
                self._servos[joint.name] = ServoFaults(servos[joint.name], bus, clock)
        feet = [foot.board for foot in description.feet.values() if foot.board is not None]
        self._boards = {
            name: BoardFaults(board, _other(name, feet, lines))
            for name, board in lines.items()
            if isinstance(board, SensorBoard)
        }
        self._injected = 0
        self._waiting: tuple[FaultSpec, ...] = ()

    def plan(self, faults: Sequence[FaultSpec]) -> None:
        """Faults of a run: those without a time begin now, the others wait for `begin`.

        Raises InputError for one that the robot cannot have.
        """
        check_faults(faults, self._description)
        self._waiting = tuple(fault for fault in faults if fault.start is not None)
        for fault in faults:
            if fault.start is None:
                self.inject(fault, self._clock.now_ns())

    def begin(self, epoch_ns: int) -> None:
        """T = 0 of the planned faults, on the virtual clock."""
        waiting, self._waiting = self._waiting, ()
        for fault in waiting:
            self.inject(fault, epoch_ns)

    def inject(self, fault: FaultSpec, epoch_ns: int) -> None:
        """Inject one fault whose T counts from a time on the virtual clock.

        Raises InputError for one that the robot cannot have.
        """
        for target in fault.targets(self._description):
            random = Random(f"{self._seed} {self._injected}")
            self._injected += 1
            start = partial(self._start, fault, target, random)
            begin_ns = epoch_ns + round(1e9 * (fault.start or 0.0))
            if begin_ns <= self._clock.now_ns():
                start()
            else:
                self._clock.schedule(begin_ns, start)

    def _start(self, fault: FaultSpec, target: str, random: Random) -> None:
        end = self._begin(fault, target, random)
        if fault.duration is not None:
            until_ns = self._clock.now_ns() + round(1e9 * fault.duration)
            self._clock.schedule(until_ns, end)

    def _begin(self, fault: FaultSpec, target: str, random: Random) -> End:
        if fault.plane == "servo":
            return self._servos[target].begin(fault.kind, fault.values, random)
        if fault.kind in WIRE_KINDS:
            return self._begin_on_wire(fault, target, random)
        return self._boards[target].begin(fault.kind, fault.values)

    def _begin_on_wire(self, fault: FaultSpec, target: str, random: Random) -> End:
        faults = self._lines[target].wire()
        active = WireFault(fault.kind, fault.values, random)
        faults.begin(active)
        ending: list[Callable[[], None]] = [partial(faults.end, active)]
        if fault.kind == "disconnect":
            port = self._ports[target]
            port.unplug()
            ending.append(port.plug_in)

        def end() -> None:
            for step in ending:
                step()

        return end


def _other(
    name: str, feet: Sequence[str], lines: Mapping[str, ServoBus | SensorBoard]
) -> SensorBoard | None:
    """The other foot's board, for a foot's board of a robot with two."""
    others = [board for board in feet if board != name]
    if name not in feet or len(others) != 1:
        return None
    board = lines[others[0]]
    return board if isinstance(board, SensorBoard) else None
