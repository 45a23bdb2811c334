"""`stride export`: a recording in formats that other tools read."""

import json
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TextIO

from typer import Argument, Option

if TYPE_CHECKING:
    from hil.recording import Recording

Format = Literal["csv", "jsonl", "mcap", "foxglove"]

EPILOG = """[bold]Examples[/bold]

stride export runs/20260101-120000-minibiped --csv > walk.csv

stride export runs/killed --format mcap --out whole.mcap     what a killed recorder left, mended

stride export runs/20260101-120000-minibiped --format foxglove > layout.json
"""


def export(
    run: Annotated[Path, Argument(help="A run folder.")],
    form: Annotated[
        Format, Option("--format", help="What to write; foxglove is a layout for its plots.")
    ] = "csv",
    csv: Annotated[bool, Option("--csv", help="The same as --format csv.")] = False,
    out: Annotated[Path | None, Option(help="File to write.", show_default="stdout")] = None,
) -> None:
    """Write a recording as CSV or JSON lines, one a tick; mend it; or write a Foxglove layout.

    What was cut off is exported up to its last whole chunk.
    """
    from hil.errors import InputError
    from hil.export import write_mcap
    from hil.recording import read_recording

    if csv and form != "csv":
        raise InputError(f"--csv: does not go with --format {form}")
    recording = read_recording(run)
    if form == "mcap" and out is None:
        raise InputError("--format mcap: is no text; say where to with --out FILE.mcap")
    try:
        if form == "mcap" and out is not None:
            write_mcap(recording, out)
        elif out is not None:
            with out.open("w", encoding="utf-8") as stream:
                _write(recording, form, stream)
        else:
            _to_stdout(recording, form)
    except OSError as error:
        raise InputError(f"--out {out}: cannot be written: {error.strerror}") from error


def _to_stdout(recording: "Recording", form: Format) -> None:
    """A reader that has enough, such as `head`, is no error."""
    try:
        _write(recording, form, sys.stdout)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _write(recording: "Recording", form: Format, stream: TextIO) -> None:
    from hil.export import write_csv, write_json_lines
    from hil.foxglove_layout import foxglove_layout

    if form == "csv":
        write_csv(recording, stream)
    elif form == "jsonl":
        write_json_lines(recording, stream)
    else:
        truth = "truth" in (recording.rows.dtype.names or ())
        layout = foxglove_layout(recording.meta["joints"], truth=truth)
        stream.write(json.dumps(layout, indent=2) + "\n")
