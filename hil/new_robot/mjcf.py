"""The MJCF that is written: same axes, lengths and masses, every frame level in the zero pose."""

import numpy as np

from hil.interface import SIDES, Floats
from hil.new_robot.joints import JointLines
from hil.new_robot.links import TRUNK, Link
from hil.new_robot.posture import PosedLeg, Posture
from hil.new_robot.soles import Sole

LEAST_MASS = 1e-4
"""A link lighter than this share of the robot is one with the next: MuJoCo moves no bare joint."""
BONE = 0.06
"""Thickness of a drawn leg, as a share of its length."""

_HEAD = """\
<!-- Written by `stride new-robot {file}`. Axes, lengths, masses and inertias are that model's;
     shapes are boxes and bones for the eye, and only the soles touch. Frames are level, joints 0,
     where both legs hang straight down. -->
<mujoco model="{name}">
  <compiler angle="radian" autolimits="true"/>
  <option cone="elliptic" impratio="10" integrator="implicitfast" jacobian="dense"/>
  <default>
    <geom friction="0.9 0.005 0.0001" solref="0.01 1"/>
    <default class="part"><geom contype="0" conaffinity="0" mass="0"/></default>
    <default class="sole">
      <geom contype="0" conaffinity="1" condim="4" mass="0" rgba="0.3 0.3 0.32 1"/>
    </default>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 .05" contype="1" conaffinity="0" condim="4"
          rgba="0.86 0.87 0.88 1"/>
    <light pos="0 -1 2" dir="0 0.4 -1" diffuse="0.8 0.8 0.8"/>
"""


def write_mjcf(
    file: str,
    name: str,
    posture: Posture,
    links: dict[str, Link],
    soles: tuple[Sole, Sole],
    joints: dict[str, JointLines],
) -> str:
    """The text. The torso's frame lies midway between the hips."""
    left, right = posture.legs
    origin = (left.anchors["hip_pitch"] + right.anchors["hip_pitch"]) / 2
    ground = min(float(sole.centre[2] - sole.half[2]) for sole in soles)
    trunk = links[TRUNK]
    up = origin[2] - ground + 0.001
    lines = [
        f'<body name="{TRUNK}" pos="0 0 {up:.6g}">',
        '  <freejoint name="root"/>',
        f'  <site name="imu" pos="{_text(trunk.com - origin)}" size="0.005"/>',
        "  " + _inertial(trunk, origin),
        "  " + _box("torso_shape", trunk, origin),
    ]
    whole = sum(link.mass for link in links.values())
    for side, leg, sole in zip(SIDES, posture.legs, soles, strict=True):
        lines += ["  " + line for line in _leg(side, leg, links, sole, joints, origin, whole)]
    lines.append("</body>")
    body = "\n".join("    " + line for line in lines)
    return f"{_HEAD.format(file=file, name=name)}{body}\n  </worldbody>\n</mujoco>\n"


def _leg(
    side: str,
    leg: PosedLeg,
    links: dict[str, Link],
    sole: Sole,
    joints: dict[str, JointLines],
    parent: Floats,
    whole: float,
) -> list[str]:
    """Nested bodies from the hip to the foot; joints of a link without mass go to the next."""
    lines: list[str] = []
    waiting: list[str] = []
    roles = [joint.role for joint in leg.roled.joints]
    depth = 0
    for role in roles:
        name = f"{side}_{role}"
        link, anchor, last = links[name], leg.anchors[role], role == roles[-1]
        waiting.append(role)
        if link.mass < LEAST_MASS * whole and not last:
            continue
        pad = "  " * depth
        if np.linalg.norm(anchor - parent) > BONE * leg.length:
            lines.append(pad + _bone(f"{name}_bone", anchor - parent, leg))
        body = f"{side}_foot" if last else f"{name}_link"
        lines.append(f'{pad}<body name="{body}" pos="{_text(anchor - parent)}">')
        for held in waiting:
            lines.append(pad + "  " + _joint(joints[f"{side}_{held}"], leg, held, anchor))
        lines.append(pad + "  " + _inertial(link, anchor))
        parent, waiting, depth = anchor, [], depth + 1
    lines.append("  " * depth + _sole(side, sole, parent))
    return lines + ["  " * (depth - 1 - level) + "</body>" for level in range(depth)]


def _joint(lines: JointLines, leg: PosedLeg, role: str, origin: Floats) -> str:
    low, high = lines.range
    return (
        f'<joint name="{lines.name}" type="hinge" pos="{_text(leg.anchors[role] - origin)}" '
        f'axis="{_text(leg.axes[role])}" range="{low:.6g} {high:.6g}" '
        f'armature="{lines.armature:.4g}" frictionloss="{lines.friction:.4g}"/>'
    )


def _inertial(link: Link, origin: Floats) -> str:
    i = link.inertia
    full = (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
    return (
        f'<inertial pos="{_text(link.com - origin)}" mass="{link.mass:.8g}" '
        f'fullinertia="{" ".join(f"{value:.8g}" for value in full)}"/>'
    )


def _box(name: str, link: Link, origin: Floats) -> str:
    """A box with the link's mass and, along the world axes, its inertia."""
    x, y, z = np.diag(link.inertia) * 6.0 / link.mass
    edges = np.sqrt(np.maximum([y + z - x, x + z - y, x + y - z], 1e-8)) / 2
    return (
        f'<geom name="{name}" class="part" type="box" pos="{_text(link.com - origin)}" '
        f'size="{_text(edges)}" rgba="0.92 0.55 0.2 1"/>'
    )


def _bone(name: str, end: Floats, leg: PosedLeg) -> str:
    """From the link's own joint to the next."""
    return (
        f'<geom name="{name}" class="part" type="capsule" fromto="0 0 0 {_text(end)}" '
        f'size="{BONE * leg.length / 2:.4g}" rgba="0.55 0.58 0.62 1"/>'
    )


def _sole(side: str, sole: Sole, origin: Floats) -> str:
    return (
        f'<geom name="{side}_sole" class="sole" type="box" pos="{_text(sole.centre - origin)}" '
        f'size="{_text(sole.half)}"/>'
    )


def _text(values: Floats) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in np.round(values, 9))
