"""The fault matrix of processes: real signals and real ends around a walk on pseudo-terminals.

Emulated servos, real processes: each row ends, stops or robs a `stride walk --realtime` (or a
process beside it) at a drawn moment, and asks the emulator's journal what the servos did.
`fault_matrix.py` holds the rows of buses, servos, boards and commands.

Run: `python benchmarks/process_matrix.py --repeats 10` (some 20 min on a quiet machine). Exit
code 1 if a promise was broken. `--light` takes coarse physics, for a busy machine.
"""

import argparse
import json
import os
import resource
import signal
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from live_walk import LIGHT, NOMINAL, SIT_S, STAND_UP_S, LiveWalk, Reaction

from drivers.dynamixel.port import Port
from hil.errors import PortError

WALK_S = 3.0
ATTEMPTS = 5
"""Of one measurement: a busy machine makes walks stop by themselves."""
SAT_S, OFF_AT_ONCE_S = SIT_S + 0.1, 0.01
SLEEP_S = 0.5
"""A program is suspended for so long: the watchdogs trip, the guardian does not act yet."""
DISK_BYTES = 200_000
"""The recorder's file may not grow beyond."""


@dataclass(frozen=True)
class Found:
    """What one repetition showed."""

    reaction: Reaction
    code: int
    faults: tuple[str, ...]
    """`source, name, reaction` of the report's faults; none of a run that was killed."""
    complaint: str
    """The last line on standard error."""


@dataclass(frozen=True)
class Row:
    """One fault, and what is promised."""

    name: str
    do: Callable[[LiveWalk], None]
    code: int | None
    """Exit code of the program; None: whatever it is."""
    fault: str
    """Part of a fault in its report; empty for none."""
    off_s: float | None
    """All torque off so soon; None: at the end of the walk, as without the fault."""
    stopped_s: float | None = None
    """All servos stopped so soon, where that is promised apart."""
    buses: int = 2
    """How many buses can still be told anything."""


def _send(number: int) -> Callable[[LiveWalk], None]:
    return lambda walk: os.kill(walk.process.pid, number)


def _type(key: bytes) -> Callable[[LiveWalk], None]:
    def do(walk: LiveWalk) -> None:
        os.write(walk.terminal, key)

    return do


def _suspend(walk: LiveWalk) -> None:
    os.kill(walk.process.pid, signal.SIGSTOP)
    time.sleep(SLEEP_S)
    os.kill(walk.process.pid, signal.SIGCONT)


def _kill_child(marks: str) -> Callable[[LiveWalk], None]:
    """Kill the walk's child whose command line holds a word."""

    def do(walk: LiveWalk) -> None:
        os.kill(child(walk.process.pid, marks), signal.SIGKILL)

    return do


def _fill_disk(walk: LiveWalk) -> None:
    recorder = child(walk.process.pid, "recorder_process")
    resource.prlimit(recorder, resource.RLIMIT_FSIZE, (DISK_BYTES, DISK_BYTES))


def _open_twice(walk: LiveWalk) -> None:
    try:
        Port("second", walk.server.port_urls["left_leg"], 4_000_000).close()
    except PortError:
        return
    # The walk may have ended by itself and let go: that repetition does not count. If it has not,
    # none of them does, and the row is not kept.
    raise OSError("a second process could open a bus that is in use")


def _pull_out(walk: LiveWalk) -> None:
    walk.inject("bus:left_leg:disconnect@0")


ROWS = (
    Row("SIGKILL", _send(signal.SIGKILL), -9, "", 0.1, 0.06),
    Row("segmentation fault", _send(signal.SIGSEGV), -11, "", 0.1, 0.06),
    Row("suspended for 0.5 s, then goes on", _suspend, 1, "program, paused",
        SLEEP_S + SAT_S, 0.06),
    Row("suspended for good", _send(signal.SIGSTOP), -9, "", 2.4, 0.06),
    Row("SIGTERM", _send(signal.SIGTERM), 143, "operator, SIGTERM", SAT_S),
    Row("Ctrl-C", _type(b"\x03"), 130, "operator, SIGINT", SAT_S),
    Row("Ctrl-Z", _type(b"\x1a"), 148, "operator, SIGTSTP", SAT_S),
    Row("terminal closed (SIGHUP)", LiveWalk.close_terminal, 129, "operator, SIGHUP", SAT_S),
    Row("key q", _type(b"q"), 1, "operator, key q", SAT_S),
    Row("space", _type(b" "), 1, "operator, key space", OFF_AT_ONCE_S),
    Row("Ctrl-\\", _type(b"\x1c"), 131, "operator, SIGQUIT", OFF_AT_ONCE_S),
    Row("guardian killed", _kill_child("live_walk"), 1, "program, guardian lost", SAT_S),
    Row("recorder killed", _kill_child("recorder_process"), 0, "recorder, ", None),
    Row("disk full", _fill_disk, 0, "recorder, ", None),
    Row("a second process opens a bus", _open_twice, 0, "", None),
    Row("one adapter pulled out", _pull_out, 1, "program, BackendError", 0.05, buses=1),
)  # fmt: skip


def child(parent: int, marks: str) -> int:
    """Process id of a child whose command line holds a word. Raises LookupError."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            above = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            words = (folder / "cmdline").read_bytes().decode(errors="replace")
        except OSError:
            continue  # it has ended meanwhile
        if above == parent and marks in words:
            return int(folder.name)
    raise LookupError(f"no child of {parent} is a {marks}")


def measure(row: Row, after_s: float, rate_hz: int, overrides: Sequence[str]) -> Found | None:
    """One repetition, some time after torque on; None if something else had ended the walk."""
    words = ("--speed", "0.1", "--duration", str(WALK_S))
    with LiveWalk(rate_hz, words, overrides) as walk:
        try:
            on_ns = walk.torque_on_ns()
            time.sleep(max(0.0, (on_ns - time.monotonic_ns()) * 1e-9 + after_s))
            began_ns = time.monotonic_ns()
            row.do(walk)
        except (OSError, TimeoutError, LookupError):
            return None
        reaction = walk.reaction(began_ns, row.buses)
        if not reaction.joints:
            return None
        code, faults = walk.code(), _faults(walk.folder)
        ends = [fault for fault in faults if not fault.endswith(", none")]
        # A stop at once is the same whatever came before; sitting down must have begun with it.
        sits = row.off_s is not None and row.off_s > OFF_AT_ONCE_S
        if sits and row.fault and ends and row.fault not in ends[0]:
            return None
        return Found(reaction, code, faults, walk.complaint())


def _faults(folder: Path) -> tuple[str, ...]:
    try:
        report = json.loads((folder / "report.json").read_text())
    except FileNotFoundError:
        return ()
    return tuple(f"{f['source']}, {f['name']}, {f['reaction']}" for f in report["faults"])


def kept(row: Row, found: Found) -> bool:
    """Whether the program ended as it should; times are judged apart."""
    told = not row.fault or any(row.fault in fault for fault in found.faults)
    return told and row.code in (None, found.code)


def in_time(row: Row, found: Found) -> bool:
    """Whether the servos did what is promised when it is promised."""
    if row.off_s is None:
        return found.reaction.off_s == found.reaction.off_s
    stopped = row.stopped_s is None or found.reaction.stopped_s <= row.stopped_s
    return stopped and found.reaction.off_s <= row.off_s


def repeat(
    row: Row, repeats: int, random: Random, rate_hz: int, overrides: Sequence[str]
) -> list[Found]:
    """So many repetitions, at moments of standing up and walking."""
    found: list[Found] = []
    for _ in range(ATTEMPTS * repeats):
        if len(found) == repeats:
            break
        one = measure(row, random.uniform(0.1, STAND_UP_S + 1.0), rate_hz, overrides)
        if one is not None:
            found.append(one)
    return found


def main() -> int:
    """Print the table of docs/safety.md; the exit code."""
    parser = argparse.ArgumentParser(prog="python benchmarks/process_matrix.py")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--rate", type=int, default=150, help="ticks a second [Hz]")
    parser.add_argument("--seed", type=int, default=0, help="draws the moments")
    parser.add_argument("--light", action="store_true", help="coarse physics")
    parser.add_argument("--only", default="", help="rows whose name holds this word")
    options = parser.parse_args()
    random, broken = Random(options.seed), 0
    print("| fault | promised | exit code | stopped, most | torque off, most | kept |")
    print("|---|---|---|---|---|---|")
    for row in (row for row in ROWS if options.only in row.name):
        overrides = LIGHT if options.light else NOMINAL
        found = repeat(row, options.repeats, random, options.rate, overrides)
        good = sum(kept(row, one) and in_time(row, one) for one in found)
        broken += options.repeats - good
        promised = "goes on" if row.off_s is None else f"off within {row.off_s:g} s"
        if row.stopped_s is not None:
            promised = f"stopped within {row.stopped_s:g} s, {promised}"
        codes = ", ".join(str(code) for code in sorted({one.code for one in found}))
        most = [max((one.reaction.stopped_s for one in found), default=float("nan")),
                max((one.reaction.off_s for one in found), default=float("nan"))]  # fmt: skip
        cells = ["at its end" if row.off_s is None else f"{1000 * value:.0f} ms" for value in most]
        print(f"| {row.name} | {promised} | {codes} | {' | '.join(cells)} | "
              f"{good} of {len(found)} |", flush=True)  # fmt: skip
        for one in (one for one in found if not (kept(row, one) and in_time(row, one))):
            sys.stderr.write(f"  {row.name}: {one}\n")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
