"""`stride doctor`: what this computer lacks, with the remedy."""

import json
import sys
from typing import Annotated

from typer import Exit, Option

EPILOG = """[bold]Examples[/bold]

stride doctor          one line for each thing, and what to do

stride doctor --json   for a script
"""

STYLES = {"OK": "green", "WARN": "yellow", "FAIL": "bold red"}


def doctor(
    as_json: Annotated[bool, Option("--json", help="Print the lines as JSON.")] = False,
) -> None:
    """Look at Python, MuJoCo, drawing, serial ports, clocks, priorities, heat and disk.

    Nothing is changed and no port is opened. Exit code 0: nothing fails (there may be warnings);
    1: something does.
    """
    from dataclasses import asdict

    from hil.doctor.examine import examine
    from hil.doctor.machine import Machine

    findings = examine(Machine())
    if as_json:
        rows = [asdict(finding) for finding in findings]
        sys.stdout.write(json.dumps({"findings": rows}, indent=2) + "\n")
    else:
        _print([(f.status, f.what, f.found, f.fix) for f in findings])
    if any(finding.status == "FAIL" for finding in findings):
        raise Exit(1)


def _print(rows: list[tuple[str, str, str, str]]) -> None:
    from rich.markup import escape
    from rich.table import Table

    from hil.cli.table import page_console

    table = Table(header_style="bold")
    for head in ("", "what", "found", "what to do"):
        table.add_column(head, overflow="fold")
    for status, *texts in rows:
        table.add_row(f"[{STYLES[status]}]{status}[/]", *map(escape, texts))
    page_console().print(table, highlight=False)
