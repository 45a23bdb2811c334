"""The client's side of a virtual robot in another process: starting it, and its world."""

import json
import os
import select
import socket
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from hil.errors import BackendError, InputError
from hil.fault_spec import FaultSpec
from hil.interface import Floats, Truth
from sim_backends.virtual.truth_block import TruthBlock

START_TIMEOUT_S = 30.0
STOP_TIMEOUT_S = 3.0
ANSWER_TIMEOUT_S = 1.0


class VirtualPorts(Protocol):
    """Where a virtual robot in another process is."""

    port_urls: dict[str, str]
    """Terminals of all buses and boards."""
    control: Path
    """The control socket."""

    def close(self) -> None:
        """The client needs it no longer."""
        ...


class ServerProcess:
    """A virtual robot server of our own; it ends with us, since its standard input is our pipe."""

    def __init__(
        self, robot: str, rate_hz: int, seed: int, overrides: tuple[str, ...] = ()
    ) -> None:
        """Start it and wait until it is ready. Raises InputError or BackendError."""
        command = [sys.executable, "-m", "sim_backends.virtual.server", robot, "--json",
                   "--rate", str(rate_hz), "--seed", str(seed)]  # fmt: skip
        for override in overrides:
            command += ["--set", override]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        try:
            ready = json.loads(self._ready_line())
        except BaseException:
            self.close()
            raise
        self.port_urls: dict[str, str] = {**ready["buses"], **ready["boards"]}
        self.control = Path(ready["control"])

    def _ready_line(self) -> bytes:
        """The first line of its output. Raises what its death means."""
        process = self._process
        if process.stdout is None or process.stderr is None:
            raise BackendError("the virtual robot has no output to read")
        deadline = time.monotonic() + START_TIMEOUT_S
        line = b""
        while not line.endswith(b"\n"):
            remaining = max(0.0, deadline - time.monotonic())
            if not select.select([process.stdout], [], [], remaining)[0]:
                raise BackendError(f"the virtual robot was not ready in {START_TIMEOUT_S:.0f} s")
            part = os.read(process.stdout.fileno(), 65536)
            if not part:
                raise _death(process.wait(), process.stderr.read())
            line += part
        return line

    def close(self) -> None:
        """End it; safe to call twice."""
        process = self._process
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()
        try:
            process.wait(STOP_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _death(code: int, errors: bytes) -> InputError | BackendError:
    lines = errors.decode(errors="replace").strip().splitlines() or [f"exit code {code}"]
    if code == InputError.exit_code:
        return InputError(lines[-1])
    return BackendError(f"the virtual robot ended: {lines[-1]}")


class RemoteWorld:
    """World of a virtual robot in another process; implements `hil.interface.World`.

    Truth comes from shared memory, its times on the monotonic clock; the rest is asked for on
    the control socket.
    """

    def __init__(self, control: Path) -> None:
        """Connect to a control socket. Raises BackendError."""
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(ANSWER_TIMEOUT_S)
        self._push: tuple[float, ...] = (0.0, 0.0, 0.0)
        self._figures: dict[str, float | None] = {}
        self._closed = False
        try:
            self._socket.connect(str(control))
            self._answers = self._socket.makefile("rb")
            hello = self._ask({"do": "hello"})
        except (OSError, BackendError) as error:
            self._socket.close()
            raise BackendError(f"control socket {control}: {error}") from error
        self.calibration_data: dict[str, Any] = hello["calibration"]
        """As `VirtualRobot.calibration_data`."""
        self._truth = TruthBlock(Path(hello["truth"]), hello["joints"])

    def _ask(self, request: dict[str, Any]) -> dict[str, Any]:
        try:
            self._socket.sendall(json.dumps(request).encode() + b"\n")
            line = self._answers.readline()
        except OSError as error:
            raise BackendError(f"the virtual robot does not answer: {error}") from error
        if not line:
            raise BackendError("the virtual robot closed its control socket")
        answer: dict[str, Any] = json.loads(line)
        if not answer["ok"]:
            raise BackendError(f"the virtual robot refuses: {answer['error']}")
        return answer

    def truth(self) -> Truth:
        """State at the newest grid point; the object is reused."""
        return self._truth.read()

    def set_push(self, force: Floats) -> None:
        """Force at the centre of mass of the root body, world axes [N]; asks only for a new one."""
        push = tuple(float(value) for value in force)
        if push != self._push:
            self._ask({"do": "push", "force": push})
            self._push = push

    def throw_ball(self, mass: float, velocity: Floats) -> None:
        """Throw a ball at the trunk, to hit it at a world velocity [m/s]."""
        self._ask({"do": "ball", "mass": mass, "velocity": velocity.tolist()})

    def set_medium(self, level: float, density: float, viscosity: float) -> None:
        """A liquid up to a level above the floor [m], its density [kg/m³] and viscosity factor."""
        self._ask({"do": "medium", "medium": [level, density, viscosity]})

    def plan_faults(self, faults: Sequence[FaultSpec]) -> None:
        """What goes wrong in this run. Raises BackendError for what the robot cannot have."""
        self._ask({"do": "plan", "faults": [fault.model_dump() for fault in faults]})

    def inject(self, fault: str) -> None:
        """Have something go wrong, as `--fault` writes it; T counts from now."""
        self._ask({"do": "inject", "fault": fault})

    def begin_faults(self, epoch_ns: int) -> None:
        """T = 0 of the planned faults, on the monotonic clock."""
        self._ask({"do": "begin", "time_ns": epoch_ns})

    def set_support(self, supported: bool) -> None:
        """Hold the root body where it is, or let it go."""
        self._ask({"do": "support", "supported": supported})

    def journal(self, *, packets: bool = True) -> dict[str, list[list[Any]]]:
        """What its servos heard and did, as `Journal.content`, times on the monotonic clock."""
        answer = self._ask({"do": "journal", "packets": packets})
        return {ring: answer[ring] for ring in ("packets", "deeds")}

    def do_by_hand(self, request: dict[str, Any]) -> float:
        """Begin what `sim_backends.virtual.hand` understands; how long it takes [s]."""
        return float(self._ask(request)["seconds"])

    def figures(self) -> dict[str, float | None]:
        """As `Plant.figures`; once closed, as they were then."""
        if not self._closed:
            self._figures = self._ask({"do": "figures"})["figures"]
        return self._figures

    def close(self) -> None:
        """Disconnect; safe to call twice, and when the virtual robot is gone."""
        if self._closed:
            return
        with suppress(BackendError):
            self.figures()
        self._closed = True
        self._answers.close()
        self._socket.close()
        self._truth.close()
