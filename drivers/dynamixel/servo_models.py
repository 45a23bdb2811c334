"""The Dynamixel models that are known, read from the tables in `models/`.

A new model is a new entry of a table there; nothing else has to change.
"""

from pathlib import Path

from drivers.dynamixel.servo_model import IndirectCells, ServoModel
from hil.description import Joint
from hil.errors import DescriptionError, InputError, UnknownNameError
from hil.validation import Config, read_yaml, validate

__all__ = [
    "SERVO_MODELS",
    "IndirectCells",
    "ServoModel",
    "find_servo_model",
    "find_servo_model_by_number",
    "read_models",
    "servo_model_of",
]

TABLES = Path(__file__).parent / "models"


class _Table(Config):
    """A family's file: common values, and each model's own."""

    sources: dict[str, str]
    defaults: dict[str, object]
    models: dict[str, dict[str, object]]


def read_models(path: Path) -> dict[str, ServoModel]:
    """Models of a family's table, by name. Raises InputError or DescriptionError."""
    table = validate(_Table, read_yaml(path), str(path))
    common = {**table.defaults, "sources": table.sources}
    models = {}
    for name, own in table.models.items():
        models[name] = validate(
            ServoModel, {**common, **own, "name": name}, str(path), f"models.{name}"
        )
        missing = set(common) | set(own)
        missing -= set(table.sources) | {"sources", "name"}
        if missing:
            raise DescriptionError(str(path), f"sources.{min(missing)}", "is missing")
    return models


def _read_all() -> dict[str, ServoModel]:
    return {
        name: model
        for path in sorted(TABLES.glob("*.yaml"))
        for name, model in read_models(path).items()
    }


SERVO_MODELS = _read_all()


def find_servo_model(name: str) -> ServoModel:
    """The model of a name. Raises UnknownNameError."""
    if name not in SERVO_MODELS:
        raise UnknownNameError("servo model", name, SERVO_MODELS)
    return SERVO_MODELS[name]


def servo_model_of(joint: Joint) -> ServoModel:
    """The model of a joint's servo. Raises InputError where none is filled in yet, and
    UnknownNameError.
    """
    if joint.servo is None:
        raise InputError(
            f"joint {joint.name}: servo is missing: fill in servo and id of every joint "
            "(`stride check --description ROBOT.yaml` lists them), or walk on --backend mujoco"
        )
    return find_servo_model(joint.servo)


def find_servo_model_by_number(number: int) -> ServoModel:
    """The model of a Model Number (0). Raises InputError."""
    for model in SERVO_MODELS.values():
        if model.number == number:
            return model
    known = ", ".join(f"{model.number} {model.name}" for model in SERVO_MODELS.values())
    raise InputError(f"unknown servo model number {number}; valid: {known}")
