"""The two legs of a model: which chains of joints reach the ground, and which is the left one."""

import re
from dataclasses import dataclass

import mujoco
import numpy as np

from hil.errors import InputError
from hil.interface import Floats
from hil.new_robot.shapes import lowest_points
from hil.new_robot.source import Source

REACH = 0.2
"""A limb that ends within this share of the robot's height above its lowest point is a leg."""
TOES = 2
"""Chains that differ by no more joints than this are one limb with several toes."""
LEAST_SPACING = 0.01
"""Of the hips, as a share of the robot's height: legs in one plane are no two sides."""


@dataclass(frozen=True, slots=True)
class Limb:
    """One leg as it was found: joints from the body outward."""

    joints: tuple[int, ...]
    """MuJoCo joint ids."""

    def names(self, model: mujoco.MjModel) -> tuple[str, ...]:
        """Names of its joints."""
        return tuple(model.joint(joint).name for joint in self.joints)


@dataclass(frozen=True, slots=True)
class Legs:
    """Both legs and the way the robot looks."""

    left: Limb
    right: Limb
    heading: float
    """Angle about z that turns the model's x axis into the robot's forward [rad]."""
    guessed: bool
    """No name says left or right: forward is taken to be the model's x axis."""


def find_legs(source: Source) -> Legs:
    """Both legs. Raises InputError where there are not just two."""
    model = source.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    limbs = _limbs(source, model, data)
    if len(limbs) != 2:
        raise InputError(f"{source.file}: {_count(model, limbs)}")
    first, second = _without_waist(limbs)
    for limb in (first, second):
        for joint in limb.joints:
            if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
                raise InputError(
                    f"{source.file}: joint {model.joint(joint).name} of a leg is no hinge"
                )
    return _sides(source, data, first, second)


def _limbs(source: Source, model: mujoco.MjModel, data: mujoco.MjData) -> list[Limb]:
    """Chains of joints whose last link is near the ground."""
    weld = model.body_weldid
    parents = {int(weld[model.body_parentid[body]]) for body in range(1, model.nbody)
               if weld[body] == body}  # fmt: skip
    heights = lowest_points(model, data)
    ends = [body for body in np.unique(weld[1:]).tolist() if body not in parents and body]
    lowest = {body: float(heights[weld == body].min()) for body in ends}
    chains = {body: _chain(model, body) for body in ends}
    chains = {body: chain for body, chain in chains.items() if chain}
    if not chains:
        raise InputError(
            f"{source.file}: nothing with joints moves freely (a free root joint with limbs of "
            "hinges): no legs found"
        )
    ground = min(lowest[body] for body in chains)
    tall = max(float(data.xanchor[joint][2]) for chain in chains.values() for joint in chain)
    near = [
        chains[body] for body in sorted(chains, key=lambda body: -len(chains[body]))
        if lowest[body] - ground < REACH * (tall - ground)
    ]  # fmt: skip
    limbs: list[Limb] = []
    for chain in near:
        own = [len(set(chain) - set(limb.joints)) for limb in limbs]
        if all(count > TOES for count in own):
            limbs.append(Limb(chain))
    return limbs


def _chain(model: mujoco.MjModel, body: int) -> tuple[int, ...]:
    """Joints from the free root to a body; none for a body that hangs on no free root."""
    joints: list[int] = []
    while body:
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        own = list(range(first, first + count)) if count else []
        if own and model.jnt_type[own[0]] == mujoco.mjtJoint.mjJNT_FREE:
            return tuple(joints)
        joints = own + joints
        body = int(model.body_parentid[body])
    return ()


def _count(model: mujoco.MjModel, limbs: list[Limb]) -> str:
    if not limbs:
        return "no limb of hinges on a free root reaches the ground: no legs found"
    ends = ", ".join(limb.names(model)[-1] for limb in limbs)
    if len(limbs) == 1:
        return (
            f"only one leg reaches the ground (it ends at joint {ends}): a biped has two, and z is "
            "up"
        )
    return f"{len(limbs)} legs reach the ground (they end at joints {ends}): a biped has two"


def _without_waist(limbs: list[Limb]) -> tuple[Limb, Limb]:
    first, second = (limb.joints for limb in limbs)
    shared = set(first) & set(second)
    left, right = (tuple(j for j in joints if j not in shared) for joints in (first, second))
    return Limb(left), Limb(right)


def side_of(name: str) -> int:
    """+1 for the name of something on the left, -1 on the right, 0 where it does not say."""
    if re.match("[LR][A-Z][a-z]", name):
        return 1 if name[0] == "L" else -1
    lower = name.lower()
    for sign, word in ((1, "left"), (-1, "right")):
        if word in lower:
            return sign
    words = [word for word in re.split(r"[_\-. :]+", lower) if word]
    for sign, letter in ((1, "l"), (-1, "r")):
        if letter in words or (words and words[0] in (f"{letter}leg", f"l{letter}")):
            return sign
    return 0


def _sides(source: Source, data: mujoco.MjData, first: Limb, second: Limb) -> Legs:
    model = source.model
    votes = [np.sign(sum(map(side_of, limb.names(model)))) for limb in (first, second)]
    middles = [_middle(data, limb) for limb in (first, second)]
    across = (middles[0] - middles[1])[:2]
    height = float(np.ptp(data.xanchor[[*first.joints, *second.joints], 2]))
    if np.linalg.norm(across) < LEAST_SPACING * max(height, 1e-6):
        raise InputError(
            f"{source.file}: both legs lie in one plane (a planar walker): a biped has a left "
            "and a right one"
        )
    if votes[0] * votes[1] < 0:
        left, right = (first, second) if votes[0] > 0 else (second, first)
        along = across if votes[0] > 0 else -across
        heading = float(np.arctan2(-along[0], along[1]))
        quarter = np.pi / 2 * round(heading / (np.pi / 2))
        return Legs(left, right, quarter if abs(heading - quarter) < 0.1 else heading, False)
    left, right = (first, second) if across[1] > 0 else (second, first)
    return Legs(left, right, 0.0, True)


def _middle(data: mujoco.MjData, limb: Limb) -> Floats:
    value: Floats = data.xanchor[list(limb.joints)].mean(axis=0)
    return value
