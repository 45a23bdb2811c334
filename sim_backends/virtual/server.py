"""The virtual robot as a process of its own, on pseudo-terminals and in real time.

`python -m sim_backends.virtual.server ROBOT --json` prints one line when it is ready,
`{"buses": {name: port}, "boards": {name: port}, "control": path}`, and serves until SIGTERM,
SIGINT, a `quit` on the control socket, or the end of a pipe that is its standard input.
"""

import argparse
import json
import os
import select
import shutil
import signal
import stat
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hil.description import RobotDescription
from hil.errors import StrideError
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.control import ControlServer, Request, three_numbers
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.pty_line import PtyLine
from sim_backends.virtual.robot import VirtualRobot
from sim_backends.virtual.truth_block import TruthBlock


class VirtualRobotServer:
    """Paces a virtual robot by the monotonic clock and moves bytes to and from its terminals.

    Virtual time 0 is the moment of construction. Answers leave when their modelled time has come,
    never before; how much later is up to the machine.
    """

    def __init__(self, description: RobotDescription, rate_hz: int, seed: int) -> None:
        plant = Plant(description, rate_hz, seed, nominal_motors(description))
        self._robot = VirtualRobot(description, plant, seed, rate_hz, host_computes=False)
        self._plant = plant
        self._folder = Path(tempfile.mkdtemp(prefix="stridebridge-"))
        self._truth = TruthBlock(self._folder / "truth", len(description.joints), create=True)
        handlers = {"hello": self._hello, "push": self._push, "support": self._support,
                    "quit": self._quit}  # fmt: skip
        self._control = ControlServer(self._folder / "control", handlers)
        robot = self._robot
        self._lines = {
            name: PtyLine(robot.ports[name], robot.devices[name]) for name in robot.ports
        }
        self._running = True
        self._start_ns = time.monotonic_ns()
        self._publish()

    def ports(self) -> dict[str, Any]:
        """What the ready line tells."""
        description = self._robot.description
        return {
            "buses": {name: self._lines[name].path for name in description.buses},
            "boards": {name: self._lines[name].path for name in description.boards},
            "control": str(self._folder / "control"),
        }

    def serve(self, watch_stdin: bool) -> None:
        """Run until told to stop. Raises BackendError when the simulation diverges."""
        while self._running:
            self._advance()
            lines = [line for line in self._lines.values() if line.has_client()]
            waiting: list[Any] = [*lines, *self._control.sockets()]
            if watch_stdin:
                waiting.append(sys.stdin)
            clock = self._robot.clock
            timeout = max(0, clock.next_ns() - self._now_ns()) * 1e-9
            ready, _, _ = select.select(waiting, [], [], timeout)
            if ready:
                self._advance()
            for source in ready:
                self._take(source)

    def _take(self, source: Any) -> None:
        if isinstance(source, PtyLine):
            source.receive()
        elif source is not sys.stdin:
            self._control.serve(source)
        elif not os.read(sys.stdin.fileno(), 4096):
            self._running = False

    def _now_ns(self) -> int:
        return time.monotonic_ns() - self._start_ns

    def _advance(self) -> None:
        """Let virtual time catch up with real time."""
        before = self._plant.substep_index
        self._robot.clock.sleep_until_ns(self._now_ns())
        if self._plant.substep_index != before:
            self._publish()

    def _publish(self) -> None:
        self._truth.write(self._plant.truth(), self._start_ns)

    # Control requests ------------------------------------------------------------------------

    def _hello(self, _: Request) -> dict[str, Any]:
        return {
            "robot": self._robot.description.name,
            "rate_hz": self._plant.rate_hz,
            "joints": len(self._robot.description.joints),
            "truth": str(self._folder / "truth"),
            "calibration": self._robot.calibration_data,
        }

    def _push(self, request: Request) -> dict[str, Any]:
        self._plant.set_push(three_numbers(request["force"]))
        return {}

    def _support(self, request: Request) -> dict[str, Any]:
        self._plant.set_support(bool(request["supported"]))
        return {}

    def _quit(self, _: Request) -> dict[str, Any]:
        self._running = False
        return {}

    def stop(self) -> None:
        """End `serve`; may be called from a signal handler."""
        self._running = False

    def close(self) -> None:
        """Hang up all lines and remove the folder."""
        for line in self._lines.values():
            line.close()
        self._control.close()
        self._truth.close()
        shutil.rmtree(self._folder, ignore_errors=True)


def run_server(
    description: RobotDescription, rate_hz: int, seed: int, as_json: bool, watch_stdin: bool
) -> None:
    """Serve a virtual robot in this process until a signal; prints where its ports are."""
    server = VirtualRobotServer(description, rate_hz, seed)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: server.stop())
    try:
        ports = server.ports()
        if as_json:
            sys.stdout.write(json.dumps(ports) + "\n")
        else:
            lines = {**ports["buses"], **ports["boards"], "control": ports["control"]}
            sys.stdout.writelines(f"{name:12} {path}\n" for name, path in lines.items())
        sys.stdout.flush()
        server.serve(watch_stdin)
    finally:
        server.close()


def stdin_is_pipe() -> bool:
    """Whether somebody holds the other end of standard input, and can end us by closing it."""
    try:
        mode = os.fstat(0).st_mode
    except OSError:
        return False
    return stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode)


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line of the server; returns its exit code."""
    parser = argparse.ArgumentParser(prog="python -m sim_backends.virtual.server")
    parser.add_argument("robot", help="name of a robot or a description file")
    parser.add_argument("--rate", type=int, default=300, help="ticks a second [Hz]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true", help="print the ports as one JSON line")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args(arguments)
    try:
        description = load_robot(options.robot, tuple(options.set))
        run_server(description, options.rate, options.seed, options.json, stdin_is_pipe())
    except StrideError as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
