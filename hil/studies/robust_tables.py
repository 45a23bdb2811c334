"""Tables of `stride study robustness`."""

from collections.abc import Callable

import numpy as np

from hil.studies.conditions import CONDITIONS
from hil.studies.study import Result, Table

NOTHING = "–"


def conditions_table(head: str, rows: list[Result]) -> Table:
    """A line a condition and rate, over all robots."""
    heads = (
        "condition", "Hz", "survived", "speed error", "± over robots", "flat %", "saturated %",
        "torque rms %", "hottest °C", "70 °C after", "",
    )  # fmt: skip
    lines = []
    for name, rate_hz in dict.fromkeys((row["condition"], row["rate_hz"]) for row in rows):
        chosen = [row for row in rows if (row["condition"], row["rate_hz"]) == (name, rate_hz)]
        lines.append((name, str(rate_hz), *_cells(chosen), _remark(name, chosen)))
    return Table(f"{head}: every seed is a robot; means, and the worst joint", heads, lines)


def blame_table(found: list[Result]) -> Table:
    """How many of the fallen walks each draw explains."""
    names = dict.fromkeys((row["condition"], row["draw"]) for row in found)
    lines = []
    for condition, draw in names:
        chosen = [row for row in found if (row["condition"], row["draw"]) == (condition, draw)]
        saved = sum(row["saved_without"] is True for row in chosen)
        felled = sum(row["felled_alone"] for row in chosen)
        lines.append((condition, draw, f"{saved}/{len(chosen)}", f"{felled}/{len(chosen)}"))
    lines.sort(key=lambda line: (list(CONDITIONS).index(line[0]), -int(line[2].split("/")[0])))
    heads = ("condition", "draw", "saved without it", "felled by it alone")
    return Table("walks that fell, again with one draw nominal and with only one", heads, lines)


def ends_table(found: list[Result]) -> Table:
    """One quantity at an end of its range for all joints, everything else nominal."""
    heads = ("condition", "Hz", "draw", "value", "speed error", "flat %", "saturated %", "")
    lines = [
        (
            row["condition"],
            str(row["rate_hz"]),
            row["draw"],
            f"{row['value']:g}",
            _error([row]),
            _mean([row], "flat_pct"),
            _mean([row], "saturation_pct"),
            _ending(row),
        )
        for row in found
    ]
    return Table("one hidden quantity at a time, at the ends of its range", heads, lines)


def _cells(rows: list[Result]) -> tuple[str, ...]:
    survived = sum(row["survived"] is True for row in rows)
    minutes = [row["minutes_to_70c"] for row in rows if row["minutes_to_70c"] is not None]
    return (
        f"{survived}/{len(rows)}",
        _error(rows),
        _error(rows, np.std),
        _mean(rows, "flat_pct"),
        _worst(rows, "saturation_pct", "saturated_joint"),
        _worst(rows, "torque_rms_pct", "loaded_joint"),
        _worst(rows, "temperature_max_c"),
        f"{min(minutes):.1f} min" if minutes else NOTHING,
    )


def _values(rows: list[Result], key: str) -> list[float]:
    return [row[key] for row in rows if row.get(key) is not None]


def _mean(rows: list[Result], key: str) -> str:
    values = _values(rows, key)
    return f"{np.mean(values):.1f}" if values else NOTHING


def _error(rows: list[Result], of: Callable[[list[float]], np.floating] = np.mean) -> str:
    """Speed error: relative, or in mm/s where no speed was asked for."""
    percent, absolute = _values(rows, "speed_error_pct"), _values(rows, "speed_error_mps")
    if percent:
        return f"{of(percent):.1f} %"
    return f"{1000.0 * of(absolute):.0f} mm/s" if absolute else NOTHING


def _worst(rows: list[Result], key: str, joint: str | None = None) -> str:
    known = [row for row in rows if row[key] is not None]
    if not known:
        return NOTHING
    worst = max(known, key=lambda row: row[key])
    return f"{worst[key]:.0f}" + (f" {worst[joint]}" if joint else "")


def _remark(name: str, rows: list[Result]) -> str:
    """Pushes survived, turns missed and errors; else the goal."""
    errors = [row["error"] for row in rows if row["error"]]
    if errors:
        return f"error: {errors[0]}"
    pushes = sum(_values(rows, "pushes"))
    if pushes:
        return f"{sum(_values(rows, 'pushes_survived')):g} of {pushes:g} pushes"
    if CONDITIONS[name].turn_deg and (headings := _values(rows, "heading_error_deg")):
        return f"heading error up to {np.max(np.abs(headings)):.1f}°"
    return CONDITIONS[name].goal


def _ending(row: Result) -> str:
    if row.get("error"):
        return f"error: {row['error']}"
    return "" if row.get("survived") else f"{row['ending']} at {row['stopped_s']:.1f} s"
