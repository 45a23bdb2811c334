"""`stride bench`: what a tick costs on this machine, and what a bus achieves."""

import json
import sys
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from typer import Context, Option, Typer

from hil.cli import options

EPILOG = """[bold]Examples[/bold]

stride bench

stride bench --budget

stride bench bus

stride bench bus --port /dev/serial/by-id/usb-FTDI_… --baud 4000000
"""

app = Typer(
    name="bench",
    invoke_without_command=True,
    rich_markup_mode="rich",
    epilog=EPILOG,
)
Json = Annotated[bool, Option("--json", help="Print the rows as JSON.")]


@app.callback()
def bench(
    context: Context,
    duration: Annotated[float, Option(help="Walking time of each case in s.")] = 5.0,
    budget: Annotated[
        bool, Option("--budget", help="The highest rate that this computer can honestly hold.")
    ] = False,
    robot: Annotated[str, Option(help="Of the budget: a name or a YAML file.")] = "minibiped",
    as_json: Json = False,
) -> None:
    """Measure controller, tick and driver, beside the figures the project holds itself to.

    A ratio is the measured figure against the one held to. Timings drift on a shared machine:
    compare ratios of one run.
    """
    if context.invoked_subcommand is not None:
        return
    if budget:
        _budget(robot, duration, as_json)
        return
    from rich.console import Console

    from hil.bench import CASES, measure, measure_driver
    from hil.cli.table import print_rows
    from hil.report_words import number

    rows = []
    console = Console(stderr=True)
    with console.status("") as status:
        for case in CASES:
            status.update(case.name)
            rows += measure(case, duration)
        status.update("driver")
        rows += measure_driver()
    if as_json:
        columns = ("group", "name", "value", "unit", "held_to", "ratio", "good")
        _print_json([{name: getattr(row, name) for name in columns} for row in rows])
        return
    groups = [row.group for row in rows]
    lines = [
        (
            "" if place and groups[place - 1] == row.group else row.group,
            row.name,
            number(row.value),
            row.unit,
            f"{'≥' if row.more_is_better else '≤'} {number(row.held_to)}",
            f"{row.ratio:.2f}{'' if row.good else ' !'}",
        )
        for place, row in enumerate(rows)
    ]
    print_rows("stride bench", ("", "", "measured", "", "held to", "ratio"), lines)


@app.command()
def bus(
    robot: options.Robot = "minibiped",
    port: Annotated[
        str | None, Option(help="A real port, or one of `stride emulate`; no robot is needed.")
    ] = None,
    baud: Annotated[
        int | None,
        Option(
            help="Speed of that port, or of the virtual robot's buses.",
            show_default="4000000, the robot's",
        ),
    ] = None,
    ids: Annotated[
        list[int] | None, Option("--id", help="Servos to load; repeatable.", show_default="all")
    ] = None,
    cycles: Annotated[int, Option(help="Group reads and writes to time.", min=10)] = 1000,
    realtime: Annotated[
        bool, Option("--realtime", help="Virtual robot behind terminals, in its own process.")
    ] = False,
    overrides: options.Overrides = None,
    as_json: Json = False,
) -> None:
    """Measure what a servo bus achieves: rate, jitter, errors, and what limits it.

    Without --port the virtual robot's buses, in lockstep: virtual time, nothing but the model.
    Nothing moves: only registers that change nothing are written.
    """
    from hil.bus_report import measure_buses, rows_of

    measured = measure_buses(robot, port, baud, ids or [], cycles, realtime, tuple(overrides or ()))
    rows = rows_of(measured)
    if as_json:
        _print_json(rows)
        return
    _print_beside("stride bench bus", rows)


def _budget(robot: str, duration_s: float, as_json: bool) -> None:
    from dataclasses import asdict

    from hil.budget import MARGIN, baud_table, measure_budget
    from hil.robot_files import load_robot

    description = load_robot(robot, ())
    rate_hz = description.defaults.rate_hz
    found = measure_budget(robot, (), duration_s)
    phases = [asdict(phase) for phase in found.phases]
    bauds = [asdict(row) for row in baud_table(description, rate_hz)]
    if as_json:
        _print_json(
            {
                "robot": found.robot,
                "highest_rate_hz": found.highest_rate_hz,
                "quiet_rate_hz": found.quiet_rate_hz,
                "limit": found.limit,
                "margin": MARGIN,
                "tick_p50_ms": found.tick_p50_ms,
                "tick_p99_ms": found.tick_p99_ms,
                "phases": phases,
                "rate_hz": rate_hz,
                "bauds": bauds,
            }
        )
        return
    _print_columns(f"a tick of {found.robot} on this computer", phases)
    sys.stdout.write(
        f"tick in 99 of 100: {found.tick_p99_ms:.2f} ms; with {MARGIN:.0%} of the period free: "
        f"{found.highest_rate_hz} Hz; most of it: {found.limit}\n"
        f"in every other tick: {found.tick_p50_ms:.2f} ms, so {found.quiet_rate_hz} Hz on a quiet "
        "computer like this one\n\n"
    )
    _print_columns(f"planned buses at {rate_hz} Hz", bauds)


def _print_columns(title: str, rows: Sequence[Mapping[str, Any]]) -> None:
    """A table whose columns are the rows' keys."""
    from hil.cli.table import print_rows

    names = list(rows[0])
    lines = [tuple(_text(value) for value in row.values()) for row in rows]
    print_rows(title, tuple(name.replace("_", " ") for name in names), lines)


def _print_beside(title: str, rows: Sequence[Mapping[str, Any]]) -> None:
    """A table whose columns are the rows, one beside the other."""
    from hil.cli.table import print_rows

    names = list(rows[0])
    lines = [(name.replace("_", " "), *(_text(row[name]) for row in rows)) for name in names[1:]]
    print_rows(title, ("", *(str(row[names[0]]) for row in rows)), lines)


def _text(value: object) -> str:
    from hil.report_words import number

    return number(value) if isinstance(value, float) else str(value)


def _print_json(data: object) -> None:
    sys.stdout.write(json.dumps(data, indent=2) + "\n")
