"""How well `stride compare` names causes: dry runs in which one known thing was changed.

Two robots walk, the nominal one and one that a seed drew; then each again with one change at a
time, and once with nothing changed but the sensor noise. Every pair goes through the same
comparison as `stride compare`. Last, two drawn robots are compared with what their meta.json says
was drawn. Runs are kept in a folder, and not made again if they are there.
"""

import argparse
import json
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hil.after.causes import Finding, find_causes, sign
from hil.after.recorded import read_run
from hil.after.signs import Signs, read_signs
from hil.compose import build
from hil.request import RunRequest
from hil.run import run

NOMINAL = ("plant.draws=null",)
DRAWN_SEEDS = (1, 2)
CAUSES = ("delay", "gain", "friction", "inertia", "zero", "imu", "battery")
NOTHING = "nothing"


@dataclass(frozen=True)
class Change:
    """One thing that is changed."""

    name: str
    cause: str
    joint: str | None
    key: str
    value: Callable[[float], float]
    """From the base robot's value."""


def by_joint(cause: str, joint: str, key: str, add: float) -> Change:
    """A quantity of one joint, changed by so much."""
    return Change(f"{key} of {joint} {add:+g}", cause, joint, key, lambda value: value + add)


CHANGES = (
    Change("sensor noise only", NOTHING, None, "noise.corner_force", lambda _: 0.31),
    by_joint("friction", "left_knee", "joint_friction", 0.1),
    by_joint("friction", "right_hip_roll", "joint_friction", 0.1),
    by_joint("gain", "left_knee", "torque_constant_scale", -0.2),
    by_joint("gain", "right_hip_pitch", "torque_constant_scale", 0.15),
    by_joint("zero", "left_knee", "joint_zero", 0.03),
    by_joint("zero", "right_ankle_pitch", "joint_zero", -0.02),
    by_joint("zero", "left_hip_roll", "joint_zero", 0.02),
    Change("one tick of latency", "delay", None, "plant.latency_ticks", lambda _: 1),
    Change("supply 10.5 V", "battery", None, "supply.voltage", lambda _: 10.5),
)


@dataclass(frozen=True)
class Walks:
    """Where runs are kept and how they are made."""

    folder: Path
    backend: str
    duration_s: float

    def make(self, name: str, seed: int, overrides: tuple[str, ...]) -> Path:
        """The folder of a run, made if it is not there."""
        folder = self.folder / name
        if not (folder / "report.json").is_file():
            request = RunRequest.checked(
                backend=self.backend,
                seed=seed,
                overrides=overrides,
                duration_s=self.duration_s,
                out=folder,
            )
            run(build(request), progress=False)
        return folder


def overrides_of(change: Change, base: Path) -> tuple[str, ...]:
    """`--set` texts that make a change on a base robot."""
    if change.joint is None:
        return (f"{change.key}={change.value(0.0)}",)
    meta = json.loads((base / "meta.json").read_text(encoding="utf-8"))
    nominal = {"joint_friction": 0.1}  # minibiped.xml, of a robot that no seed drew
    hidden = meta["hidden"].get(change.key)
    place = meta["joints"].index(change.joint)
    value = nominal[change.key] if hidden is None else hidden[place]
    return (f"plant.{change.key}={{{change.joint}: {change.value(value):.6f}}}",)


def study_pairs(walks: Walks, name: str, seed: int, base: tuple[str, ...]) -> None:
    """Every change of one robot; prints a table."""
    first = walks.make(name, seed, base)
    signs = read_signs(read_run(first))
    right: Counter[tuple[str, str]] = Counter()
    print(f"\n| {name}: changed | named first | joint | score | others |\n|---|---|---|---|---|")
    for number, change in enumerate(CHANGES):
        texts = overrides_of(change, first)
        second = walks.make(f"{name}-{number}", seed, (*base, *texts))
        found = find_causes(signs, read_signs(read_run(second)))
        others = ", ".join(f"{one.joint or 'robot'} {one.cause} {one.score:.1f}"
                           for one in found[1:])  # fmt: skip
        print(f"| {change.name} | {row(found)} | {others or '–'} |", flush=True)
        right[change.cause, found[0].cause if found else NOTHING] += 1
    print_confusion(right)


def row(found: list[Finding]) -> str:
    """Columns of what was named first."""
    if not found:
        return f"{NOTHING} | – | –"
    joint = " or ".join(found[0].candidates) or found[0].joint or "whole robot"
    return f"{found[0].cause} | {joint} | {found[0].score:.1f}"


def print_confusion(counts: Counter[tuple[str, str]]) -> None:
    """Changed causes downwards, named ones across."""
    causes = [cause for cause in (*CAUSES, NOTHING) if any(cause in pair for pair in counts)]
    print(f"\n| changed \\ named first | {' | '.join(causes)} |\n|{'---|' * (len(causes) + 1)}")
    for cause in causes:
        cells = " | ".join(str(counts[cause, named] or "") for named in causes)
        print(f"| {cause} | {cells} |")


def study_draws(walks: Walks) -> None:
    """Two drawn robots: measured differences against those that were drawn."""
    runs = [read_run(walks.make(f"drawn {seed}", seed, ())) for seed in DRAWN_SEEDS]
    first, second = (read_signs(one) for one in runs)
    print("\n| two drawn robots | joints | drawn differences, rms | error, rms | correlation |")
    print("|---|---|---|---|---|")
    for key, hidden in (("torque_constant", "torque_constant_scale"),
                        ("friction", "joint_friction"), ("inertia", "armature")):  # fmt: skip
        true = np.subtract(runs[1].meta["hidden"][hidden], runs[0].meta["hidden"][hidden])
        print_quantity(hidden, true, difference(first, second, key))
    found = find_causes(first, second)
    print("\nnamed, by score:")
    for one in found:
        print(f"* {one.joint or 'whole robot'}: {one.cause} ({one.score:.1f}): {one.evidence}")


def difference(first: Signs, second: Signs, key: str) -> np.ndarray:
    """Second minus first, by joint; NaN: unknown."""
    return np.asarray(sign(second, key)[0] - sign(first, key)[0])


def print_quantity(name: str, true: np.ndarray, found: np.ndarray) -> None:
    """One line of the table of draws."""
    known = np.isfinite(found)
    true, found = true[known], found[known]
    error = np.sqrt(np.mean((found - true) ** 2))
    correlation = np.corrcoef(true, found)[0, 1]
    print(f"| {name} | {known.sum()} | {np.sqrt(np.mean(true**2)):.3f} | {error:.3f} | "
          f"{correlation:.2f} |")  # fmt: skip


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="of the runs")
    parser.add_argument("--backend", choices=("bus", "mujoco"), default="bus")
    parser.add_argument("--seconds", type=float, default=10.0, help="of every walk")
    options = parser.parse_args()
    walks = Walks(options.folder, options.backend, options.seconds)
    study_pairs(walks, "nominal", 1, NOMINAL)
    study_pairs(walks, "drawn 1", DRAWN_SEEDS[0], ())
    study_draws(walks)


if __name__ == "__main__":
    main()
