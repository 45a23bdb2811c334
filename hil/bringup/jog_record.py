"""What a jog leaves behind: meta.json, samples.csv, report.json, picture.png."""

import csv
import platform
import sys
from dataclasses import asdict, fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil import __version__
from hil.bringup.facts import JogSample
from hil.bringup.jog import JogRecord, JogRequest, Servo, StepFigures
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, STYLE, WARNING
from hil.run_folder import git_commit, write_json


def jog_meta(servo: Servo, request: JogRequest) -> dict[str, Any]:
    """What was moved, and how it was asked."""
    return {
        "rung": "one servo",
        "servo": servo.model.name,
        "firmware": servo.firmware,
        "id": servo.id,
        "port": servo.line.port.url,
        "baud": servo.line.port.baud,
        "mode": servo.mode,
        "request": asdict(request),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "git_commit": git_commit(),
        "versions": {"stridebridge": __version__, "python": platform.python_version()},
        "command": sys.argv,
    }


def write_samples(samples: list[JogSample], path: Path) -> None:
    """One line a look; the head names quantities with their units."""
    names = [field.name for field in fields(JogSample)]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows([getattr(sample, name) for name in names] for sample in samples)


def write_record(
    folder: Path,
    meta: dict[str, Any],
    record: JogRecord,
    steps: list[StepFigures],
) -> dict[str, Any]:
    """Fill a run folder; the report is returned. Raises InputError for a full disk and the like."""
    samples = record.samples
    seconds = samples[-1].time_s - samples[0].time_s if len(samples) > 1 else 0.0
    report = {
        "servo": meta["servo"],
        "id": meta["id"],
        "samples": len(samples),
        "looks_per_s": round((len(samples) - 1) / seconds, 1) if seconds else None,
        "steps": [asdict(step) for step in steps],
        "voltage_min_v": min((sample.voltage_v for sample in samples), default=None),
        "temperature_max_c": max((sample.temperature_c for sample in samples), default=None),
    }
    write_json(folder / "meta.json", meta)
    write_samples(samples, folder / "samples.csv")
    write_json(folder / "report.json", report)
    if samples:
        draw_jog(record, meta, folder / "picture.png")
    return report


def draw_jog(record: JogRecord, meta: dict[str, Any], path: Path) -> None:
    """Position against goal, and what it took: duty and current."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 6.4), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
        _draw_position(above, record)
        _draw_effort(below, record.samples, meta["request"]["effort"])
        title = (
            f"{meta['servo']}, firmware {meta['firmware']}, id {meta['id']}, {meta['mode']} mode"
        )
        figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
        figure.savefig(path, dpi=130)


def _draw_position(axes: Axes, record: JogRecord) -> None:
    """The servo's plan is of the slow part only: without a profile there is none."""
    end = len(record.samples)
    slow = end if record.sharp_from is None else record.sharp_from
    rows = (("goal", "goal_deg", WARNING, "--", end),
            ("servo's own plan", "planned_deg", RIGHT, "-", slow),
            ("position", "position_deg", LEFT, "-", end))  # fmt: skip
    for label, name, colour, line, count in rows:
        part = record.samples[:count]
        values = [getattr(sample, name) for sample in part]
        line_style = {"color": colour, "linestyle": line, "linewidth": 1.2}
        axes.step([one.time_s for one in part], values, where="post", label=label, **line_style)
    axes.set(title="Position, from where it stood: slowly, then in sharp steps", ylabel="[°]")
    axes.legend(loc="upper right", ncols=3)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.2 * (high - low))  # room for the legend
    axes.margins(x=0)


def _draw_effort(axes: Axes, samples: list[JogSample], effort: float) -> None:
    time = [sample.time_s for sample in samples]
    axes.plot(time, [sample.duty_pct for sample in samples], color=BODY, label="duty [%]")
    if samples[0].current_a is not None:
        current = [100.0 * (sample.current_a or 0.0) for sample in samples]
        axes.plot(time, current, color="#e9b872", label="current [0.01 A]")
    for limit in (-100 * effort, 100 * effort):
        axes.axhline(limit, color=LIMIT, linestyle=":", linewidth=1.0)
    axes.set(title="What it took (dotted: limit of the duty)", xlabel="time [s]")
    axes.legend(loc="upper right", ncols=2)
    axes.margins(x=0)
