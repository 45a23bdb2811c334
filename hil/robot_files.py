"""Finding and reading robot files: by name or path, with `--set KEY=VALUE` changes."""

from importlib import resources
from pathlib import Path
from typing import Any

import yaml

from hil.description import Noise, Plant, RobotDescription, Supply, Timing
from hil.errors import InputError, UnknownNameError
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


OVERRIDE_SECTIONS = ("supply", "timing", "plant", "noise", "walking")


def overridable(data: dict[str, Any]) -> dict[str, tuple[str, str]]:
    """Keys that `--set` knows: `section.key`, and `key` alone where it is unique."""
    models: dict[str, type[Config]] = {
        "supply": Supply,
        "timing": Timing,
        "plant": Plant,
        "noise": Noise,
    }
    pairs = []
    for section in OVERRIDE_SECTIONS:
        if section in models:
            pairs += [(section, key) for key in models[section].model_fields]
        else:
            pairs += [(section, str(key)) for key in data.get(section, {})]
    keys = [key for _, key in pairs]
    known = {f"{section}.{key}": (section, key) for section, key in pairs}
    known.update({key: (section, key) for section, key in pairs if keys.count(key) == 1})
    return known


def _override(data: dict[str, Any], text: str) -> None:
    key, separator, value = text.partition("=")
    if not separator or not value:
        raise InputError(f"--set takes KEY=VALUE, got {text!r}")
    known = overridable(data)
    if key not in known:
        raise UnknownNameError("--set key", key, sorted(k for k in known if "." in k))
    section, name = known[key]
    try:
        parsed = yaml.safe_load(value)
    except yaml.YAMLError as error:
        raise InputError(f"--set {key}: {value!r} is not a value") from error
    data.setdefault(section, {})[name] = parsed
