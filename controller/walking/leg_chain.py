"""Inverse kinematics of a six-joint leg whose axes need not meet, nor come in minibiped's order."""

from collections.abc import Sequence
from itertools import pairwise
from math import asin, atan2, copysign, cos, sin

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.leg_kinematics import LegGeometry, Rows, Vector
from controller.walking.rotations import about_axis
from hil.interface import SIDES

ORDER = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
"""Of the angles that `solve` returns."""
_AXES = {"roll": 0, "pitch": 1, "yaw": 2}
ROUNDS = 8
"""Most corrections of the closed form: each leaves a tenth to a third of the error before it."""
ONE: Rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NOWHERE: Vector = (0.0, 0.0, 0.0)
ENOUGH = 1e-7
"""Error of the ankle point [m] and of the foot's rotation at which there is no more to correct:
accelerations are second differences over 4 ms."""
EXACT = 1e-5
"""Points [m] and axes that differ by less from the closed form's are the same."""


class LegChain:
    """The closed form of `LegGeometry`, corrected until the real chain of the leg gets there.

    With f the chain from hip to foot, g the closed form as if all axes met, and t the target
    (ankle point p, foot rotation R): t₀ = t, q_k = g(t_k), p_{k+1} = p_k + (p − f_p(q_k)),
    R_{k+1} = R·f_R(q_k)ᵀ·R_k. It converges while g is nearly the inverse of f, that is for axes
    that pass each other by a fraction of the leg and are tilted by some 10 degrees. Knee and ankle
    come from g; its hip rotation is split into the angles of this leg's own order of hip joints.
    """

    def __init__(self, model: RobotModel, leg: int) -> None:
        """`leg`: 0 left, 1 right."""
        self._closed = LegGeometry.of(model)
        side = SIDES[leg]
        mujoco_model = model.model
        ids = [mujoco_model.joint(f"{side}_{name}").id for name in ORDER]
        chain = sorted(range(len(ORDER)), key=lambda place: ids[place])
        self._places = chain
        model.place_at_zero()
        anchors, axes = model.data.xanchor[ids].copy(), model.data.xaxis[ids].copy()
        centre = anchors[ORDER.index("hip_pitch")]
        ankle = model.ankles[leg]
        points = [centre, *(anchors[place] for place in chain), ankle]
        self._steps: list[Vector] = [tuple((b - a).tolist()) for a, b in pairwise(points)]
        self._axes: list[list[float]] = axes[chain].tolist()
        hips = [ORDER[place].removeprefix("hip_") for place in chain[:3]]
        self._hip_axes = [_AXES[name] for name in hips]
        self._hip_places = [ORDER.index(f"hip_{name}") for name in hips]
        wanted = np.eye(3)[[2, 0, 1, 1, 1, 0]]
        self.exact: bool = (
            chain == list(range(len(ORDER)))
            and np.abs(axes - wanted).max() < EXACT
            and np.abs(anchors[:3] - centre).max() < EXACT
            and np.abs(anchors[4:] - ankle).max() < EXACT
            and abs(float(model.knee_offset)) < EXACT
        )
        """Whether the closed form alone is right."""
        self._moved: Vector = NOWHERE
        self._twisted: Rows = ONE

    def forward(self, angles: Sequence[float]) -> tuple[Vector, Rows]:
        """Ankle point from the hip centre [m] and foot rotation, in base axes."""
        (x, y, z), rows = self._steps[0], ONE
        for place, axis, step in zip(self._places, self._axes, self._steps[1:], strict=True):
            rows = product(rows, about_axis(axis, angles[place]))
            if step != NOWHERE:
                dx, dy, dz = turned(rows, step)
                x, y, z = x + dx, y + dy, z + dz
        return (x, y, z), rows

    def solve(self, ankle: Sequence[float], foot: Rows) -> list[float]:
        """The six joint angles [rad], as `LegGeometry.solve`.

        It begins with the corrections of its last call: a leg moves little from tick to tick. Out
        of reach they would only grow, so those that do not help are forgotten.
        """
        first = 0.0
        for _ in range(ROUNDS):
            (mx, my, mz), twist = self._moved, self._twisted
            point = (ankle[0] + mx, ankle[1] + my, ankle[2] + mz)
            angles = self._guess(point, product(foot, twist))
            (x, y, z), facing = self.forward(angles)
            ex, ey, ez = ankle[0] - x, ankle[1] - y, ankle[2] - z
            left = product(transposed(facing), foot)
            error = max(abs(ex), abs(ey), abs(ez), *_off_diagonal(left))
            if error < ENOUGH:
                break
            first = first or error
            self._moved = (mx + ex, my + ey, mz + ez)
            self._twisted = product(left, twist)
        else:
            if error > 0.5 * first:
                self._moved, self._twisted = NOWHERE, ONE
        return angles

    def _guess(self, point: Vector, foot: Rows) -> list[float]:
        angles = self._closed.solve(point, foot)
        if self._hip_places == [0, 1, 2]:
            return angles
        knee, pitch, roll = angles[3:]
        thigh = product(foot, product(about(0, -roll), about(1, -(knee + pitch))))
        for place, angle in zip(self._hip_places, split(thigh, *self._hip_axes), strict=True):
            angles[place] = angle
        return angles


def split(rotation: Rows, i: int, j: int, k: int) -> tuple[float, float, float]:
    """Angles a, b, c of R_i(a)·R_j(b)·R_k(c) = `rotation`, i, j, k all different axes [rad].

    With ε the sign of the permutation: sin b = ε·R_ik, tan a = −ε·R_jk/R_kk, tan c = −ε·R_ij/R_ii.
    """
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    sine = sign * rotation[i][k]
    b = asin(sine if -1.0 <= sine <= 1.0 else copysign(1.0, sine))
    a = atan2(-sign * rotation[j][k], rotation[k][k])
    c = atan2(-sign * rotation[i][j], rotation[i][i])
    return a, b, c


def about(axis: int, angle: float) -> Rows:
    """Rotation about x or y [rad]."""
    c, s = cos(angle), sin(angle)
    if axis == 0:
        return (1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)
    return (c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)


def product(first: Rows, second: Rows) -> Rows:
    """Two rotations, one after the other: plain numbers are six times faster than small arrays."""
    (a, b, c), (d, e, f), (g, h, i) = second
    return tuple(
        (x * a + y * d + z * g, x * b + y * e + z * h, x * c + y * f + z * i) for x, y, z in first
    )


def turned(rows: Rows, vector: Vector) -> Vector:
    """A vector turned by a rotation."""
    (a, b, c), (d, e, f), (g, h, i) = rows
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def transposed(rows: Rows) -> Rows:
    """The inverse of a rotation."""
    return tuple(zip(*rows, strict=True))


def _off_diagonal(rows: Rows) -> tuple[float, float, float]:
    """Size of a small rotation: its three angles, without their signs [rad]."""
    (_, a, b), (_, _, c), _ = rows
    return abs(a), abs(b), abs(c)
