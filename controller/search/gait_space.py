"""The variables of the gait search: numbers of a robot file, by their keys.

Seed 003_73fecd8ec8927aad, section 6: the key points of the reference poses. A servo robot has no
key poses; what shapes its gait is searched instead, or the gains of its joints.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hil.description import RobotDescription
from hil.errors import InputError, UnknownNameError
from hil.joint_gains import set_for

POSE_SPREAD = 0.04
"""First standard deviation of a key point [rad or m] (first author's code)."""
POSE_BOUND = 10.0
"""Largest change of a key point, in spreads."""
SHARE_SPREAD = 0.04
"""First standard deviation of any other value, as a share of it (ours)."""
SHARE_BOUND = 0.4
"""Largest change of it, as a share."""
GAIN_SPREAD = 0.15
"""First standard deviation of a gain, as a share of it (ours)."""
CURVES = ("root_pitch", "back_pitch", "stance_foot", "swing_foot", "stance_knee", "swing_drop")
"""Curves about the lateral axis, which the seed searches, and the height of the swing foot."""
SERVO_GAIT = (
    "gait.period",
    "hip_height",
    "placement.step_width",
    "placement.gain_x",
    "placement.gain_y",
    "swing.height",
    "balance.gain_x",
    "balance.gain_y",
    "timing.gain",
    "weight_shift.distance",
)
"""What shapes the walk of a servo robot, under `walking`."""


GAINS = ("kp", "kd")
"""The two numbers of a pair of gains."""
GainLimits = tuple[tuple[float, float], tuple[float, float]]
"""Least and largest stiffness, least and largest damping of a joint."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One number of a robot file."""

    keys: tuple[str, ...]
    """As `--set` knows them: all take the same number."""
    place: tuple[int, ...]
    """Where it is in the value of the key: `(2, 1)` is the height of the third key point."""
    start: float
    spread: float
    """Change that a step of 1 in the search stands for."""
    low: float
    high: float

    @property
    def name(self) -> str:
        """Short and unique: `swing.height`, `key_poses.swing_drop[2]`, `knee.kp`."""
        key = self.keys[0].removeprefix("walking.")
        if not self.place:
            return key
        if key.startswith("gains."):
            return f"{key.rpartition('.')[2]}.{GAINS[self.place[0]]}"
        return f"{key}[{self.place[0]}]"


class GaitSpace:
    """Vectors of the search are changes of the variables, in spreads."""

    def __init__(self, description: RobotDescription, variables: Sequence[Variable]) -> None:
        self.variables = tuple(variables)
        keys = dict.fromkeys(key for variable in variables for key in variable.keys)
        self._starts = {key: value_at(description, key) for key in keys}

    def bounds(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Least and largest entry of every variable."""
        return bounds_of(self.variables)

    def values(self, vector: Sequence[float]) -> dict[str, Any]:
        """The values of all keys that a vector changes, in the form of the robot file."""
        values = dict(self._starts)
        for variable, change in zip(self.variables, vector, strict=True):
            number = round(variable.start + variable.spread * change, 6)
            for key in variable.keys:
                values[key] = _replaced(values[key], variable.place, number)
        return values


def bounds_of(variables: Sequence[Variable]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Least and largest change of every variable, in spreads."""
    return (
        tuple((one.low - one.start) / one.spread for one in variables),
        tuple((one.high - one.start) / one.spread for one in variables),
    )


def _replaced(value: Any, place: tuple[int, ...], number: float) -> Any:
    """A nested list with another number at a place; the number itself for no place."""
    if not place:
        return number
    first, *rest = place
    return [
        _replaced(item, tuple(rest), number) if index == first else item
        for index, item in enumerate(value)
    ]


def value_at(description: RobotDescription, key: str) -> Any:
    """The value of a key as lists and numbers. Raises InputError for a key that has none."""
    section, *rest = key.split(".")
    found: Any = description.gains if section == "gains" else description.walking
    for name in rest:
        found = found.get(int(name) if name.isdigit() else name)
        if found is None:
            raise InputError(f"{description.name} has no {key} to search")
    return _listed(found)


def pose_variables(description: RobotDescription) -> list[Variable]:
    """The values of the key points of all CURVES of a torque robot."""
    variables = []
    for curve in CURVES:
        key = f"walking.key_poses.{curve}"
        for index, (_, value) in enumerate(value_at(description, key)):
            reach = POSE_BOUND * POSE_SPREAD
            variables.append(
                Variable((key,), (index, 1), value, POSE_SPREAD, value - reach, value + reach)
            )
    return variables


def gait_variables(
    description: RobotDescription, keys: Sequence[str] = SERVO_GAIT
) -> list[Variable]:
    """Numbers under `walking`, by their keys there. Raises InputError for what is none."""
    variables = []
    for name in keys:
        key = f"walking.{name.removeprefix('walking.')}"
        value = value_at(description, key)
        if isinstance(value, bool) or not isinstance(value, int | float) or value == 0:
            raise InputError(f"{key}: only a number other than 0 can be searched (is {value!r})")
        reach = SHARE_BOUND * abs(value)
        spread = SHARE_SPREAD * abs(value)
        variables.append(Variable((key,), (), float(value), spread, value - reach, value + reach))
    return variables


def gain_variables(
    description: RobotDescription,
    rates_hz: Sequence[int],
    limits: Mapping[str, GainLimits],
    chosen: Sequence[str] = (),
) -> list[Variable]:
    """Stiffness and damping of each kind of joint of a servo robot, one pair for all rates.

    `limits` are what the registers can realise, by kind of joint; `chosen` names some of the
    variables, `knee.kp`, none for all. The search starts from the set of the highest rate. Raises
    InputError for a robot file without gain sets.
    """
    if not description.gains:
        raise InputError(f"{description.file}: gains: there are no sets to search")
    rates = list(dict.fromkeys(set_for(description.gains, rate) for rate in rates_hz))
    variables = {}
    for kind, pair in description.gains[max(rates)].items():
        keys = tuple(f"gains.{rate}.{kind}" for rate in rates)
        for place, value in enumerate(pair):
            low, high = limits[kind][place]
            start = min(max(value, low), high)
            one = Variable(keys, (place,), start, GAIN_SPREAD * value, low, high)
            variables[one.name] = one
    for name in chosen:
        if name not in variables:
            raise UnknownNameError("--vary", name, variables)
    return [variables[name] for name in chosen or variables]


def _listed(value: Any) -> Any:
    return [_listed(item) for item in value] if isinstance(value, list | tuple) else value
