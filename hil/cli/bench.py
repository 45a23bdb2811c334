"""`stride bench`: what a tick costs on this machine."""

import json
import sys
from typing import Annotated

from typer import Option


def bench(
    duration: Annotated[float, Option(help="Walking time of each case in s.")] = 5.0,
    as_json: Annotated[bool, Option("--json", help="Print the rows as JSON.")] = False,
) -> None:
    """Measure controller, tick and driver, beside the figures the project holds itself to.

    A ratio is the measured figure against the one held to. Timings drift on a shared machine:
    compare ratios of one run.
    """
    from rich.console import Console

    from hil.bench import CASES, measure, measure_driver
    from hil.cli.table import number, print_rows

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
        data = [{name: getattr(row, name) for name in columns} for row in rows]
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
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
