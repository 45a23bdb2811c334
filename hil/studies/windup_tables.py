"""The tables of `stride study windup` for the screen."""

import math
from collections.abc import Callable

from hil.studies.study import Result, Table


def windup_tables(head: str, rows: list[Result]) -> list[Table]:
    """One table a question, the plain windup first."""
    of = {
        name: [row for row in rows if row["table"] == name]
        for name in ("plain", "3.1", "3.2", "3.3", "characters")
    }
    return [
        _plain(head, of["plain"][0]),
        _gains(of["3.1"]),
        _muscles(of["3.2"]),
        _limits(of["3.3"]),
        _characters(of["characters"]),
    ]


def _plain(head: str, row: Result) -> Table:
    lines = [
        ("force of the legs", f"{row['force_n']:.4g} N of {row['wanted_force_n']:.4g} N"),
        ("iterations", _iterations(row)),
        ("the centre of mass goes down by", _millimetres(row, "depth_m")),
        ("bend of hip, knee, ankle", _bends(row)),
        ("balance error at the end", _millimetres(row, "balance_error_m")),
        ("closest to the edge of the support", _millimetres(row, "least_margin_m")),
        ("muscle k, r", f"{row['stiffness_n_per_m']:.4g} N/m, {1e3 * row['width_m']:.3g} mm"),
        ("k for a windup as deep as the push", f"{row['push_stiffness_n_per_m']:.4g} N/m"),
    ]
    return Table(f"Windup: {head}", ("", ""), lines)


def _gains(rows: list[Result]) -> Table:
    lines = [
        (
            f"{row['kp']:g}",
            f"{row['kd']:g}",
            f"{settling(row['kp'], row['kd']):.2f}",
            _iterations(row),
            _percent(row, "force_overshoot"),
            _millimetres(row, "largest_step_m"),
            _millimetres(row, "least_margin_m"),
        )
        for row in rows
    ]
    heads = ("kp", "kd", "|z|", "iterations", "force overshoot", "largest step", "least margin")
    return Table("Table 3.1: controller constants; |z| ≥ 1 cannot settle", heads, lines)


def settling(kp: float, kd: float) -> float:
    """What remains of a small error after one iteration.

    e(i+1) = e(i) − kp·e(i) − kd·(e(i) − e(i−1)), since the errors are lengths of the hip's own
    travel: the largest root of z² − (1 − kp − kd)·z − kd.
    """
    middle = 0.5 * (1.0 - kp - kd)
    return abs(middle) + math.sqrt(middle * middle + kd)


def _muscles(rows: list[Result]) -> Table:
    lines = [
        (
            row["law"],
            row["varied"],
            f"{row['scale']:g}",
            *_result(row, _muscle, 5),
            _end(row),
        )
        for row in rows
    ]
    heads = ("", "", "times", "k N/m", "r mm", "bend of the knee", "goes down", "knee torque", "")
    return Table("Table 3.2: spring muscles, k and r varied one at a time", heads, lines)


def _muscle(row: Result) -> tuple[str, ...]:
    return (
        f"{row['stiffness_n_per_m']:.4g}",
        f"{1e3 * row['width_m']:.3g}",
        f"{row['knee_deg']:.0f}°",
        _millimetres(row, "depth_m"),
        f"{row['knee_torque_nm']:.3g} N·m",
    )


def _limits(rows: list[Result]) -> Table:
    lines = [
        (
            row["joint"],
            f"{math.degrees(row['lower_rad']):.0f}° … {math.degrees(row['upper_rad']):.0f}°",
            f"{row['share']:.0%}",
            *_result(row, _limit, 3),
            _end(row),
        )
        for row in rows
    ]
    heads = ("", "range", "of it", "bend of hip, knee, ankle", "goes down", "force reached", "")
    return Table(
        "Table 3.3: joint limits narrowed about the start, for as deep a windup as they let",
        heads,
        lines,
    )


def _limit(row: Result) -> tuple[str, ...]:
    return (
        _bends(row),
        _millimetres(row, "depth_m"),
        f"{row['force_n'] / row['wanted_force_n']:.0%}",
    )


def _characters(rows: list[Result]) -> Table:
    lines = [
        (row["law"], row["character"], *_result(row, _character, 4), _end(row)) for row in rows
    ]
    heads = ("", "", "force", "bend of the knee", "goes down", "least margin", "")
    return Table("The same target and air time elsewhere, and for others", heads, lines)


def _character(row: Result) -> tuple[str, ...]:
    return (
        f"{row['wanted_force_n']:.4g} N",
        f"{row['knee_deg']:.0f}°",
        _millimetres(row, "depth_m"),
        _millimetres(row, "least_margin_m"),
    )


def _result(row: Result, cells: Callable[[Result], tuple[str, ...]], count: int) -> tuple[str, ...]:
    """The cells of a row; dashes for a windup that was refused."""
    return ("–",) * count if "error" in row else cells(row)


def _iterations(row: Result) -> str:
    if "error" in row:
        return "–"
    return str(row["iterations"]) if row["converged"] else f"not in {row['iterations']}"


def _end(row: Result) -> str:
    """How a windup ended, where not as it should."""
    if "error" in row:
        return str(row["error"])
    if row["converged"]:
        return ""
    return f"at the limit: {row['blocked_by']}" if row["blocked_by"] else "does not settle"


def _bends(row: Result) -> str:
    return ", ".join(f"{row[f'{kind}_deg']:.0f}°" for kind in ("hip_pitch", "knee", "ankle_pitch"))


def _millimetres(row: Result, key: str) -> str:
    return "–" if row.get(key) is None else f"{1e3 * row[key]:.1f} mm"


def _percent(row: Result, key: str) -> str:
    return "–" if row.get(key) is None else f"{max(0.0, row[key]):.0%}"
