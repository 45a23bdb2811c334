"""`stride twin`: a run's goals again, through a virtual robot."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from hil.cli import options

if TYPE_CHECKING:
    from hil.after.comparison import Comparison
    from hil.after.recorded import RecordedRun

EPILOG = """[bold]Examples[/bold]

stride twin runs/live1                            a real run against the nominal robot

stride twin runs/dry1 --set plant.draws=null      a dry run against it

stride twin runs/live1 --set "plant.joint_friction={left_knee: 0.2}"    is it that?
"""


def twin(
    run: Annotated[Path, Argument(metavar="RUN", help="The folder of a run with servos.")],
    robot: Annotated[
        str | None, Option(help="Another robot file for the twin.", show_default="the run's")
    ] = None,
    seed: Annotated[
        int | None, Option(help="Which virtual robot it is.", show_default="the run's")
    ] = None,
    overrides: options.Overrides = None,
    out: Annotated[
        Path | None, Option(help="The twin's run folder.", show_default="RUN/twin")
    ] = None,
    as_json: Annotated[
        bool, Option("--json", help="Print the comparison as JSON; the folder on stderr.")
    ] = False,
) -> None:
    """Replay what a run told its servos through a virtual robot, and compare joint by joint.

    The body is carried as the run's estimator saw it and the feet carry what the load cells
    measured, so that the twin cannot fall: what differs is in the joints (docs/after-a-run.md).
    """
    from hil.after.comparison import compare_runs
    from hil.after.figures_joints import draw_joints
    from hil.after.recorded import read_run
    from hil.after.replay import replay, replay_folder, twin_request

    recorded = replay_folder(run, robot)
    request = twin_request(recorded, robot, tuple(overrides or ()), seed, out or _unused(run))
    folder = replay(recorded, request, progress=not as_json)
    other = read_run(folder)
    comparison = compare_runs(other, recorded)
    labels = (f"twin of {recorded.name}", recorded.name)
    draw_joints(comparison, labels, folder / "joints.png")
    _show(comparison, recorded, folder, as_json=as_json)


def _unused(run: Path) -> Path:
    names = ["twin", *(f"twin-{number}" for number in range(2, 100))]
    return next(path for path in map(run.joinpath, names) if not path.exists())


def _show(
    comparison: "Comparison", recorded: "RecordedRun", folder: Path, *, as_json: bool
) -> None:
    from hil.cli.joint_table import print_comparison

    if as_json:
        sys.stdout.write(json.dumps(comparison.as_dict(), indent=2) + "\n")
        sys.stderr.write(f"{folder}\n")
    else:
        print_comparison(comparison, ("its twin", recorded.name))
        sys.stdout.write(f"{folder}\n")
