"""Figures as tables on standard output."""

import os
import sys
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from hil.report_words import main_figures

PAGE_COLUMNS = 160


def print_rows(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table; columns without a head are text, the others figures."""
    table = Table(title=title, title_justify="left", header_style="bold")
    for head in heads:
        table.add_column(head, justify="right" if head else "left")
    for row in rows:
        table.add_row(*row)
    page_console().print(table)


def print_report(report: dict[str, Any], rung: str = "") -> None:
    """The figures of a run that are known, and what went wrong.

    `rung`: what the robot did instead of walking on the ground.
    """
    where = report["backend"] if report["bus"] is None else f"{report['bus']} bus"
    what = f"{report['robot']}, {rung}" if rung else report["robot"]
    title = f"{what}, {where}, {report['rate_hz']} Hz, seed {report['seed']}"
    rows = main_figures(report, on_the_ground=not rung)
    print_rows(title, ("", f"motion from {report['motion_source']}", ""), rows)
    for fault in report["faults"]:
        line = f"{fault['time_s']:.2f} s: {fault['source']}: {fault['name']} ({fault['reaction']})"
        page_console().print(line, style="bold red", highlight=False)


def page_console() -> Console:
    """Standard output, not cut to 80 columns where nobody said how wide the page is."""
    unknown = not sys.stdout.isatty() and "COLUMNS" not in os.environ
    return Console(width=PAGE_COLUMNS if unknown else None)
