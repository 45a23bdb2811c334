"""`stride jog`: move one servo a little, and see how it answers."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option

from hil.cli.bringup_options import Yes

if TYPE_CHECKING:
    from hil.bringup.jog import JogRequest, Servo

EPILOG = """[bold]Examples[/bold]

stride jog /dev/ttyUSB0 --id 1               5° either way, slowly, then in sharp steps

stride jog /dev/ttyUSB0 --id 1 --degrees 2 --no-sharp    a joint in a robot: less, and only slowly
"""


def jog(
    port: Annotated[str, Argument(help="The port that the servo is on: stride scan.")],
    servo_id: Annotated[int, Option("--id", min=0, max=252, help="Its id; a new one's is 1.")],
    baud: Annotated[int | None, Option(help="Its speed.", show_default="found")] = None,
    degrees: Annotated[
        float, Option(min=0.5, max=30.0, help="How far it moves, either way.")
    ] = 5.0,
    effort: Annotated[
        float, Option(min=0.05, max=1.0, help="Limit of its duty (and current), a share.")
    ] = 0.3,
    speed: Annotated[
        float, Option(min=2.0, max=180.0, help="Speed of the slow movement in °/s.")
    ] = 20.0,
    sharp: Annotated[
        bool, Option("--sharp/--no-sharp", help="Sharp steps after the slow movement.")
    ] = True,
    yes: Yes = False,
    out: Annotated[
        Path | None, Option(help="The run folder itself.", show_default="runs/<time>-jog")
    ] = None,
    as_json: Annotated[bool, Option("--json", help="Print the report as JSON.")] = False,
) -> None:
    """Move one servo about where it stands, and record its step response. No robot file needed.

    It asks first. Torque is on only while it moves, and off, read back, at the end: also after
    Ctrl-C, and by a second process if this one is killed. Exit code 0: moved; 1: stopped, or
    you said no; 2: it cannot be moved, nothing was done.
    """
    from hil.bringup.jog import JogRequest, movable_servo

    request = JogRequest(degrees, effort, speed, sharp)
    with movable_servo(port, servo_id, baud, degrees) as servo:
        _move(servo, request, yes, out, as_json)


def _move(
    servo: "Servo", request: "JogRequest", yes: bool, out: Path | None, as_json: bool
) -> None:
    from rich.console import Console

    from hil.bringup.consent import require_consent
    from hil.bringup.jog import JogRecord, step_figures
    from hil.bringup.jog import jog as move
    from hil.bringup.jog_record import jog_meta, write_record
    from hil.run_folder import make_run_folder

    require_consent(
        f"{servo.model.name} (firmware {servo.firmware}) will switch torque on and move "
        f"{request.reach_deg:g}° either way of where it stands. Is it free to?",
        yes,
    )
    folder, record = make_run_folder(out, "jog"), JogRecord()
    try:
        with Console(stderr=True).status("") as status:
            move(servo, request, record, lambda text: status.update(f"moving {text}"))
    except BaseException as error:
        if record.samples:
            write_record(folder, jog_meta(servo, request), record, [])
            error.add_note(f"recorded until then: {folder}")
        raise
    steps = step_figures(record)
    report = write_record(folder, jog_meta(servo, request), record, steps)
    if as_json:
        sys.stdout.write(json.dumps(report, indent=2) + "\n")
        sys.stderr.write(f"{folder}\n")
    else:
        _print(report)
        sys.stdout.write(f"torque off, read back\n{folder}\n")


def _print(report: dict[str, Any]) -> None:
    from rich.markup import escape

    from hil.cli.table import print_rows
    from hil.report_words import number

    rows = [
        (
            f"{step['from_deg']:+.1f}° to {step['to_deg']:+.1f}°",
            *(
                number(step[key])
                for key in ("dead_time_ms", "rise_time_ms", "overshoot_pct", "rest_error_deg")
            ),
        )
        for step in report["steps"]
    ]
    names = ("", "dead time [ms]", "rise 10–90 % [ms]", "overshoot [%]", "rest error [°]")
    heads = [escape(name) for name in names]
    if rows:
        print_rows(f"{report['servo']}, id {report['id']}: sharp steps", heads, rows)
    sys.stdout.write(
        f"{report['samples']} looks, {number(report['looks_per_s'])} a second; supply at least "
        f"{number(report['voltage_min_v'])} V; at most {report['temperature_max_c']} °C\n"
    )
