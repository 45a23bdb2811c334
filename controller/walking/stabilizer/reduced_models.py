"""Reduced models M0-M6 of any robot: parts dropped, their weight kept as one force.

Seed 000_bd1305a0ae731442, sections 3.1.2 and 5.1. M0 is the whole robot; M1 has no arms, M2 no
arms and head, M3 nothing above the root, M4 besides no swing leg, M5 no arms, head and swing
leg; M6 is M3 while the swing foot is on the ground, else M4. The stance leg is never touched.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.walking.stabilizer.config import ModelName
from hil.description import RobotDescription
from hil.interface import Ints

PARTS: dict[ModelName, tuple[str, ...]] = {
    "M0": (),
    "M1": ("arms",),
    "M2": ("arms", "head"),
    "M3": ("upper",),
    "M4": ("upper", "swing_leg"),
    "M5": ("arms", "head", "swing_leg"),
}
"""What each model drops; M6 is one of these from tick to tick."""
BESIDE = 0.1
"""A part whose centre of mass is this far from the middle, in leg lengths, is an arm."""


@dataclass(frozen=True, slots=True)
class ReducedModel:
    """A model without some bodies, and how it relates to the whole one."""

    model: mujoco.MjModel
    kept: Ints
    """Body of the whole model for every body of this one."""
    removed: Ints
    """Bodies of the whole model that are missing here."""
    carrier: int
    """Body of this model on which the weight of the missing ones acts."""


def build(
    description: RobotDescription, robot: RobotModel, parts: tuple[str, ...], swing: int
) -> ReducedModel:
    """The robot without `parts`; `swing` is the foot (0 left, 1 right) of the swing leg.

    The weight of what is missing acts at its centre of mass on the closest body that once
    carried all of it. Torques of joints that are missing are left out: in the whole robot they
    hold the part up, here its weight acts as if it were held.
    """
    whole = robot.model
    roots = sorted({body for part in parts for body in part_roots(robot, part, swing)})
    removed = np.array([b for b in range(whole.nbody) if _hangs_on(whole, b, roots)], dtype=int)
    kept = np.setdiff1d(np.arange(whole.nbody), removed)
    spec = mujoco.MjSpec.from_file(str(description.model_path))
    spec.compile()
    ids = {body.id: body for body in spec.bodies}
    for body in roots:
        if not _hangs_on(whole, int(whole.body_parentid[body]), roots):
            spec.delete(ids[body])
    carrier = _common_parent(whole, roots) if roots else robot.root_body
    return ReducedModel(spec.compile(), kept, removed, int(np.searchsorted(kept, carrier)))


def part_roots(robot: RobotModel, part: str, swing: int) -> list[int]:
    """First bodies of a part: `arms`, `head`, `upper` or `swing_leg`; empty if it has none.

    Legs lead from the root to the feet. Of what else hangs on the root, branches beside the
    middle plane are arms; the head is the last body of the middle, if it is not the first.
    """
    model, root = robot.model, robot.root_body
    legs = [_child_towards(model, root, int(foot)) for foot in robot.foot_bodies]
    if part == "swing_leg":
        return [legs[swing]]
    upper = [int(b) for b in np.flatnonzero(model.body_parentid == root) if b not in legs]
    if part == "upper":
        return upper
    arms: list[int] = []
    heads: list[int] = []
    pending = [(body, False) for body in upper]
    while pending:
        body, inner = pending.pop()
        children = [int(b) for b in np.flatnonzero(model.body_parentid == body)]
        if _is_beside(robot, body):
            arms.append(body)
        elif inner and not children:
            heads.append(body)
        else:
            pending += [(child, True) for child in children]
    return arms if part == "arms" else heads


def _is_beside(robot: RobotModel, body: int) -> bool:
    model = robot.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    offset = data.subtree_com[body, 1] - data.xpos[robot.root_body, 1]
    return bool(abs(offset) > BESIDE * robot.leg_length)


def _hangs_on(model: mujoco.MjModel, body: int, roots: list[int]) -> bool:
    while body > 0:
        if body in roots:
            return True
        body = int(model.body_parentid[body])
    return False


def _child_towards(model: mujoco.MjModel, root: int, body: int) -> int:
    while model.body_parentid[body] != root:
        body = int(model.body_parentid[body])
    return body


def _common_parent(model: mujoco.MjModel, bodies: list[int]) -> int:
    """The closest body on which all the given ones hang."""
    paths = []
    for body in bodies:
        path = [int(model.body_parentid[body])]
        while path[-1] > 0:
            path.append(int(model.body_parentid[path[-1]]))
        paths.append(path)
    return next(b for b in paths[0] if all(b in path for path in paths))
