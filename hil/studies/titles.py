"""Words that the tables and figures of all studies share."""

from hil.request import RunRequest
from hil.studies.study import Result


def title(request: RunRequest, *, controller: bool = True) -> str:
    """Robot, rung, rate and PD of the controller where they do not vary, and what is changed."""
    parts = [request.robot, "dry run" if request.backend == "bus" else "MuJoCo"]
    if controller:
        parts.append(f"{request.rate_hz} Hz")
        parts += [f"{request.pd} PD"] if request.pd else []
    return ", ".join([*parts, str(request.estimator), *request.overrides])


def outcome(row: Result) -> str:
    """How a walk ended: nothing to say of one that came to its end."""
    if row.get("error"):
        return f"error: {row['error']}"
    if row.get("ending"):
        return f"{row['ending']} at {row['stopped_s']:.1f} s"
    return ""


def number(value: float | None, spec: str) -> str:
    """A table's cell, in the format that the column has; a dash where there is nothing."""
    return "–" if value is None else f"{value:{spec}}"
