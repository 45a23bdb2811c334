"""`stride export`: a recording as CSV or JSON lines."""

import sys
from pathlib import Path
from typing import Annotated, Literal

from typer import Argument, Option

EPILOG = """[bold]Example[/bold]

stride export runs/20260101-120000-minibiped --format csv > walk.csv
"""


def export(
    run: Annotated[Path, Argument(help="A run folder.")],
    form: Annotated[Literal["csv", "jsonl"], Option("--format", help="What to write.")] = "csv",
    out: Annotated[Path | None, Option(help="File to write.", show_default="stdout")] = None,
) -> None:
    """Write every recorded tick as one line: CSV columns, or one JSON object."""
    from hil.errors import InputError
    from hil.export import write_csv, write_json_lines
    from hil.recording import read_recording

    recording = read_recording(run)
    write = write_csv if form == "csv" else write_json_lines
    if out is None:
        write(recording, sys.stdout)
        return
    try:
        with out.open("w", encoding="utf-8") as stream:
            write(recording, stream)
    except OSError as error:
        raise InputError(f"--out {out}: cannot be written: {error.strerror}") from error
