"""Hidden draws of a simulated robot as `--set` changes: without one, with only one, at an end."""

import json

from hil.description import RobotDescription
from hil.twin import Draws

NONE = "plant.draws=null"
"""The nominal robot."""

Range = tuple[float, float]


def drawn(description: RobotDescription) -> dict[str, Range]:
    """The ranges from which a seed draws, by quantity."""
    draws = description.plant.draws or Draws()
    ranges = {name: getattr(draws, name) for name in Draws.model_fields}
    return {name: limits for name, limits in ranges.items() if limits is not None}


def without(ranges: dict[str, Range], name: str) -> str:
    """The change that makes one quantity nominal and leaves the others drawn."""
    return _draws({key: limits for key, limits in ranges.items() if key != name})


def only(ranges: dict[str, Range], name: str) -> str:
    """The change that leaves one quantity drawn and makes the others nominal."""
    return _draws({name: ranges[name]})


def at_end(name: str, value: float) -> tuple[str, ...]:
    """The changes that put one quantity to a value for all joints, all others nominal."""
    key = "supply.resistance" if name == "supply_resistance" else f"plant.{name}"
    return NONE, f"{key}={abs(value) if name == 'floor_height' else value}"


def _draws(ranges: dict[str, Range]) -> str:
    return f"plant.draws={json.dumps(ranges)}"
