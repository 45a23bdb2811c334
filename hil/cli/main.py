"""`stride`: the commands, and how their errors reach the user."""

import sys
from typing import Any

import typer
from typer.core import TyperGroup

from hil import __version__
from hil.cli import (
    bench,
    calibrate,
    check,
    compare,
    doctor,
    emulate,
    export,
    gains,
    identify,
    jog,
    jump,
    monitor,
    new_robot,
    plot,
    relax,
    replay,
    scan,
    setup,
    sit,
    stand,
    stop,
    study,
    twin,
    video,
    walk,
)
from hil.errors import StrideError
from hil.signals import OperatorStop

INTERRUPTED = 130


class StrideGroup(TyperGroup):
    """Turns a user's mistake into one line and an exit code."""

    def invoke(self, ctx: Any) -> Any:
        """Run a command; a StrideError ends it with its own exit code, Ctrl-C with 130."""
        try:
            return super().invoke(ctx)
        except StrideError as error:
            _complain("; ".join([str(error), *getattr(error, "__notes__", [])]))
            raise typer.Exit(error.exit_code) from error
        except KeyboardInterrupt as error:
            _complain("; ".join(["interrupted", *getattr(error, "__notes__", [])]))
            raise typer.Exit(INTERRUPTED) from error
        except OperatorStop as error:
            _complain("; ".join([f"stopped by {error}", *getattr(error, "__notes__", [])]))
            raise typer.Exit(error.exit_code) from error


app = typer.Typer(
    name="stride",
    cls=StrideGroup,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    epilog="Start with: [bold]stride walk[/bold]. It needs no hardware.",
)
app.command(epilog=walk.EPILOG)(walk.walk)
app.command(epilog=jump.EPILOG)(jump.jump)
app.command(epilog=stand.EPILOG)(stand.stand)
app.command(epilog=sit.EPILOG)(sit.sit)
app.command(epilog=stop.EPILOG)(stop.stop)
app.command(epilog=emulate.EPILOG)(emulate.emulate)
app.command(epilog=scan.EPILOG)(scan.scan)
app.command(epilog=jog.EPILOG)(jog.jog)
app.command(epilog=setup.EPILOG)(setup.setup)
app.command(epilog=check.EPILOG)(check.check)
app.add_typer(calibrate.app)
app.command(epilog=monitor.EPILOG)(monitor.monitor)
app.command(epilog=relax.EPILOG)(relax.relax)
app.command(epilog=replay.EPILOG)(replay.replay)
app.command(epilog=twin.EPILOG)(twin.twin)
app.command(epilog=compare.EPILOG)(compare.compare)
app.command(epilog=plot.EPILOG)(plot.plot)
app.command(epilog=export.EPILOG)(export.export)
app.command(epilog=video.EPILOG)(video.video)
app.command(epilog=identify.EPILOG)(identify.identify)
app.add_typer(bench.app)
app.command(epilog=doctor.EPILOG)(doctor.doctor)
app.command(epilog=new_robot.EPILOG)(new_robot.new_robot)
app.command(epilog=gains.EPILOG)(gains.gains)
app.add_typer(study.app)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"stride {__version__}")
        raise typer.Exit


@app.callback()
def stride(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version."
    ),
) -> None:
    """The bridge between a walking controller and a small, servo-actuated biped."""
    del version  # Its callback has done everything.


def _complain(text: str) -> None:
    sys.stderr.write("stride: " + " ".join(text.split()) + "\n")


def main() -> None:
    """Entry point of the `stride` command."""
    app()
