"""`stride scan`: which ports there are, and which servos answer on them."""

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Exit, Option

if TYPE_CHECKING:
    from hil.bringup.facts import FoundPort, PortSearch

EPILOG = """[bold]Examples[/bold]

stride scan                                          list the ports; nothing is sent

stride scan /dev/serial/by-id/usb-FTDI_USB__-if00    every speed and id on one port, about 8 s

stride scan /dev/ttyUSB0 --baud 57600                a new servo: id 1 at 57600 baud
"""


def scan(
    ports: Annotated[
        list[str] | None,
        Argument(metavar="PORT", help="Ports to search; none lists them, nothing is sent."),
    ] = None,
    bauds: Annotated[
        list[int] | None,
        Option("--baud", help="Only this speed; repeatable.", show_default="all eight"),
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print what was found as JSON.")] = False,
) -> None:
    """Find servos: every speed, every id, their model, firmware and what it lacks.

    No robot file is needed, nothing moves and nothing is written. Exit code 0: servos answer;
    1: none does, or answers cannot be trusted; 2: bad input.
    """
    from rich.console import Console

    from hil.bringup.scan import list_ports, search_ports

    if not ports:
        _print_ports(list_ports(), as_json)
        return
    console = Console(stderr=True)
    with console.status("") as status:
        searches = search_ports(ports, bauds or [], status.update)
    if as_json:
        sys.stdout.write(json.dumps([asdict(search) for search in searches], indent=2) + "\n")
    else:
        _print_servos(searches)
    found = any(search.servos for search in searches)
    if not found or any(search.suspicious for search in searches):
        raise Exit(1)


def _print_ports(found: "list[FoundPort]", as_json: bool) -> None:
    from hil.cli.bringup_tables import print_text

    if as_json:
        sys.stdout.write(json.dumps([asdict(port) for port in found], indent=2) + "\n")
        return
    if not found:
        sys.stdout.write(
            "no serial port is connected; without hardware: stride emulate, then "
            "stride scan with one of its ports\n"
        )
        return
    rows = [(port.by_id or "–", port.device, port.description) for port in found]
    print_text("Serial ports", ("by id: stays the same", "now", "what"), rows)
    sys.stdout.write("search one: stride scan PORT\n")


def _print_servos(searches: "list[PortSearch]") -> None:
    from hil.cli.bringup_tables import print_text

    rows = [
        (
            servo.port,
            str(servo.baud),
            str(servo.id),
            servo.model or f"unknown ({servo.number})",
            str(servo.firmware),
            ", ".join(servo.lacks) or "nothing",
        )
        for search in searches
        for servo in search.servos
    ]
    if rows:
        print_text("", ("port", "baud", "id", "model", "firmware", "lacks"), rows)
    for search in searches:
        if not search.servos:
            sys.stdout.write(
                f"{search.port}: no servo answers; is its supply on, is the plug in?\n"
            )
        for sentence in search.suspicious:
            sys.stdout.write(f"suspicious: {sentence}\n")
