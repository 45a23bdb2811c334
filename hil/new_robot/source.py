"""A foreign MJCF or URDF as a compiled MuJoCo model with a free root."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import mujoco

from hil.errors import InputError
from hil.new_robot.urdf import readable_urdf


@dataclass(frozen=True, slots=True)
class Source:
    """What was read."""

    file: Path
    model: mujoco.MjModel
    speed_limits: dict[str, float]
    """Largest speed of a joint [rad/s], by its name, where the file has one (URDF)."""
    notes: tuple[str, ...]
    """What had to be left out or added so that MuJoCo could read it."""


def read_source(path: Path) -> Source:
    """Read a model. Raises InputError for a file that is neither MJCF nor URDF, does not compile,
    or whose joints close loops.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, LookupError) as error:  # LookupError: an unknown encoding
        raise InputError(f"{path}: is not XML: {error}") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    notes: list[str] = []
    speeds: dict[str, float] = {}
    try:
        if root.tag == "robot":
            text, speeds = readable_urdf(path, root, notes)
            spec = mujoco.MjSpec.from_string(text)
        elif root.tag == "mujoco":
            spec = mujoco.MjSpec.from_file(str(path))
        else:
            raise InputError(f"{path}: <{root.tag}> is neither MJCF (<mujoco>) nor URDF (<robot>)")
        _free_the_root(spec, notes)
        model = spec.compile()
    except ValueError as error:
        problem = " ".join(str(error).split())
        raise InputError(
            problem if isinstance(error, InputError) else f"{path}: does not compile: {problem}"
        ) from error
    _refuse_loops(path, model)
    return Source(path, model, speeds, tuple(notes))


def free_joint(model: mujoco.MjModel) -> int:
    """The first free joint: that of the robot's root."""
    free = mujoco.mjtJoint.mjJNT_FREE
    return next(joint for joint in range(model.njnt) if model.jnt_type[joint] == free)


def _free_the_root(spec: mujoco.MjSpec, notes: list[str]) -> None:
    """Give the largest tree a free joint where nothing is free to move."""
    free = mujoco.mjtJoint.mjJNT_FREE
    if any(joint.type == free for joint in spec.joints):
        return
    fixed = [body for body in spec.worldbody.bodies if not body.joints]
    if fixed:
        largest = max(fixed, key=lambda body: len(body.find_all(mujoco.mjtObj.mjOBJ_BODY)))
        largest.add_freejoint()
        notes.append(f"the model stands fixed to the world: body {largest.name} was set free")


def _refuse_loops(path: Path, model: mujoco.MjModel) -> None:
    loops = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))
    for index in range(model.neq):
        if int(model.eq_type[index]) in loops:
            name = model.equality(index).name or f"number {index}"
            raise InputError(
                f"{path}: equality {name} closes a loop (connect or weld): "
                "only legs that are open chains of hinges can be read"
            )
