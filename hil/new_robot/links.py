"""Which bodies move as one between the joints of the legs, and what they weigh together."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.interface import SIDES, Floats
from hil.new_robot.posture import Posture
from hil.new_robot.source import free_joint

TRUNK = "torso"
"""Everything that is no leg, held in its own pose."""


@dataclass(frozen=True, slots=True)
class Link:
    """Bodies of the model that the walk sees as one."""

    name: str
    bodies: tuple[int, ...]
    mass: float
    """[kg]"""
    com: Floats
    """In the zero pose, world axes [m], (3,)."""
    inertia: Floats
    """About `com`, world axes [kg·m²], (3, 3)."""


def links_of(posture: Posture) -> dict[str, Link]:
    """The links by name: the torso, and one for each leg joint, `left_knee`."""
    model = posture.model
    owner = {}
    for side, leg in zip(SIDES, posture.legs, strict=True):
        for joint in leg.roled.joints:
            owner[joint.joint] = f"{side}_{joint.role}"
    members: dict[str, list[int]] = {TRUNK: [], **{name: [] for name in owner.values()}}
    root = int(model.jnt_bodyid[free_joint(model)])
    for body in range(1, model.nbody):
        if model.body_rootid[body] == model.body_rootid[root]:
            members[_link(model, body, owner)].append(body)
    return {name: _sum(posture, name, bodies) for name, bodies in members.items()}


def _link(model: mujoco.MjModel, body: int, owner: dict[int, str]) -> str:
    """The leg joint nearest above a body, its own last one first."""
    while body:
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        for joint in reversed(range(first, first + count)):
            if joint in owner:
                return owner[joint]
        body = int(model.body_parentid[body])
    return TRUNK


def _sum(posture: Posture, name: str, bodies: list[int]) -> Link:
    """Masses added, inertias by the parallel axis theorem."""
    model, data = posture.model, posture.data
    masses = model.body_mass[bodies]
    mass = float(masses.sum())
    com = masses @ data.xipos[bodies] / mass if mass > 0.0 else np.zeros(3)
    inertia = np.zeros((3, 3))
    for body in bodies:
        axes = data.ximat[body].reshape(3, 3)
        away = data.xipos[body] - com
        inertia += axes @ np.diag(model.body_inertia[body]) @ axes.T
        inertia += model.body_mass[body] * (away @ away * np.eye(3) - np.outer(away, away))
    return Link(name, tuple(bodies), mass, com, inertia)
