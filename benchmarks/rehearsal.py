"""The rungs of a robot, one after the other: each is the `stride` command that a builder types.

    python benchmarks/rehearsal.py [--keep FOLDER]
    python benchmarks/rehearsal.py --live [--rate 100] [--attempts 3] [--priority 20]

Dry runs in lockstep: stands in the gantry, stands on the floor, steps in the air, walks, sits. With
`--live` the same against emulated robots in real time, with the real driver and real bytes on
pseudo-terminals: set up, limp, refused on the ground, stands, steps in the air, walks, sits. The
gantry is another emulator of the same robot, and the hand that lowers it a thread of this script.
On a machine that cannot keep time the servos' bus watchdog stops a rung, as it should: it is tried
again. Exit code 0: every rung did what it should.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from rich.markup import escape

from drivers.calibration import RobotCalibration, save_calibration
from hil.cli.table import print_rows
from hil.errors import BackendError
from hil.report_words import number
from hil.robot_files import find_robot_file, load_robot
from sim_backends.virtual.remote import RemoteWorld

STRIDE = [sys.executable, "-c", "from hil.cli.main import main; main()"]
SEED = 0
STANDS_S = 6.0
"""So long after its run began a robot stands: it listens, is armed, holds, and ramps."""
MOVED_RAD = 0.03
LOOK_EVERY_S = 0.02


@dataclass(frozen=True, slots=True)
class Stage:
    """Where a rehearsal takes place."""

    folder: Path
    rate: int
    priority: int | None
    """SCHED_FIFO priority of loop and emulator, for a busy machine that allows it."""
    attempts: int
    """How often a rung may be tried."""


@dataclass(frozen=True, slots=True)
class Rung:
    """One command, and how it should end."""

    name: str
    command: tuple[str, ...]
    exit_code: int = 0
    told: str = ""
    """A part of what it says last on standard error."""
    hand: Callable[[RemoteWorld, Path], None] | None = None
    """What somebody beside the robot does."""


@dataclass(frozen=True, slots=True)
class Climbed:
    """How a rung ended."""

    rung: Rung
    attempt: int
    exit_code: int
    last_line: str
    report: dict[str, Any]

    @property
    def passed(self) -> bool:
        """Whether it ended as it should."""
        return self.exit_code == self.rung.exit_code and self.rung.told in self.last_line


def stages(robot: Path, seconds: float) -> list[tuple[bool, list[Rung]]]:
    """The ladder with its refusal, by whether the robot hangs."""
    walk = ("walk", str(robot), "--live", "--yes")
    time_s = f"{seconds:g}"
    gantry = [
        Rung("set up", ("setup", str(robot), "--yes")),
        Rung("limp", ("check", str(robot))),
        Rung("ground, too early", (*walk, "--duration", time_s), 2, "none is on record"),
        Rung("stand", ("stand", str(robot), "--live", "--yes", "--duration", "3")),
        Rung("hoisted", (*walk, "--hoisted", "--duration", time_s), told="passed"),
    ]
    ground = Rung("ground", (*walk, "--duration", time_s), hand=lower_when_standing)
    sit = Rung("sit", ("sit", str(robot), "--live", "--yes"), hand=let_go_when_moving)
    return [(True, gantry), (False, [ground]), (False, [sit])]


def dry_rungs(seconds: float) -> list[Rung]:
    """The ladder without a robot."""
    time_s = ("--duration", f"{seconds:g}")
    return [
        Rung("stand, hung up", ("stand", "--set", "hoist=true", "--duration", "3")),
        Rung("stand", ("stand", "--duration", "3")),
        Rung("hoisted", ("walk", "--hoisted", *time_s)),
        Rung("ground", ("walk", *time_s)),
        Rung("sit", ("sit",)),
    ]


def lend_hand(rung: Rung, world: RemoteWorld, run: Path) -> None:
    """What the hand of a rung does, until the emulator is gone."""
    if rung.hand is not None:
        with suppress(BackendError):
            rung.hand(world, run)


def lower_when_standing(world: RemoteWorld, run: Path) -> None:
    """Let go of a robot once a run has it in its standing pose."""
    _wait(lambda: (run / "meta.json").exists())
    time.sleep(STANDS_S)
    world.set_support(False)


def let_go_when_moving(world: RemoteWorld, run: Path) -> None:
    """Let go of a robot that a run has begun to sit down."""
    _wait(lambda: (run / "meta.json").exists())
    found = world.truth().joint_position.copy()
    _wait(lambda: bool(np.abs(world.truth().joint_position - found).max() > MOVED_RAD))
    world.set_support(False)


def _wait(reached: Callable[[], bool]) -> None:
    while not reached():
        time.sleep(LOOK_EVERY_S)


@contextmanager
def emulator(stage: Stage, *, hangs: bool) -> Iterator[RemoteWorld]:
    """`stride emulate` on the floor or in the gantry; its ports are in `ports.json`."""
    command = [*STRIDE, "emulate", "--json", "--rate", str(stage.rate), "--seed", str(SEED)]
    command += ["--set", "hoist=true"] if hangs else []
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        line = process.stdout.readline() if process.stdout else b""
        (stage.folder / "ports.json").write_bytes(line)
        if stage.priority is not None:
            os.sched_setscheduler(process.pid, os.SCHED_FIFO, os.sched_param(stage.priority))
        world = RemoteWorld(Path(json.loads(line)["control"]))
        world.set_support(True)
        try:
            yield world
        finally:
            world.close()
    finally:
        process.terminate()
        process.wait()


def make_robot(folder: Path, world: RemoteWorld) -> Path:
    """A robot file of one's own beside its model and calibration."""
    shipped = find_robot_file("minibiped")
    for file in (shipped, load_robot("minibiped").model_path):
        (folder / file.name).write_bytes(file.read_bytes())
    robot = folder / shipped.name
    # A busy machine answers late: the driver waits for answers as for a slower adapter's.
    text = robot.read_text(encoding="utf-8").replace("latency_timer_ms: 1", "latency_timer_ms: 4")
    robot.write_text(f"{text}\ncalibration: calibration.yaml\n", encoding="utf-8")
    provenance = {"date": datetime.now(UTC).date(), "method": "the emulator's own values"}
    content = {"robot": "minibiped", "provenance": provenance, **world.calibration_data}
    save_calibration(RobotCalibration.model_validate(content), folder / "calibration.yaml")
    return robot


def climb(rung: Rung, stage: Stage, world: RemoteWorld | None, attempt: int) -> Climbed:
    """Run a rung's command; what is around the robot does its part."""
    folder = stage.folder
    name = rung.name if attempt == 1 else f"{rung.name}, attempt {attempt}"
    report = folder / f"{name}.json"
    command = [*STRIDE, *rung.command]
    command += ["--ports", str(folder / "ports.json")] if world is not None else []
    command += ["--rate", str(stage.rate)] if rung.command[0] != "setup" else []
    if rung.command[0] in ("walk", "stand", "sit"):
        command += ["--out", str(folder / name)]
        command += ["--report", str(report)]
        command += ["--priority", str(stage.priority)] if stage.priority is not None else []
    if world is not None:
        threading.Thread(target=lend_hand, args=(rung, world, folder / name), daemon=True).start()
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    (folder / f"{name}.txt").write_text(result.stdout + result.stderr, encoding="utf-8")
    lines = [line for line in result.stderr.splitlines() if line.startswith("stride:")]
    content = json.loads(report.read_text()) if report.exists() else {}
    return Climbed(rung, attempt, result.returncode, lines[-1] if lines else "", content)


def rehearse_dry(stage: Stage, seconds: float, tell: Callable[[Climbed], None]) -> bool:
    """Every rung in lockstep; whether all ended as they should."""
    passed = True
    for rung in dry_rungs(seconds):
        climbed = climb(rung, stage, None, 1)
        tell(climbed)
        passed &= climbed.passed
    return passed


def rehearse_live(stage: Stage, seconds: float, tell: Callable[[Climbed], None]) -> bool:
    """Every rung on emulators, until one does not end as it should."""
    with emulator(stage, hangs=True) as world:
        robot = make_robot(stage.folder, world)
    for hangs, ladder in stages(robot, seconds):
        with ExitStack() as around:
            world = around.enter_context(emulator(stage, hangs=hangs))
            for rung in ladder:
                for attempt in range(1, stage.attempts + 1):
                    if attempt > 1 and rung.hand is not None:  # it lies on the floor
                        around.close()
                        world = around.enter_context(emulator(stage, hangs=hangs))
                    climbed = climb(rung, stage, world, attempt)
                    if climbed.passed:
                        break
                tell(climbed)
                if not climbed.passed:
                    return False
    return True


HEADS = ("", "", "attempt", "exit code", "time [s]", "steps", "speed [m/s]", "")


def _row(climbed: Climbed) -> tuple[str, ...]:
    report, command = climbed.report, climbed.rung.command
    faults = ", ".join(f"{fault['source']}: {fault['name']}" for fault in report.get("faults", []))
    walks, hoisted = command[0] == "walk" and bool(report), "--hoisted" in command
    return (
        climbed.rung.name,
        command[0],
        str(climbed.attempt),
        str(climbed.exit_code),
        number(report["duration_s"]) if report else "",
        str(report["steps"]) if walks else "",
        number(report["mean_speed_mps"]) if walks and not hoisted else "",
        faults or climbed.last_line.removeprefix("stride: "),
    )


def main() -> int:
    """Rehearse, and print what each rung did."""
    parser = argparse.ArgumentParser(description="The rungs against an emulated robot.")
    parser.add_argument("--live", action="store_true", help="in real time, on emulators")
    parser.add_argument("--rate", type=int, help="control rate [Hz]; 300, with --live 100")
    parser.add_argument("--seconds", type=float, default=10.0, help="walking time of a rung")
    parser.add_argument("--attempts", type=int, default=3, help="of a rung")
    parser.add_argument("--priority", type=int, help="SCHED_FIFO priority, on a busy machine")
    parser.add_argument("--keep", type=Path, help="keep run folders and pictures here")
    options = parser.parse_args()
    rows: list[tuple[str, ...]] = []

    def tell(climbed: Climbed) -> None:
        rows.append(_row(climbed))
        sys.stderr.write(f"{climbed.rung.name}: exit code {climbed.exit_code}\n")

    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        rate = options.rate or (100 if options.live else 300)
        stage = Stage(folder, rate, options.priority, options.attempts)
        rehearse = rehearse_live if options.live else rehearse_dry
        passed = rehearse(stage, options.seconds, tell)
    print_rows("Rehearsal", [escape(head) for head in HEADS], rows)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
