"""How a joint's positive sense looks to somebody who holds the leg, from the robot's model."""

from typing import Literal

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats

_SEEN = 0.05
"""A point that moves by less a radian shows nothing [m/rad]."""
_REACH = 0.1
"""From the middle of the sole to the points at its rim that are watched [m]."""
_WAYS = (("forward", "backward"), ("to the left", "to the right"), ("up", "down"))


def motion_words(description: RobotDescription) -> dict[str, str]:
    """What moves which way when a joint's angle rises, by joint; in the model's zero pose.

    A point p of the foot moves with a × (p − anchor), a being the joint's axis. Of the sole's
    middle, its toes and its left rim the first that visibly moves is told, along x forward, y left
    or z up, whichever is most.
    """
    model = mujoco.MjModel.from_xml_path(str(description.model_path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    forward, left = np.array([_REACH, 0.0, 0.0]), np.array([0.0, _REACH, 0.0])
    words = {}
    for name in description.joint_names:
        joint = model.joint(name).id
        side: Literal["left", "right"] = "right" if name.startswith("right") else "left"
        sole = data.geom_xpos[model.geom(description.feet[side].sole).id]
        points = (
            (f"the {side} foot", sole),
            (f"the toes of the {side} foot", sole + forward),
            (f"the left rim of the {side} sole", sole + left),
        )
        axis, anchor = data.xaxis[joint], data.xanchor[joint]
        words[name] = _told(axis, anchor, points)
    return words


def _told(axis: Floats, anchor: Floats, points: tuple[tuple[str, Floats], ...]) -> str:
    moves = [(what, np.cross(axis, point - anchor)) for what, point in points]
    seen = [(what, move) for what, move in moves if np.abs(move).max() > _SEEN]
    what, move = seen[0] if seen else max(moves, key=lambda one: float(np.abs(one[1]).max()))
    way = int(np.argmax(np.abs(move)))
    verb = "move" if what.split()[1] == "toes" else "moves"
    return f"{what} {verb} {_WAYS[way][0 if move[way] > 0 else 1]}"
