"""Which port each bus and board of a robot is on: from the robot file, options and a file."""

from collections.abc import Sequence
from pathlib import Path

from hil.description import RobotDescription
from hil.errors import InputError, UnknownNameError
from hil.run_folder import read_json

FORM = "NAME=DEVICE, as in left_leg=/dev/serial/by-id/usb-FTDI_..."


def robot_ports(
    description: RobotDescription, options: Sequence[str], file: Path | None
) -> dict[str, str]:
    """Ports by the names of buses and boards; options win over the file, it over the robot file.

    `file` is what `stride emulate --json` prints. Raises InputError where not a single bus has a
    port, and UnknownNameError.
    """
    if not description.buses:
        raise InputError(f"{description.name} has no servo bus: it is a robot of simulations only")
    names = (*description.buses, *description.boards)
    known = {name: bus.port for name, bus in description.buses.items()}
    known |= {name: board.port for name, board in description.boards.items()}
    ports = {name: port for name, port in known.items() if port is not None}
    if file is not None:
        content = read_json(file)
        found = {**content.get("buses", {}), **content.get("boards", {})}
        ports |= {_known(name, names): str(port) for name, port in found.items()}
    for option in options:
        name, separator, port = option.partition("=")
        if not separator or not port:
            raise InputError(f"--port: {option!r} is not of the form {FORM}")
        ports[_known(name, names)] = port
    if not set(ports) & set(description.buses):
        raise InputError(
            f"{description.file}: buses.{next(iter(description.buses))}.port: is missing; write "
            f"it there or give --port {next(iter(description.buses))}=DEVICE (ports: stride scan). "
            "Without hardware: stride emulate --json > ports.json & and --ports ports.json"
        )
    return ports


def _known(name: str, names: Sequence[str]) -> str:
    if name not in names:
        raise UnknownNameError("bus or board in --port", name, names)
    return name
