"""Rows and table of `stride study gains`."""

from hil.description import RobotDescription
from hil.studies.gain_algorithm import Extreme, RateRange
from hil.studies.gain_sets import sides_of, total_of
from hil.studies.study import Result, Table
from hil.studies.titles import number

EMPTY: Result = dict.fromkeys(
    (
        "rate_hz",
        "joint_group",
        "count",
        "kp_start",
        "kd_start",
        "kp_min",
        "kp_max",
        "kd_min",
        "kd_max",
        "sum_min",
        "sum_max",
        "cost_min",
        "cost_max",
        "runs_min",
        "runs_max",
        "iterations",
        "evaluations",
        "ended_min",
        "ended_max",
    )
)
"""Columns of the CSV: a line a rate and kind of joint.

`count` is how many joints of the robot have these gains. `sum_min` and `sum_max` are ΣKp + 10·ΣKd
of the whole robot; costs, runs, iterations, evaluations and `ended` are those of the rate.
"""


def range_rows(found: RateRange, description: RobotDescription) -> list[Result]:
    """The lines of one rate. Where no stable motion was found, minimum and maximum are empty."""
    common = {"rate_hz": found.rate_hz, "iterations": 0, "evaluations": 0}
    for name, side in (("min", found.smallest), ("max", found.largest)):
        if side is not None:
            common |= _side(name, side, description)
            common["iterations"] += sum(run.iterations for run in side.runs)
            common["evaluations"] += sum(run.evaluations for run in side.runs)
    return [EMPTY | common | _joint(found, joint, description) for joint in found.start]


def range_table(title: str, rows: list[Result]) -> Table:
    """A line a rate: the sums of the smallest and largest gains, and how the search ended."""
    of_rate = {row["rate_hz"]: row for row in rows}
    lines = [
        (
            str(rate),
            number(row["sum_min"], ".0f"),
            number(row["sum_max"], ".0f"),
            str(row["evaluations"]),
            str(row["ended_min"]),
            str(row["ended_max"] or "–"),
        )
        for rate, row in of_rate.items()
    ]
    heads = ("rate Hz", "ΣKp+10ΣKd min", "max", "walks", "min: last run ended", "max")
    return Table(f"{title}: range of acceptable gains", heads, lines)


def _side(name: str, side: Extreme, description: RobotDescription) -> Result:
    last = side.last
    ended = last.ended if last.valid else "no stable motion"
    return {
        f"cost_{name}": last.cost,
        f"runs_{name}": len(side.runs),
        f"ended_{name}": ended,
        f"sum_{name}": total_of(description, last.gains) if last.valid else None,
    }


def _joint(found: RateRange, joint: str, description: RobotDescription) -> Result:
    row: Result = {"joint_group": joint, "count": sides_of(description, joint)}
    row["kp_start"], row["kd_start"] = found.start[joint]
    for name, side in (("min", found.smallest), ("max", found.largest)):
        if side is not None and side.last.valid:
            row[f"kp_{name}"], row[f"kd_{name}"] = side.last.gains[joint]
    return row
