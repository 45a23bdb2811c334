"""Finding and reading robot files: by name or path, with `--set KEY=VALUE` changes."""

from collections import Counter
from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from hil.description import RobotDescription, Safety, Timing
from hil.errors import InputError, UnknownNameError
from hil.twin import Noise, Plant, Supply
from hil.validation import Config, read_yaml, validate


def shipped_robots() -> tuple[str, ...]:
    """Names of the robots that ship with the package."""
    folder = resources.files("hil.robots")
    return tuple(
        sorted(
            entry.name
            for entry in folder.iterdir()
            if entry.is_dir() and (entry / f"{entry.name}.yaml").is_file()
        )
    )


def find_robot_file(robot: str) -> Path:
    """The YAML file of a robot given by name or by path. Raises InputError."""
    if robot.endswith((".yaml", ".yml")):
        path = Path(robot)
        if not path.is_file():
            raise InputError(f"{robot}: no such robot file")
        return path
    names = shipped_robots()
    if robot not in names:
        raise UnknownNameError("robot", robot, (*names, "or a .yaml file"))
    return Path(str(resources.files("hil.robots"))) / robot / f"{robot}.yaml"


def load_robot(robot: str, overrides: tuple[str, ...] = ()) -> RobotDescription:
    """Read a robot by name or file, with `KEY=VALUE` overrides of what `overridable` lists.

    Raises DescriptionError, UnknownNameError or InputError.
    """
    path = find_robot_file(robot)
    data = read_yaml(path)
    for text in overrides:
        _override(data, text)
    data["file"] = str(path)
    return validate(RobotDescription, data, str(path))


FIXED_SECTIONS: dict[str, type[Config]] = {
    "supply": Supply,
    "timing": Timing,
    "plant": Plant,
    "safety": Safety,
    "noise": Noise,
}
"""Sections whose keys can be set although the file may leave them out."""

KeyPath = tuple[Any, ...]
"""Keys from the top of a robot file down; some, such as control rates, are numbers there."""


def overridable(data: dict[str, Any]) -> dict[str, KeyPath]:
    """Keys that `--set` knows: whole dotted paths, and every end of one that is unique."""
    paths: list[KeyPath] = [
        (section, key) for section, model in FIXED_SECTIONS.items() for key in model.model_fields
    ]
    for section in ("gains", "walking"):
        paths += _paths(data.get(section, {}), (section,))
    known = {_dotted(path): path for path in paths}
    ends = [(_dotted(path[start:]), path) for path in paths for start in range(1, len(path))]
    counts = Counter(end for end, _ in ends)
    return {end: path for end, path in ends if counts[end] == 1} | known


def _paths(section: dict[Any, Any], above: KeyPath) -> list[KeyPath]:
    """Paths of everything in a section, at any depth, sections included."""
    paths: list[KeyPath] = []
    for key, value in section.items():
        paths.append((*above, key))
        if isinstance(value, dict):
            paths += _paths(value, (*above, key))
    return paths


def _dotted(path: KeyPath) -> str:
    return ".".join(map(str, path))


def _override(data: dict[str, Any], text: str) -> None:
    key, separator, value = text.partition("=")
    if not separator or not value:
        raise InputError(f"--set takes KEY=VALUE, got {text!r}")
    known = overridable(data)
    if key not in known:
        raise UnknownNameError("--set key", key, sorted({_dotted(path) for path in known.values()}))
    *sections, name = known[key]
    try:
        parsed = yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise InputError(f"--set {key}: {value!r} is not a value") from error
    place = data
    for section in sections:
        place = place.setdefault(section, {})
    place[name] = parsed
