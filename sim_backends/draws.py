"""What a seed hides in a simulated servo robot, so that a seed is a robot."""

from dataclasses import asdict, dataclass

import numpy as np

from hil.description import RobotDescription
from hil.errors import UnknownNameError
from hil.interface import Floats
from hil.twin import ByJoint, Draws

NOMINAL_RESISTANCE = 0.1
"""Pack, switch and wiring where nothing is fixed or drawn [Ω]; assumed."""
_STREAM = 4
"""Child of the seed that is only for these draws."""
_QUANTITIES = (*Draws.model_fields, "floor_shape")
"""Each draws from a stream of its own, so that fixing one leaves the others as they were."""

HiddenDict = dict[str, float | list[float | None]]


@dataclass(frozen=True, slots=True)
class HiddenValues:
    """Values of one robot; arrays have the shape (n,)."""

    armature: Floats | None
    """[kg·m²]; none, or NaN for a joint, keeps the MJCF's."""
    joint_friction: Floats | None
    """[N·m]; none, or NaN for a joint, keeps the MJCF's."""
    torque_constant_scale: Floats
    joint_zero: Floats
    """Angle that an encoder shows when its joint is at zero [rad]."""
    backlash: Floats
    """Full gap [rad]."""
    pitch_bias: float
    """[rad]"""
    supply_resistance: float
    """[Ω]"""
    floor_height: tuple[float, float]
    """Lowest and highest point of the floor [m]."""

    def as_dict(self) -> HiddenDict:
        """The values for `meta.json`, without those that are the MJCF's."""
        values = asdict(self)
        return {name: _plain(value) for name, value in values.items() if value is not None}


def quantity_stream(seed: int, quantity: str) -> np.random.Generator:
    """Random numbers of one hidden quantity of the robot that is `seed`."""
    return np.random.default_rng((seed, _STREAM, _QUANTITIES.index(quantity)))


def hidden_values(description: RobotDescription, seed: int) -> HiddenValues:
    """What the robot `seed` hides: fixed by the description, else drawn, else nominal.

    Uniform draws from the ranges of `plant.draws`. The same on every backend.
    """
    plant, supply = description.plant, description.supply
    draws = plant.draws or Draws()
    names = description.joint_names

    def joints(name: str) -> Floats | None:
        return _of_joints(seed, name, getattr(plant, name), getattr(draws, name), names)

    def one(name: str, fixed: float | None, nominal: float) -> float:
        found = _values(seed, name, fixed, getattr(draws, name), 1)
        return nominal if found is None else float(found[0])

    def known(name: str, nominal: float) -> Floats:
        found = joints(name)
        return np.full(len(names), nominal) if found is None else np.nan_to_num(found, nan=nominal)

    height = plant.floor_height
    floor = (0.0 - height, height) if height is not None else draws.floor_height or (0.0, 0.0)
    resistance = supply.resistance if supply is not None else None
    return HiddenValues(
        joints("armature"),
        joints("joint_friction"),
        known("torque_constant_scale", 1.0),
        known("joint_zero", 0.0),
        known("backlash", 0.0),
        one("pitch_bias", plant.pitch_bias, 0.0),
        one("supply_resistance", resistance, NOMINAL_RESISTANCE),
        floor,
    )


def _of_joints(
    seed: int,
    name: str,
    fixed: ByJoint | None,
    limits: tuple[float, float] | None,
    joints: tuple[str, ...],
) -> Floats | None:
    """One value a joint, NaN for those of which nothing is said. Raises UnknownNameError."""
    if not isinstance(fixed, dict):
        return _values(seed, name, fixed, limits, len(joints))
    drawn = _values(seed, name, None, limits, len(joints))
    values = np.full(len(joints), np.nan) if drawn is None else drawn
    for joint, value in fixed.items():
        if joint not in joints:
            raise UnknownNameError(f"plant.{name}: joint", joint, joints)
        values[joints.index(joint)] = value
    return values


def _values(
    seed: int, name: str, fixed: float | None, limits: tuple[float, float] | None, n: int
) -> Floats | None:
    if fixed is not None:
        return np.full(n, fixed)
    if limits is None:
        return None
    return quantity_stream(seed, name).uniform(*limits, n)


def _plain(value: Floats | float) -> float | list[float | None]:
    rounded = np.round(value, 7)
    if rounded.ndim == 0:
        return float(rounded)
    return [None if np.isnan(one) else one for one in rounded.tolist()]
