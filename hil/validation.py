"""YAML to validated data: one line per mistake, naming file, key and the valid choices."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar, get_args

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from hil.errors import DescriptionError, InputError

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""The safe loader in C where PyYAML was built with it: the servo tables load six times faster."""


class Config(BaseModel):
    """Base of all configuration data: immutable, unknown keys refused, finite numbers only."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


ConfigT = TypeVar("ConfigT", bound=Config)


def read_yaml(path: Path) -> dict[str, Any]:
    """The mapping in a YAML file. Raises InputError when it is missing or is not a mapping."""
    try:
        data = yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except yaml.YAMLError as error:
        problem = str(error).replace("\n", " ")
        raise InputError(f"{path}: is not valid YAML: {problem}") from error
    if not isinstance(data, dict):
        raise InputError(f"{path}: must be a mapping of keys, got {type(data).__name__}")
    return data


def validate(model: type[ConfigT], data: Mapping[str, Any], file: str, prefix: str = "") -> ConfigT:
    """Parse data into a Config; raises DescriptionError for the first mistake found."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        key, problem = mistakes(model, error, prefix)[0]
        raise DescriptionError(file, key, problem) from error


def mistakes(
    model: type[BaseModel], error: ValidationError, prefix: str = ""
) -> list[tuple[str, str]]:
    """Key and problem of everything that is wrong, as `validate` tells the first of them."""
    return [_mistake(model, dict(detail), prefix) for detail in error.errors()]


def _mistake(model: type[BaseModel], detail: dict[str, Any], prefix: str) -> tuple[str, str]:
    location = [str(part) for part in detail["loc"]]
    key = ".".join(([prefix] if prefix else []) + location)
    problem: str = detail["msg"]
    if detail["type"] == "extra_forbidden":
        problem = f"unknown key; valid here: {', '.join(_fields_at(model, location[:-1]))}"
    elif detail["type"] == "missing":
        problem = "is missing"
    else:
        problem = problem.removeprefix("Value error, ")
        if not isinstance(detail["input"], dict):
            got = repr(detail["input"])
            problem += f" (got {got if len(got) < 60 else got[:57] + '...'})"
    return key or "(top)", problem


def _fields_at(model: type[BaseModel], location: list[str]) -> list[str]:
    """Field names of the nested model that a key path leads to."""
    current: type[BaseModel] = model
    for part in location:
        field = current.model_fields.get(part)
        if field is None:
            continue
        nested = _nested_model(field.annotation)
        if nested is not None:
            current = nested
    return sorted(current.model_fields)


def _nested_model(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in get_args(annotation):
        found = _nested_model(argument)
        if found is not None:
            return found
    return None
