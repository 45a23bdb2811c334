"""Postures as a BVH file, which Blender and other animation programs open.

Biovision hierarchy: y is up, so that file axes (X, Y, Z) are ours (y, z, x); metres and degrees.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from controller.jumping.posture import Posture
from controller.jumping.skeleton import Skeleton
from hil.interface import Floats

TO_FILE = [1, 2, 0]
"""Our component that is the file's X, Y, Z."""
TURNS = "Zrotation Xrotation Yrotation"


def bvh_text(skeleton: Skeleton, postures: Sequence[Posture], frame_time: float) -> str:
    """The file's text: hierarchy, then one line a posture, `frame_time` [s] apart."""
    lines = ["HIERARCHY", *_bone_lines(skeleton, 0, 0), "MOTION"]
    lines += [f"Frames: {len(postures)}", f"Frame Time: {frame_time:.6f}"]
    order = list(_depth_first(skeleton, 0))
    for posture in postures:
        rotations = skeleton.rotations(posture)
        numbers = list(posture.base_position[TO_FILE])
        for bone in order:
            numbers += _zxy_degrees(rotations[bone][np.ix_(TO_FILE, TO_FILE)])
        lines.append(" ".join(f"{number:.6f}" for number in numbers))
    return "\n".join(lines) + "\n"


def _bone_lines(skeleton: Skeleton, bone: int, depth: int) -> Iterator[str]:
    this, pad = skeleton.bones[bone], "  " * depth
    root = this.parent < 0
    offset = this.anchor - (0.0 if root else skeleton.bones[this.parent].anchor)
    yield f"{pad}{'ROOT' if root else 'JOINT'} {this.name}"
    yield f"{pad}{{"
    yield f"{pad}  OFFSET {_spaced(offset)}"
    places = "6 Xposition Yposition Zposition" if root else "3"
    yield f"{pad}  CHANNELS {places} {TURNS}"
    children = skeleton.children(bone)
    for child in children:
        yield from _bone_lines(skeleton, child, depth + 1)
    if not children:
        yield f"{pad}  End Site"
        yield f"{pad}  {{"
        yield f"{pad}    OFFSET {_spaced(this.end - this.anchor)}"
        yield f"{pad}  }}"
    yield f"{pad}}}"


def _depth_first(skeleton: Skeleton, bone: int) -> Iterator[int]:
    yield bone
    for child in skeleton.children(bone):
        yield from _depth_first(skeleton, child)


def _spaced(offset: Floats) -> str:
    return " ".join(f"{number:.6f}" for number in offset[TO_FILE])


def _zxy_degrees(rotation: Floats) -> list[float]:
    """Angles of R_z·R_x·R_y [°]; x = asin R₃₂ within ±90°."""
    r = rotation
    x = math.asin(max(-1.0, min(1.0, r[2, 1])))
    z = math.atan2(-r[0, 1], r[1, 1])
    y = math.atan2(-r[2, 0], r[2, 2])
    return [math.degrees(angle) for angle in (z, x, y)]
