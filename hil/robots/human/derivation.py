"""Where every number of the 28-DOF human's body comes from, and the MJCF made of them.

`python -m hil.robots.human.derivation > hil/robots/human/human.xml` writes the model; a test
holds the checked-in file to this output. The tables are those of the seeds' first author (public
character file `bipV2.rbs`), in his axes x left, y up, z forward; `_to_world` maps them to ours,
x forward, y left, z up. Lengths in m, masses in kg, inertias in kg·m². Sources: `README.md`.
"""

from dataclasses import dataclass
from typing import Literal

Vector = tuple[float, float, float]
AUTHOR_AXES = {"yaw": (0.0, 1.0, 0.0), "roll": (0.0, 0.0, 1.0), "pitch": (1.0, 0.0, 0.0)}
"""Names of rotations: about up, forward and left."""


def _to_world(vector: Vector) -> Vector:
    """Author's (left, up, forward) to ours (forward, left, up); cyclic, so signs are kept."""
    left, up, forward = vector
    return (forward, left, up)


@dataclass(frozen=True)
class Shape:
    """A collision or display shape in the body frame, author's axes."""

    kind: Literal["sphere", "capsule", "box"]
    start: Vector
    """Centre of a sphere, one end of a capsule's axis, low corner of a box."""
    end: Vector = (0.0, 0.0, 0.0)
    """Other end of the axis, high corner of the box."""
    radius: float = 0.0


@dataclass(frozen=True)
class Hinge:
    """One hinge of a joint, in the order in which the hinges act from parent to child."""

    suffix: str
    """Appended to the joint's name; empty for a single hinge."""
    turn: str
    """Key of AUTHOR_AXES."""
    low: float
    high: float
    """Range [rad]."""


@dataclass(frozen=True)
class Body:
    """One rigid body whose frame sits at its centre of mass."""

    name: str
    parent: str
    joint: str
    mass: float
    inertia: Vector
    """Principal moments, author's axes."""
    shape: Shape
    on_parent: Vector = (0.0, 0.0, 0.0)
    """The joint in the parent's frame."""
    on_child: Vector = (0.0, 0.0, 0.0)
    """The joint in this body's frame."""
    hinges: tuple[Hinge, ...] = ()


def _triple(ranges: dict[str, tuple[float, float]]) -> tuple[Hinge, ...]:
    """A ball joint as three hinges; the second one must stay off ±π/2."""
    return tuple(Hinge(f"_{turn}", turn, *limits) for turn, limits in ranges.items())


def _mirrored(limits: tuple[float, float], sign: int) -> tuple[float, float]:
    return limits if sign > 0 else (-limits[1], -limits[0])


SPINE = _triple({"yaw": (-0.6, 0.6), "roll": (-0.6, 0.6), "pitch": (-0.6, 0.6)})
"""Back and neck."""
PELVIS_HEIGHT = 1.035
"""Start height: the toes' soles touch the floor with all joints at zero."""


def _arm(side: str, sign: int) -> list[Body]:
    shoulder = _triple({"roll": (-1.7, 1.7), "yaw": (-1.5, 1.5), "pitch": (-1.5, 1.5)})
    elbow = (Hinge("", "yaw", *_mirrored((-2.7, 0.0), sign)),)
    return [
        Body(
            f"{side}_upper_arm", "torso", f"{side}_shoulder", 2.2, (0.005, 0.02, 0.02),
            Shape("capsule", (-0.15, 0, 0), (0.15, 0, 0), 0.04),
            (sign * 0.20, 0.07, 0.02), (-sign * 0.17, 0, 0), shoulder,
        ),
        Body(
            f"{side}_forearm", f"{side}_upper_arm", f"{side}_elbow", 1.7, (0.0024, 0.025, 0.025),
            Shape("capsule", (-0.15, 0, 0), (0.15, 0, 0), 0.035),
            (sign * 0.175, 0, 0.006), (-sign * 0.215, 0, 0), elbow,
        ),
    ]  # fmt: skip


def _leg(side: str, sign: int) -> list[Body]:
    hip = _triple({"yaw": (-1.0, 1.0), "roll": _mirrored((-0.6, 1.0), sign), "pitch": (-1.9, 1.3)})
    ankle = _triple({"pitch": (-1.2, 1.2), "roll": (-0.75, 0.75)})
    return [
        Body(
            f"{side}_thigh", "pelvis", f"{side}_hip", 6.6, (0.15, 0.022, 0.15),
            Shape("capsule", (0, 0.12, 0), (0, -0.26, 0), 0.05),
            (sign * 0.1, -0.05, 0), (0, 0.21, 0), hip,
        ),
        Body(
            f"{side}_shank", f"{side}_thigh", f"{side}_knee", 3.2, (0.055, 0.007, 0.055),
            Shape("capsule", (0, 0.12, 0), (0, -0.20, 0), 0.05),
            (0, -0.26, 0), (0, 0.21, 0), (Hinge("", "pitch", 0.0, 2.5),),
        ),
        Body(
            f"{side}_foot", f"{side}_shank", f"{side}_ankle", 1.0, (0.007, 0.008, 0.002),
            Shape("box", (-0.025, -0.033, -0.09), (0.025, 0.005, 0.055)),
            (0, -0.25, 0.01), (0, 0.02, -0.04), ankle,
        ),
        Body(
            f"{side}_toes", f"{side}_foot", f"{side}_toe", 0.2, (0.002, 0.002, 0.0005),
            Shape("box", (-0.023, -0.015, 0.010), (0.023, 0.005, 0.035)),
            (0, -0.02, 0.05), (0, 0, -0.025), (Hinge("", "pitch", -0.52, 0.02),),
        ),
    ]  # fmt: skip


BODIES = [
    Body(
        "pelvis", "", "root", 12.9, (0.0705, 0.11, 0.13),
        Shape("sphere", (0, -0.075, 0), radius=0.12),
    ),
    Body(
        "torso", "pelvis", "back", 22.5, (0.34, 0.21, 0.46),
        Shape("sphere", (0, 0, 0), radius=0.11),
        (0, 0.17, -0.035), (0, -0.23, -0.01), SPINE,
    ),
    Body(
        "head", "torso", "neck", 5.2, (0.04, 0.02, 0.042), Shape("sphere", (0, 0, 0), radius=0.11),
        (0, 0.1, 0), (0, -0.16, -0.025), SPINE,
    ),
    *_arm("left", 1),
    *_arm("right", -1),
    *_leg("left", 1),
    *_leg("right", -1),
]  # fmt: skip
"""Parents come before their children; joints follow this order."""
SOLES = {"foot": "sole", "toes": "toe"}
"""Bodies whose box touches the floor, and what the box is called."""


def _numbers(values: Vector) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in values)


def _geom(body: Body) -> str:
    shape = body.shape
    side, _, part = body.name.partition("_")
    name = f"{side}_{SOLES[part]}" if part in SOLES else body.name
    head = f'<geom name="{name}" class="{"sole" if part in SOLES else "part"}"'
    start, end = _to_world(shape.start), _to_world(shape.end)
    if shape.kind == "sphere":
        return f'{head} type="sphere" pos="{_numbers(start)}" size="{shape.radius:g}"/>'
    if shape.kind == "capsule":
        ends = f"{_numbers(start)} {_numbers(end)}"
        return f'{head} type="capsule" fromto="{ends}" size="{shape.radius:g}"/>'
    pairs = list(zip(start, end, strict=True))
    centre = tuple((low + high) / 2 for low, high in pairs)
    half = tuple((high - low) / 2 for low, high in pairs)
    return f'{head} type="box" pos="{_numbers(centre)}" size="{_numbers(half)}"/>'  # type: ignore[arg-type]


def _joints(body: Body) -> list[str]:
    if not body.parent:
        return [f'<freejoint name="{body.joint}"/>']
    place = _numbers(_to_world(body.on_child))
    return [
        f'<joint name="{body.joint}{hinge.suffix}" pos="{place}" '
        f'axis="{_numbers(_to_world(AUTHOR_AXES[hinge.turn]))}" '
        f'range="{hinge.low + 0.0:g} {hinge.high + 0.0:g}"/>'
        for hinge in body.hinges
    ]


def _body(body: Body, depth: int) -> list[str]:
    pad = "  " * depth
    place = tuple(a - b for a, b in zip(body.on_parent, body.on_child, strict=True))
    if not body.parent:
        place = (0.0, PELVIS_HEIGHT, 0.0)
    inertial = (
        f'<inertial pos="0 0 0" mass="{body.mass:g}" '
        f'diaginertia="{_numbers(_to_world(body.inertia))}"/>'
    )
    inner = [*_joints(body), inertial, _geom(body)]
    lines = [f'{pad}<body name="{body.name}" pos="{_numbers(_to_world(place))}">']  # type: ignore[arg-type]
    lines += [f"{pad}  {line}" for line in inner]
    for child in BODIES:
        if child.parent == body.name:
            lines += _body(child, depth + 1)
    return [*lines, f"{pad}</body>"]


def mjcf() -> str:
    """The whole model as MJCF. It has no actuators: the plant applies torques to the joints."""
    lines = [
        "<!-- Written by hil/robots/human/derivation.py: change the numbers there. -->",
        '<mujoco model="human">',
        '  <compiler angle="radian" autolimits="true"/>',
        '  <option cone="elliptic" integrator="Euler" jacobian="dense" iterations="50"/>',
        "  <default>",
        '    <joint type="hinge"/>',
        '    <geom friction="0.8 0.005 0.0001"/>',
        '    <default class="part"><geom contype="0" conaffinity="0" rgba="0.62 0.66 0.72 1"/>'
        "</default>",
        '    <default class="sole">'
        '<geom contype="0" conaffinity="1" condim="4" rgba="0.30 0.30 0.32 1"/></default>',
        "  </default>",
        "  <worldbody>",
        '    <geom name="floor" type="plane" size="0 0 .05" contype="1" conaffinity="0" '
        'condim="4" rgba="0.86 0.87 0.88 1"/>',
        '    <light pos="0 -3 5" dir="0 0.5 -1" diffuse="0.8 0.8 0.8"/>',
        *_body(BODIES[0], 2),
        "  </worldbody>",
        "</mujoco>",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(mjcf(), end="")
