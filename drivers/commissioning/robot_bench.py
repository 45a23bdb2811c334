"""A robot's open ports before it is known whether they are what they should be."""

from collections.abc import Iterable, Mapping

from drivers.assembly import expected_servos, port_url
from drivers.commissioning.line import ServoLine
from drivers.dynamixel.audit import ExpectedServo
from drivers.dynamixel.port import Port
from hil.description import RobotDescription
from hil.errors import InputError, PortError, UnknownNameError
from hil.interface import Clock


class RobotBench:
    """Lines to the buses and ports of the boards that could be opened; the others' reasons."""

    def __init__(
        self,
        description: RobotDescription,
        port_urls: Mapping[str, str],
        clock: Clock,
        boards: bool = True,
    ) -> None:
        """`port_urls`: some or all buses and boards, by name; `boards`: whether to open those."""
        self.description = description
        self.clock = clock
        self.urls = dict(port_urls)
        self.lines: dict[str, ServoLine] = {}
        self.boards: dict[str, Port] = {}
        self.closed: dict[str, str] = {}
        """Why a bus or board is not open, by name."""
        for name, bus in description.buses.items():
            port = self._open(name, bus.baud)
            if port is not None:
                self.lines[name] = ServoLine(port, clock)
        for name, board in description.boards.items() if boards else ():
            port = self._open(name, board.baud)
            if port is not None:
                self.boards[name] = port

    def _open(self, name: str, baud: int) -> Port | None:
        if name not in self.urls:
            self.closed[name] = "no port is given"
            return None
        try:
            return Port(name, port_url(self.urls, name), baud)
        except PortError as error:
            self.closed[name] = str(error).partition(": ")[2]
            return None

    def require_bus(self) -> None:
        """Raises InputError when not a single servo bus is open."""
        if not self.lines:
            reasons = "; ".join(f"{name}: {self.closed[name]}" for name in self.description.buses)
            raise InputError(f"{self.description.name}: no servo bus can be opened: {reasons}")

    def expected(self, bus: str) -> list[ExpectedServo]:
        """Servos that the robot file has on a bus."""
        return list(expected_servos(self.description, bus))

    def find(self, joint: str) -> tuple[str, ExpectedServo]:
        """Bus and servo of a joint. Raises UnknownNameError."""
        for bus in self.description.buses:
            for servo in self.expected(bus):
                if servo.joint == joint:
                    return bus, servo
        raise UnknownNameError("joint", joint, self.description.joint_names)

    def baud(self, bus: str) -> int:
        """Speed that the robot file gives a bus [bit/s]."""
        return self.description.buses[bus].baud

    def open_buses(self) -> Iterable[tuple[str, ServoLine]]:
        """Open lines, each set back to its bus's speed."""
        for name, line in self.lines.items():
            line.port.set_baud(self.baud(name))
            yield name, line

    def close(self) -> None:
        """Close all ports."""
        for line in self.lines.values():
            line.close()
        for port in self.boards.values():
            port.close()

    def __enter__(self) -> "RobotBench":
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.close()
