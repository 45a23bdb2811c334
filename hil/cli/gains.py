"""`stride gains`: do servos make the stiffness and damping they are asked for?"""

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from typer import Argument, Exit, Option

from hil.cli import study_options

EPILOG = """[bold]Examples[/bold]

stride gains                                  one model of each class, in each of its modes

stride gains XM430-W210 --backend bus         one model, through driver and bytes

stride gains --figure gains.png               and what is feasible, drawn
"""
SERVOS = ("XM430-W350", "XM540-W270", "XH540-W150", "XL430-W250", "XL330-M288", "XC330-T288",
          "MX-64")  # fmt: skip
"""One of each class."""


def gains(
    servos: Annotated[
        list[str] | None,
        Argument(metavar="[SERVO]...", help="Servo models.", show_default="one of each class"),
    ] = None,
    backend: study_options.Backend = None,
    figure: Annotated[
        Path | None, Option(help="Draw what each servo can be asked for, as PNG.")
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the rows as JSON.")] = False,
) -> None:
    """Move a joint of a virtual robot of these servos, and compare its motion with what was asked.

    Exit code 1 if stiffness or damping is off by more than 10 %.
    """
    from rich.console import Console

    from hil.cli.table import print_rows
    from hil.gain_bench import cases, measure_gains

    rows = []
    with Console(stderr=True).status("") as status:
        for case in cases(servos or SERVOS):
            status.update(" ".join(str(part) for part in case[:2]))
            rows.append(measure_gains(*case, backend or "mujoco"))
    if figure is not None:
        from hil.figures_gains import draw_feasible

        draw_feasible(list(dict.fromkeys(row.servo for row in rows)), rows, figure)
    if as_json:
        data = [asdict(row) | {"good": row.good} for row in rows]
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
    else:
        lines = [
            (
                row.servo,
                row.mode,
                f"{row.stiffness:.3g}",
                f"{row.measured_stiffness:.3g}",
                f"{row.stiffness_error_pct:+.1f} %",
                f"{row.damping:.3g}",
                f"{row.measured_damping:.3g}",
                f"{row.damping_error_pct:+.1f} %{'' if row.good else ' !'}",
            )
            for row in rows
        ]
        heads = ("", "", "asked N·m/rad", "made", "error", "asked N·m·s/rad", "made", "error")
        print_rows("stiffness and damping", heads, lines)
    if not all(row.good for row in rows):
        raise Exit(1)
