"""Tables of text with heads, for the bring-up commands."""

from collections.abc import Mapping, Sequence

from rich.markup import escape
from rich.table import Table

from hil.cli.table import page_console


def print_text(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table whose columns are all text; long ones fold."""
    table = Table(title=title or None, title_justify="left", header_style="bold")
    for head in heads:
        table.add_column(head, overflow="fold")
    for row in rows:
        table.add_row(*map(escape, row))
    page_console().print(table, highlight=False)


def print_findings(title: str, findings: Sequence[Mapping[str, str]]) -> None:
    """Problems in red, then remarks; nothing without findings."""
    if not findings:
        return
    table = Table(title=title, title_justify="left", header_style="bold")
    for head in ("", "where", "what", "what to do"):
        table.add_column(head, overflow="fold")
    for finding in findings:
        row = [finding[key] for key in ("severity", "where", "what", "advice")]
        table.add_row(*map(escape, row), style="red" if row[0] == "problem" else "dim")
    page_console().print(table, highlight=False)
