"""A real-time walk in a process of its own, on an emulator of its own that keeps a journal.

The emulator belongs to whoever measures, not to the walk: it lives on when the walk is killed, and
tells what its servos heard and did. `python benchmarks/live_walk.py PORTS WORDS…` is the walk: the
whole of `stride walk --realtime WORDS…`, but for the robot, which is there already.
"""

import fcntl
import json
import os
import pty
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from hil.robot_files import load_robot
from hil.stop_listener import ask_to_stop
from sim_backends.virtual.remote import RemoteWorld, ServerProcess

ROBOT = "minibiped"
NOMINAL = ("plant.draws=null",)
LIGHT = (*NOMINAL, "plant.substeps=3")
"""Coarse physics, for a machine that cannot keep up with real time: enough to stop a robot in."""
STAND_UP_S, SIT_S = 1.5, 1.1
"""From torque on to T = 0, and from the end of the walk to torque off."""
START_TIMEOUT_S, END_TIMEOUT_S = 90.0, 60.0
POLL_S = 0.01

Deed = tuple[int, str, str]
"""Time on the monotonic clock [ns], joint, `torque on`, `torque off` or `stopped`."""


@dataclass(frozen=True)
class Reaction:
    """What the servos with torque on did after a moment; NaN for what never came [s]."""

    frame_s: float
    """The first torque-off frame of the slowest bus."""
    stopped_s: float
    """The last servo stopped: by its watchdog, or since its torque went off."""
    off_s: float
    """The last torque went off."""
    joints: int
    """How many had torque on at the moment."""


def reaction(deeds: Sequence[Deed], buses: Sequence[Sequence[str]], since_ns: int) -> Reaction:
    """From the journal's deeds; `buses` are the names of the joints of each."""
    last = {joint: what for time_ns, joint, what in deeds if time_ns < since_ns}
    on = [joint for joint, what in last.items() if what != "torque off"]
    after = [deed for deed in deeds if deed[0] >= since_ns]

    def first(joint: str, *kinds: str) -> float:
        times = (time_ns for time_ns, name, what in after if name == joint and what in kinds)
        return (next(times, None) or float("nan")) - since_ns

    off = {joint: first(joint, "torque off") for joint in on}
    frames = [min((off[joint] for joint in bus if joint in off), default=0) for bus in buses]
    stops = [
        0.0 if last[joint] == "stopped" else first(joint, "torque off", "stopped") for joint in on
    ]
    return Reaction(_last_s(frames), _last_s(stops), _last_s(list(off.values())), len(on))


def _last_s(times_ns: Sequence[float]) -> float:
    """The last of some times; NaN if one never came."""
    return float("nan") if any(t != t for t in times_ns) else max(times_ns, default=0) * 1e-9


class LiveWalk:
    """Emulator and walk, the walk on a terminal of its own; a context manager that ends both."""

    def __init__(
        self,
        rate_hz: int,
        words: Sequence[str] = (),
        overrides: Sequence[str] = NOMINAL,
        folder: Path | None = None,
    ) -> None:
        """`words`: more of the command line. `folder`: the run folder; none is thrown away."""
        self._scrap = tempfile.TemporaryDirectory(prefix="live-walk-")
        self.folder = folder or Path(self._scrap.name) / "run"
        self.server = ServerProcess(ROBOT, rate_hz, 0, tuple(overrides))
        self.world = RemoteWorld(self.server.control)
        self.buses = _joints_by_bus()
        ports = {"urls": self.server.port_urls, "control": str(self.server.control)}
        sets = [word for override in overrides for word in ("--set", override)]
        self.terminal, keyboard = pty.openpty()
        """The other end of the walk's terminal: what is written here are its keys."""
        self.process = subprocess.Popen(
            [sys.executable, __file__, json.dumps(ports), "--rate", str(rate_hz),
             "--out", str(self.folder), *sets, *words],
            stdin=keyboard, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            start_new_session=True,
        )  # fmt: skip
        os.close(keyboard)

    def deeds(self) -> list[Deed]:
        """What servos did about torque so far."""
        found = self.world.journal(packets=False)["deeds"]
        return [(time_ns, joint, what) for time_ns, joint, what in found]

    def torque_on_ns(self) -> int:
        """Wait until the last servo's torque is on; when that was. Raises TimeoutError."""
        deadline = time.monotonic() + START_TIMEOUT_S
        joints: dict[str, int] = {}
        while len(joints) < sum(map(len, self.buses)):
            joints = {joint: time_ns for time_ns, joint, what in self.deeds() if "on" in what}
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise TimeoutError(f"the walk never began: {self.complaint()}")
            time.sleep(POLL_S)
        return max(joints.values())

    def say(self, word: str) -> None:
        """A word on the socket of the walk's folder."""
        ask_to_stop(self.folder, word)

    def inject(self, fault: str) -> None:
        """A fault of the emulator, now, as `--fault` writes it."""
        self.world.inject(fault)

    def close_terminal(self) -> None:
        """Close the window in which it runs: the kernel sends SIGHUP."""
        os.close(self.terminal)
        self.terminal = -1

    def reaction(self, since_ns: int, buses: int | None = None) -> Reaction:
        """What the servos did after a moment, once all is over; `buses`: of the last ones only."""
        heard = self.buses if buses is None else self.buses[-buses:]
        names = {joint for bus in heard for joint in bus}
        deeds = [deed for deed in self.until_off(names) if deed[1] in names]
        return reaction(deeds, heard, since_ns)

    def until_off(self, joints: Collection[str]) -> list[Deed]:
        """Wait until the torque of some joints is off, or nothing more can come; all deeds."""
        deadline = time.monotonic() + END_TIMEOUT_S
        while True:
            deeds = self.deeds()
            last = {joint: what for _, joint, what in deeds if joint in joints}
            if set(last.values()) == {"torque off"} or time.monotonic() > deadline:
                return deeds
            time.sleep(POLL_S)

    def code(self) -> int:
        """The walk's exit code, once it has ended."""
        return self.process.wait(END_TIMEOUT_S)

    def complaint(self) -> str:
        """The last line that the walk wrote, once it has ended."""
        stream = self.process.stderr
        text = stream.read() if stream is not None else b""
        return (text.decode(errors="replace").strip().splitlines() or [""])[-1]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.process.kill()
        self.process.communicate()
        with suppress(OSError):
            os.close(self.terminal)
        self.world.close()
        self.server.close()
        self._scrap.cleanup()


def _joints_by_bus() -> list[list[str]]:
    description = load_robot(ROBOT)
    joints = description.joints
    return [[joint.name for joint in joints if joint.bus == bus] for bus in description.buses]


class _Found:
    """The robot that is there: `hil.compose` is given it instead of one of its own."""

    def __init__(self, ports: dict[str, Any]) -> None:
        self.port_urls: dict[str, str] = ports["urls"]
        self.control = Path(ports["control"])

    def close(self) -> None:
        """It belongs to somebody else."""


def walk(ports: dict[str, Any], words: list[str]) -> None:
    """`stride walk --realtime` on the robot that is there."""
    import hil.compose
    from hil.cli.main import app
    from hil.compose.sessions import on_virtual_robot
    from hil.request import RunRequest
    from hil.session import Session

    def build(request: RunRequest) -> Session:
        description = load_robot(request.robot, request.overrides)
        resolved = request.resolved(description)
        fitted = description.at_rate(resolved.rate_hz or 0)
        return on_virtual_robot(resolved, fitted, _Found(ports))

    hil.compose.build = build
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # a session's leader, as a shell's child in a window is
    app(["walk", ROBOT, "--realtime", *words])


if __name__ == "__main__":
    walk(json.loads(sys.argv[1]), sys.argv[2:])
