"""`stride replay`: the controller again, on the frames of a recorded run."""

import json
import sys
from contextlib import closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Exit, Option

from hil.cli import options

if TYPE_CHECKING:
    from hil.after.rerun import Rerun
    from hil.recording import Recording
    from hil.request import ViewName

EPILOG = """[bold]Examples[/bold]

stride replay runs/20260101-120000-minibiped      is today's controller still the same?

stride replay runs/live1 --set walking.swing.height=0.04    what would it have said?

stride replay runs/live1 --view web --slower 4    see it again (docs/view.md)
"""
SHOWN = 20


def replay(
    run: Annotated[Path, Argument(metavar="RUN", help="A run folder.")],
    overrides: options.Overrides = None,
    tolerance: Annotated[
        float, Option(min=0.0, help="Do not tell smaller differences, in SI units.")
    ] = 0.0,
    as_json: Annotated[bool, Option("--json", help="Print every difference as JSON.")] = False,
    view: options.View = None,
    slower: Annotated[
        float, Option(min=0.1, max=100.0, help="With --view: how many times slower.")
    ] = 1.0,
    begin: Annotated[
        float | None,
        Option("--from", help="With --view: time of the run [s].", show_default="its start"),
    ] = None,
    times: Annotated[
        int | None,
        Option(min=1, help="With --view: how often it is shown.", show_default="until Ctrl-C"),
    ] = None,
) -> None:
    """Run the controller again on the recorded frames, and report every difference.

    Estimator and controller begin anew and hear, tick by tick, what the run heard; what they say is
    compared with what was recorded, to the last bit. No robot and no simulation takes part. With
    --set it is the answer to "what would it have said": the recorded frames stay.
    Exit code 0: identical; 1: differences; 2: bad input.

    With --view the recording is shown instead, at its own pace, until Ctrl-C.
    """
    if view is not None:
        _show(run, view, slower, begin, times)
        return
    from hil.after.rerun import rerun, rerun_parts
    from hil.recording import read_recording

    recording = read_recording(run)
    parts = rerun_parts(recording, run.name, tuple(overrides or ()))
    for file in changed_files(recording.meta):
        sys.stderr.write(f"stride: {file}: is not what it was when {run.name} was made\n")
    done = rerun(recording, parts, tolerance)
    if as_json:
        sys.stdout.write(json.dumps(done.as_dict(), indent=2) + "\n")
    else:
        _print(done, recording)
    if not done.identical:
        raise Exit(1)


def _show(
    run: Path, view: "ViewName", slower: float, begin: float | None, times: int | None
) -> None:
    """In the live view; Ctrl-C is how it ends."""
    from hil.after.shown import Showing, open_view, show_recording
    from hil.plots.plotted_run import plotted_run

    plotted, showing = plotted_run(run), Showing(view, slower, begin, times)
    with closing(open_view(plotted, showing)) as feed, suppress(KeyboardInterrupt):
        sys.stderr.writelines(f"stride: view: {line}\n" for line in feed.place.splitlines())
        show_recording(plotted, showing, feed)


def changed_files(meta: dict[str, Any]) -> list[str]:
    """Robot file and model of a run, where they are still there and another text."""
    from hil.run_folder import sha256

    known = ((meta[key], meta[f"{key}_sha256"]) for key in ("description", "model"))
    return [file for file, digest in known if Path(file).is_file() and sha256(file) != digest]


def _print(done: "Rerun", recording: "Recording") -> None:
    from hil.cli.table import print_rows

    made_from = "recorded frames" if done.estimated else "recorded estimates (the simulation's)"
    sys.stdout.write(f"{done.ticks} ticks, {done.commands} commands, from {made_from}\n")
    if not recording.complete:
        sys.stdout.write("the recording is cut off: compared up to its last whole chunk\n")
    if done.gaps:
        sys.stdout.write(f"{done.gaps} walking ticks are not in the recording\n")
    if done.raised is not None:
        sys.stdout.write(f"raised{', as then' if done.raised_then else ''}: {done.raised}\n")
    if done.mended:
        sys.stdout.write("the run's controller raised, this one did not\n")
    if done.differences:
        heads = ("", "", "first [s]", "first tick", "ticks", "largest", "")
        rows = [
            (f"{one.topic}.{one.field}", one.element, f"{one.time_s:.3f}", str(one.first_tick),
             str(one.ticks), f"{one.largest:.3g}", one.unit)
            for one in done.differences[:SHOWN]
        ]  # fmt: skip
        print_rows("what is not as it was, the earliest first", heads, rows)
        more = len(done.differences) - SHOWN
        if more > 0:
            sys.stdout.write(f"and {more} more numbers (--json)\n")
    sys.stdout.write("identical\n" if done.identical else "different\n")
