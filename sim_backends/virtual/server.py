"""The virtual robot as a process of its own, on pseudo-terminals and in real time.

`python -m sim_backends.virtual.server ROBOT --json` prints one line when it is ready,
`{"buses": {name: port}, "boards": {name: port}, "control": path}`, and serves until SIGTERM,
SIGINT, a `quit` on the control socket, or the end of a pipe that is its standard input.
"""

import argparse
import gc
import json
import os
import select
import shutil
import signal
import stat
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from hil.description import RobotDescription
from hil.errors import StrideError
from hil.fault_spec import FaultSpec, check_faults
from hil.miswire import Miswire
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.control import ControlServer, Request, three_numbers
from sim_backends.virtual.hand import Hand
from sim_backends.virtual.miswiring import built_wrongly, mount_wrongly, plug_wrongly
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.pty_line import PtyLine
from sim_backends.virtual.robot import VirtualRobot
from sim_backends.virtual.truth_block import TruthBlock

_SLIP_NS = 200_000_000
"""Lag behind real time that is given up instead of caught up [ns]: no walk survives it, but a
client that reads registers should not wait for seconds on a machine that is too slow."""
_WORK_NS = 300_000
"""Longest work between two looks at what clients sent [ns]."""


class VirtualRobotServer:
    """Paces a virtual robot by the monotonic clock and moves bytes to and from its terminals.

    Virtual time 0 is the moment of construction. What a client writes reaches the wire one USB
    transfer later at the earliest, so virtual time runs that far ahead of real time: physics,
    boards and answers are computed before they are due, piece by piece. Bytes for clients then
    wait in an outbox and leave when their modelled time has come, never before; how much later
    is up to the machine. On one that is too slow virtual time slips.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        seed: int,
        wrong: Sequence[Miswire] = (),
    ) -> None:
        self._start_ns = time.monotonic_ns()
        description = built_wrongly(description, wrong)
        plant = Plant(description, rate_hz, seed, nominal_motors(description))
        self._robot = VirtualRobot(description, plant, seed, rate_hz, host_now_ns=self._now_ns)
        self._plant = plant
        # Times of the journal are on the monotonic clock, which every process shares.
        self._journal = self._robot.journal(lambda: self._robot.clock.now_ns() + self._start_ns)
        self._folder = Path(tempfile.mkdtemp(prefix="stridebridge-"))
        self._truth = TruthBlock(self._folder / "truth", len(description.joints), create=True)
        handlers = {"hello": self._hello, "push": self._push, "support": self._support,
                    "ball": self._ball, "medium": self._set_medium,
                    "inject": self._inject, "plan": self._plan, "begin": self._begin,
                    "journal": self._tell_journal, "hand": Hand(self._robot).do,
                    "figures": self._figures, "quit": self._quit}  # fmt: skip
        self._control = ControlServer(self._folder / "control", handlers)
        self._lines = {name: PtyLine(device) for name, device in self._robot.devices.items()}
        self._places = dict(self._lines)
        plug_wrongly(self._places, wrong)
        mount_wrongly(self._robot, wrong)
        self._outbox: deque[tuple[int, PtyLine, bytes]] = deque()
        for name, line in self._lines.items():
            self._robot.ports[name].on_bytes = partial(self._post, line)
            self._robot.ports[name].on_unplug = line.hang_up
        self._ahead_ns = 1000 * description.timing.usb_transfer_us
        self._running = True
        self._publish()
        # A full collection of what start-up made takes 25 ms, in which no servo would answer.
        gc.collect()
        gc.freeze()

    def ports(self) -> dict[str, Any]:
        """What the ready line tells."""
        description = self._robot.description
        return {
            "buses": {name: self._places[name].path for name in description.buses},
            "boards": {name: self._places[name].path for name in description.boards},
            "control": str(self._folder / "control"),
        }

    def plan_faults(self, faults: Sequence[FaultSpec]) -> None:
        """What goes wrong; T = 0 is the beginning of `serve`."""
        self._robot.faults.plan(faults)

    def serve(self, watch_stdin: bool) -> None:
        """Run until told to stop. Raises BackendError when the simulation diverges."""
        self._start_ns = time.monotonic_ns() - self._robot.clock.now_ns()
        self._robot.faults.begin(self._robot.clock.now_ns())
        sources: dict[int, Callable[[int], None]] = {}
        with select.epoll() as poll:
            for line in self._lines.values():
                # A terminal without client is hung up all the time: only edges matter.
                poll.register(line, select.EPOLLIN | select.EPOLLET)
                sources[line.fileno()] = line.serve
            poll.register(self._control, select.EPOLLIN)
            sources[self._control.fileno()] = self._control.serve
            if watch_stdin:
                poll.register(sys.stdin, select.EPOLLIN)
                sources[sys.stdin.fileno()] = self._look_at_stdin
            while self._running:
                self._work()
                # epoll's own timeout has a grain of 1 ms.
                if select.select([poll], [], [], self._idle_s())[0]:
                    self._send_due()
                    for number, events in poll.poll(0):
                        sources[number](events)

    def _look_at_stdin(self, _: int) -> None:
        if not os.read(sys.stdin.fileno(), 4096):
            self._running = False

    def _now_ns(self) -> int:
        return time.monotonic_ns() - self._start_ns

    def _post(self, line: PtyLine, data: bytes) -> None:
        self._outbox.append((self._robot.clock.now_ns(), line, data))

    def _send_due(self) -> int:
        """Send what is due; the present time."""
        now_ns = self._now_ns()
        outbox = self._outbox
        while outbox and outbox[0][0] <= now_ns:
            _, line, data = outbox.popleft()
            line.send(data)
        return now_ns

    def _work(self) -> None:
        """Let virtual time run ahead for a while, and send what becomes due meanwhile.

        A request must not wait until a server that was held up has caught up with real time.
        """
        before = self._plant.substep_index
        began_ns = self._send_due()
        lag_ns = began_ns - self._robot.clock.now_ns()
        if lag_ns > _SLIP_NS:
            self._start_ns += lag_ns
            began_ns -= lag_ns
        while self._robot.clock.advance_once(began_ns + self._ahead_ns):
            if self._send_due() > began_ns + _WORK_NS:
                break
        if self._plant.substep_index != before:
            self._publish()

    def _idle_s(self) -> float:
        """Until something is due or can be computed [s]."""
        next_ns = self._robot.clock.next_ns() - self._ahead_ns
        if self._outbox:
            next_ns = min(next_ns, self._outbox[0][0])
        return max(0, next_ns - self._now_ns()) * 1e-9

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

    def _ball(self, request: Request) -> dict[str, Any]:
        mass = float(request["mass"])
        self._plant.throw_ball(mass, np.array(three_numbers(request["velocity"])))
        return {}

    def _set_medium(self, request: Request) -> dict[str, Any]:
        self._plant.set_medium(*three_numbers(request["medium"]))
        return {}

    def _inject(self, request: Request) -> dict[str, Any]:
        self._robot.inject(str(request["fault"]))
        return {}

    def _plan(self, request: Request) -> dict[str, Any]:
        self._robot.faults.plan([FaultSpec.model_validate(fault) for fault in request["faults"]])
        return {}

    def _begin(self, request: Request) -> dict[str, Any]:
        self._robot.faults.begin(int(request["time_ns"]) - self._start_ns)
        return {}

    def _support(self, request: Request) -> dict[str, Any]:
        self._plant.set_support(bool(request["supported"]))
        return {}

    def _figures(self, _: Request) -> dict[str, Any]:
        return {"figures": self._plant.figures()}

    def _tell_journal(self, request: Request) -> dict[str, Any]:
        return {**self._journal.content(packets=bool(request.get("packets", True)))}

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
    description: RobotDescription,
    rate_hz: int,
    seed: int,
    as_json: bool,
    watch_stdin: bool,
    faults: Sequence[FaultSpec] = (),
    wrong: Sequence[Miswire] = (),
) -> None:
    """Serve a virtual robot in this process until a signal; prints where its ports are.

    `wrong`: how it is put together otherwise than described. T = 0 of the faults is when it is
    ready. Raises InputError for one that it cannot have.
    """
    check_faults(faults, description)
    server = VirtualRobotServer(description, rate_hz, seed, wrong)
    server.plan_faults(faults)
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
