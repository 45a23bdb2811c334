"""One run from a session to its folder: recording, report and picture."""

import sys
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hil.bringup.ladder import note_hoisted_walk
from hil.cycle import Sink
from hil.errors import StrideError
from hil.figures import draw_run
from hil.figures_jump_run import draw_jump_run
from hil.loop import Loop, Outcome
from hil.recorder import Recorder
from hil.report import make_report, rounded
from hil.run_folder import make_meta, make_run_folder, write_json
from hil.safety.severity import Fault
from hil.session import Session
from hil.stop_listener import StopListener
from hil.trace import Trace, TraceSink
from hil.view.attendance import Attendance, attend


@dataclass(frozen=True, slots=True)
class RunResult:
    """What a run left behind."""

    folder: Path
    report: dict[str, Any]


def run(session: Session, *, progress: bool = True) -> RunResult:
    """Run a session and write its folder.

    The backend is opened first: a port that does not exist leaves no folder behind. Whatever the
    loop raises is raised again, after the robot is safe and the folder is complete. The session is
    closed whatever happens.
    """
    attendance = Attendance()
    try:
        attendance = attend(session)
        session.backend.open()
        if session.request.live:  # a virtual robot is new in every run: there it is no news
            sys.stderr.writelines(f"stride: {change}\n" for change in session.backend.changes)
        books = Books(session, progress=progress)
        loop = Loop(
            session,
            books.sinks + attendance.sinks(books.last_row),
            listener=StopListener(books.folder, attendance.steering),
            helm=attendance.helm,
            pacer=attendance.pacer,
        )
        attendance.follow(loop, session)
    except BaseException:
        attendance.close()
        session.close()
        raise
    try:
        with closing(attendance):
            loop.run()
    except BaseException as error:
        error.add_note(f"recorded in {books.folder}")
        books.close(loop.outcome)
        raise
    report = books.close(loop.outcome)
    told = note_hoisted_walk(session, books.folder, report)
    if told is not None:
        sys.stderr.write(f"stride: {told}\n")
    return RunResult(books.folder, report)


def session_report(
    session: Session, outcome: Outcome, trace: Trace, weight_n: float
) -> dict[str, Any]:
    """The report of a session that is closed, or has nothing more to say."""
    report = make_report(
        session.request,
        session.description.name,
        outcome,
        trace,
        weight_n,
        _statistics(session),
        truth=session.world is not None,
    )
    if session.jump is not None:
        report |= rounded(session.jump.figures(trace, outcome.fell))
    return report


def _statistics(session: Session) -> dict[str, float | None]:
    """The backend's statistics, with the session's figures where it has none."""
    known = session.backend.statistics()
    more = session.figures()
    return known | {key: value for key, value in more.items() if known.get(key) is None}


class Books:
    """The folder of one run, and what is written into it while and after it runs."""

    def __init__(self, session: Session, *, progress: bool) -> None:
        request, description = session.request, session.description
        self._session = session
        self.folder = make_run_folder(request.out, description.name)
        self._meta = make_meta(session)
        write_json(self.folder / "meta.json", self._meta)
        rate_hz = request.rate_hz or description.defaults.rate_hz
        self._trace = TraceSink(len(description.joints), round(request.duration_s * rate_hz))
        truth = session.world is not None
        self._recorder = Recorder(self.folder, self._meta, truth=truth, progress=progress)
        self.sinks: tuple[Sink, ...] = (self._trace, self._recorder)
        self.last_row = self._recorder.last_row

    def close(self, outcome: Outcome) -> dict[str, Any]:
        """Finish the recording, write report and picture; the report."""
        self._close_recorder(outcome)
        session, trace = self._session, self._trace.trace()
        report = session_report(session, outcome, trace, self._meta["weight_n"])
        write_json(self.folder / "report.json", report)
        if session.request.report is not None:
            write_json(session.request.report, report)
        if len(trace) > 1:
            self._draw(trace)
        return report

    def _draw(self, trace: Trace) -> None:
        description, jump = self._session.description, self._session.jump
        picture = self.folder / "picture.png"
        jumped = None if jump is None else jump.of(trace)
        if jump is None or jumped is None or len(jumped) < 2:
            draw_run(trace, description, self._meta, picture)
        else:
            draw_jump_run(jumped, description, self._meta, jump, picture)

    def _close_recorder(self, outcome: Outcome) -> None:
        """A recording that failed is a fault of the run; it does not hide how the run ended."""
        problems = []
        try:
            self._recorder.close()
        except StrideError as error:
            problems.append(str(error))
        if self._recorder.dropped:
            problems.append(f"{self._recorder.dropped} ticks not recorded")
        end_s = outcome.clock_ns * 1e-9
        outcome.faults += [Fault(end_s, "recorder", problem, "none") for problem in problems]
