"""One fault as it is asked for: `PLANE:NAME:KIND[=VALUES][@T[+DT]]`, alone or in a plan file."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from pydantic import NonNegativeFloat, PositiveFloat

from hil.description import RobotDescription
from hil.errors import InputError, UnknownNameError
from hil.fault_kinds import FAULT_KINDS, IMU_KINDS, FaultKind, Plane, Value
from hil.validation import Config, read_yaml

FORM = "PLANE:NAME:KIND[=VALUES][@T[+DT]], as in servo:left_knee:silent@2+0.5"
EVERY = "*"
"""Stands for every servo, board or bus."""
_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_SPEC = re.compile(
    rf"(?P<plane>\w+):(?P<target>[\w*]+):(?P<kind>\w+)(?:=(?P<values>[^@]*))?"
    rf"(?:@(?P<start>{_NUMBER})(?:\+(?P<duration>{_NUMBER}))?)?"
)


class FaultSpec(Config):
    """One fault of a virtual robot."""

    plane: Plane
    target: str
    """A joint, board or bus, or `*` for all of them."""
    kind: str
    values: tuple[float, ...] = ()
    """One for each value that the kind has."""
    start: NonNegativeFloat | None = None
    """[s] from T = 0; none means from before the robot is opened."""
    duration: PositiveFloat | None = None
    """[s]; none means for ever."""

    def targets(self, description: RobotDescription) -> tuple[str, ...]:
        """Joints, boards or buses of a robot that have it. Raises UnknownNameError, InputError."""
        names = _names(self.plane, description)
        if self.target != EVERY and self.target not in names:
            what = {"servo": "joint"}.get(self.plane, self.plane)
            raise UnknownNameError(f"{what} in --fault", self.target, names)
        boards = description.boards
        chosen = names if self.target == EVERY else (self.target,)
        fitting = tuple(
            name
            for name in chosen
            if self.plane != "board" or boards[name].kind == "foot" or self.kind in IMU_KINDS
        )
        if not fitting:
            raise InputError(
                f"--fault: {self.target} has no load cells to be {self.kind}; "
                f"valid: {', '.join(sorted(IMU_KINDS))}"
            )
        return fitting


def _names(plane: Plane, description: RobotDescription) -> tuple[str, ...]:
    if plane == "servo":
        return tuple(joint.name for joint in description.joints if joint.bus is not None)
    return tuple(description.boards if plane == "board" else description.buses)


def parse_fault(text: str, option: str = "--fault") -> FaultSpec:
    """One fault from its text. Raises InputError that names the valid choices."""
    match = _SPEC.fullmatch(text.strip())
    if match is None:
        raise InputError(f"{option}: {text!r} is not of the form {FORM}")
    plane, kind_name = match["plane"], match["kind"]
    if plane not in FAULT_KINDS:
        raise UnknownNameError(f"plane in {option}", plane, FAULT_KINDS)
    kinds = FAULT_KINDS[plane]
    if kind_name not in kinds:
        raise UnknownNameError(f"{plane} fault in {option}", kind_name, kinds)
    kind = kinds[kind_name]
    start, duration = (None if match[k] is None else float(match[k]) for k in ("start", "duration"))
    if duration is not None and (kind.momentary or duration == 0.0):
        why = "happens at one moment, it has no +DT" if kind.momentary else "needs DT above 0"
        raise InputError(f"{option}: {text!r}: {kind_name} {why}")
    values = _values(kind, match["values"], f"{option}: {text!r}")
    return FaultSpec(
        plane=plane, target=match["target"], kind=kind_name, values=values, start=start,
        duration=duration,
    )  # fmt: skip


def _values(kind: FaultKind, text: str | None, where: str) -> tuple[float, ...]:
    given = [] if text is None else text.split(",")
    if len(given) > len(kind.values):
        raise InputError(f"{where}: too many values; the form is {kind.form}")
    texts = [*given, *[None] * (len(kind.values) - len(given))]
    return tuple(
        _value(value, word, f"{where}: {kind.form}")
        for value, word in zip(kind.values, texts, strict=True)
    )


def _value(value: Value, text: str | None, where: str) -> float:
    if text is None:
        return value.default
    if value.words:
        if text not in value.words:
            raise InputError(f"{where}: unknown {text!r}; valid: {', '.join(value.words)}")
        return value.words[text]
    try:
        number = float(text)
    except ValueError:
        raise InputError(f"{where}: {text!r} is not a number") from None
    if not value.low <= number <= value.high:
        raise InputError(f"{where}: {value.name} must be {value.low:g} to {value.high:g}")
    return number


def read_fault_plan(path: Path) -> tuple[FaultSpec, ...]:
    """The faults of a plan file, `faults:` with a list of texts. Raises InputError."""
    data = read_yaml(path)
    texts = data.get("faults")
    if set(data) != {"faults"} or not isinstance(texts, list):
        raise InputError(f"{path}: must hold one key, faults, with a list of {FORM}")
    return tuple(parse_fault(str(text), f"{path}: faults") for text in texts)


def check_faults(faults: Iterable[FaultSpec], description: RobotDescription) -> None:
    """Raises InputError for the first fault that the robot cannot have."""
    for fault in faults:
        fault.targets(description)


def gather_faults(texts: Sequence[str], plan: Path | None) -> tuple[FaultSpec, ...]:
    """The faults of `--fault` and `--fault-plan` together. Raises InputError."""
    given = tuple(parse_fault(text) for text in texts)
    return given if plan is None else (*given, *read_fault_plan(plan))
