"""From a study's options to its printed table."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from hil.errors import InputError
from hil.request import RunRequest

if TYPE_CHECKING:
    from hil.studies.study import Study

StudyT = TypeVar("StudyT", bound="Study")


def resolved_request(
    robot: str, speed: float | None, overrides: list[str] | None, **values: Any
) -> RunRequest:
    """What every walk of a study has in common. Raises InputError."""
    from hil.robot_files import load_robot

    changes = tuple(overrides or ())
    schedules = {} if speed is None else {"speed": ((0.0, speed),)}
    request = RunRequest.checked(robot=robot, overrides=changes, schedules=schedules, **values)
    return request.resolved(load_robot(robot, changes))


def checked(kind: "type[StudyT]", request: RunRequest, **settings: Any) -> "StudyT":
    """A study from a user's settings; raises InputError naming the setting."""
    from pydantic import ValidationError

    try:
        return kind(request=request, **settings)
    except ValidationError as error:
        first = error.errors()[0]
        name = str(first["loc"][0])
        problem = first["msg"].removeprefix("Value error, ")
        raise InputError(
            f"study {kind.name}: {name}: {problem} (got {first['input']!r})"
        ) from error


def conduct(
    study: "Study",
    out: Path | None,
    jobs: int | None,
    *,
    as_json: bool,
    scheduler: str | None = None,
) -> None:
    """Run a study and print what it found, its folder last."""
    from rich.markup import escape

    from hil.cli.table import print_rows
    from hil.studies.run import run_study

    run = run_study(study, out, jobs, scheduler)
    if as_json:
        data = {"study": study.name, "settings": study.model_dump(mode="json"),
                "rows": run.result.rows}  # fmt: skip
        sys.stdout.write(json.dumps(data, indent=2) + "\n")
        sys.stderr.write(f"{run.folder}\n")
    else:
        for table in run.result.tables:
            print_rows(escape(table.title), table.heads, table.rows)
        sys.stdout.write(f"{run.folder}\n")
    for note in run.notes:
        sys.stderr.write(f"{note}\n")
