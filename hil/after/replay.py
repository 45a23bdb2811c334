"""`stride twin`: the goals of a recorded run, at their times, through a virtual robot."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from hil.after.load_model import LoadModel
from hil.after.measured_motion import measured_motion
from hil.after.recorded import TWIN, RecordedRun, read_run
from hil.after.signs import require_registers
from hil.after.ticks import fill
from hil.compose import TwinParts, build_twin
from hil.cycle import SafetyStatus, TickRecord
from hil.errors import InputError
from hil.interface import Estimate, JointCommand, Reference, SensorFrame, WalkStatus
from hil.loop import Outcome
from hil.record_layout import blank_estimate
from hil.recording import Rows
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.run import Books
from hil.shutdown import stop_and_close
from hil.signals import StopSignals
from hil.timing import TickSchedule, TickTiming, stopwatch_ns

SURROUNDINGS = ("plant.hoist", "hoist", "plant.ball", "ball")
"""Changes of a run that its twin does not take over: its body is carried."""


class RecordedEstimator:
    """What the run believed of its body: a twin has nothing better to go by."""

    def __init__(self, joints: int) -> None:
        self.estimate = blank_estimate(joints)

    def update(self, frame: SensorFrame) -> Estimate:
        """The estimate of the present tick."""
        del frame
        return self.estimate


class RecordedController:
    """What the run's controller did."""

    def __init__(self, joints: int) -> None:
        self.status = WalkStatus()
        self.command = JointCommand.zeros(joints)

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of the present tick."""
        del estimate, reference
        return self.command


def twin_request(
    run: RecordedRun,
    robot: str | None,
    overrides: tuple[str, ...],
    seed: int | None,
    out: Path | None,
) -> RunRequest:
    """The run's own robot, seed and `--set` changes, with those of the command line after them.

    The twin of a real robot is the nominal one unless changes say otherwise: no seed drew it.
    """
    request = run.meta["request"]
    kept = [text for text in request["overrides"] if text.partition("=")[0] not in SURROUNDINGS]
    if run.meta["rung"] == "live":
        kept.insert(0, "plant.draws=null")
    return RunRequest.checked(
        robot=robot or request["robot"],
        backend="bus",
        rate_hz=run.rate_hz,
        duration_s=request["duration_s"],
        seed=run.meta["seed"] if seed is None else seed,
        overrides=(*(kept if robot is None else ()), *overrides),
        out=out,
    )


def replay(run: RecordedRun, request: RunRequest, *, progress: bool = True) -> Path:
    """Send a run's goals to a virtual robot; the run folder that was written.

    Every register is written in the tick in which the run wrote it, through the driver's own bus.
    Ticks that the run missed are passed over as it did: the last goals stand. Raises InputError
    for a recording without registers.
    """
    require_registers(run)
    rows = _armed(run)
    description = load_robot(request.robot, request.overrides)
    if list(description.joint_names) != run.joints:
        raise InputError(f"{description.file}: has other joints than the robot of {run.name}")
    motion = measured_motion(rows, run.rate_hz, LoadModel(description).mass)
    joints = len(run.joints)
    estimator, controller = RecordedEstimator(joints), RecordedController(joints)
    origin = {"name": run.name, "started": run.meta["started"]}
    meta = {"rung": TWIN, "twin_of": origin}
    parts = build_twin(request, description, motion, estimator, controller, meta)
    session = parts.session
    try:
        session.backend.open()
        books = Books(session, progress=progress)
    except BaseException:
        session.close()
        raise
    outcome, signals = Outcome(), StopSignals()
    try:
        with signals.caught():
            _Player(parts, rows, run.rate_hz, books).play(outcome, signals.check)
    except BaseException as error:
        error.add_note(f"recorded in {books.folder}")
        raise
    finally:
        with signals.shielded():
            stop_and_close(session)
        books.close(outcome)
    return books.folder


def replay_folder(folder: Path, robot: str | None = None) -> RecordedRun:
    """The run to replay, read with its own robot file or another one. Raises InputError."""
    if (folder / "samples.csv").is_file():
        raise InputError(
            f"{folder}: is a jog: one servo on a desk has no body to be carried with; jog one of "
            "`stride emulate` instead, and compare the steps"
        )
    run = read_run(folder, robot)
    if run.is_twin:
        raise InputError(f"{folder}: is a twin already: replay the run that it was made of")
    return run


def _armed(run: RecordedRun) -> Rows:
    """Ticks of which goals went out."""
    rows = run.recording.rows
    sent: Rows = rows[(rows["applied"]["p_gain"] > 0).any(axis=1)]
    if len(sent) < run.rate_hz:
        raise InputError(f"{run.name}: less than a second with torque on: nothing to replay")
    return sent


class _Player:
    """Plays recorded ticks on a virtual robot, tick by tick."""

    def __init__(self, parts: TwinParts, rows: Rows, rate_hz: int, books: Books) -> None:
        self._parts, self._rows, self._rate_hz = parts, rows, rate_hz
        self._sinks = books.sinks
        self._reference, self._safety = Reference(), SafetyStatus()
        self._timing = TickTiming()

    def play(self, outcome: Outcome, check: Callable[[], None]) -> None:
        """Arm at the first pose, then every tick; ends with torque on."""
        session, rows = self._parts.session, self._rows
        backend, began = session.backend, stopwatch_ns()
        backend.read()
        backend.arm()
        self._parts.begin(rows["frame"]["joint_position"][0])
        ticks = rows["timing"]["tick"]
        schedule = TickSchedule(backend.clock, self._rate_hz, int(ticks[0]))
        started_ns = backend.clock.now_ns()
        for row in rows:
            while schedule.next_tick < int(row["timing"]["tick"]):
                schedule.wait()
                backend.read()
                schedule.finish()
            self._tick(schedule, row)
            check()
        outcome.clock_ns = backend.clock.now_ns() - started_ns
        outcome.wall_ns = stopwatch_ns() - began

    def _tick(self, schedule: TickSchedule, row: Any) -> None:
        session, timing = self._parts.session, self._timing
        timing.tick = tick = schedule.wait()
        begun = stopwatch_ns()
        for target, topic in (
            (self._parts.applied, "applied"),
            (self._reference, "reference"),
            (self._safety, "safety"),
            (session.controller.status, "status"),
        ):
            fill(target, row[topic])
        frame = session.backend.read()
        estimate = session.estimator.update(frame)
        fill(estimate, row["estimate"])
        command = session.controller.step(estimate, self._reference)
        fill(command, row["command"])
        applied = session.backend.write(command)
        truth = session.world.truth() if session.world is not None else None
        timing.cycle_ns = stopwatch_ns() - begun
        record = TickRecord(
            schedule.time_ns(tick),
            tick / self._rate_hz,
            command,
            applied,
            frame,
            estimate,
            self._reference,
            session.controller.status,
            self._safety,
            truth,
            timing,
        )
        for sink in self._sinks:
            sink.put(record)
        schedule.finish()
