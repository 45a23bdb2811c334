"""Searching ports for servos."""

from collections.abc import Callable, Sequence

from hil.bringup.facts import FoundPort, PortSearch
from hil.clock import MonotonicClock
from hil.compose import commissioning


def list_ports() -> list[FoundPort]:
    """The serial ports of this computer."""
    return commissioning.found_ports()


def search_ports(
    ports: Sequence[str], bauds: Sequence[int], progress: Callable[[str], None]
) -> list[PortSearch]:
    """Everybody on these ports. Raises PortError, InputError or BackendError."""
    speeds = commissioning.check_bauds(bauds)
    clock = MonotonicClock()
    lines = []
    try:
        for port in ports:
            lines.append(commissioning.open_line(port, clock))
        return [commissioning.search_line(line, speeds, progress) for line in lines]
    finally:
        for line in lines:
            line.close()
