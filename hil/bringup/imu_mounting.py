"""How an IMU sits on the torso, from its accelerometer level, tilted forward and tilted left."""

from dataclasses import dataclass

import mujoco
import numpy as np

from hil.interface import Floats

LEAST_TILT = np.radians(12.0)
"""Smaller tilts do not tell a direction from the shake of a hand."""
MOST_TILT = np.radians(70.0)
MOST_SKEW = np.radians(15.0)
"""Forward and left are at right angles; hands are off by less (assumed)."""
SQUARE = np.radians(12.0)
"""A board that is this near to being square to the torso counts as square (assumed)."""


class MountingError(ValueError):
    """Tilts that no mounting explains; the message says which and why."""


@dataclass(frozen=True, slots=True)
class Mounting:
    """What was found."""

    quaternion: Floats
    """Sensor axes to base axes (w, x, y, z)."""
    yaw: float
    """Of the sensor's axes against the torso's about the vertical, as tilted [rad]."""
    skew: float
    """How far forward and left were from being at right angles [rad]."""
    tilts: tuple[float, float]
    """How far it was tilted forward and left [rad]."""


def mounting_from_tilts(level: Floats, forward: Floats, left: Floats, *, square: bool) -> Mounting:
    """The mounting from specific forces in sensor axes, (3,) each; their sizes do not matter.

    At rest the force points up. Upright, u₀ is the base's z. A torso that pitches forward by θ has
    its vertical at cos θ·z − sin θ·x in base axes, one that leans left by φ at cos φ·z − sin φ·y
    (rotation of a fixed vector into turned axes). So, seen from the sensor,

        z = u₀,   x ∝ −(u₁ − (u₁·z)z),   y ∝ −(u₂ − (u₂·z)z),

    made right-angled by halving the error between x and y. `square` turns about z to the nearest
    right angle, where that is near: a hand does not tilt more exactly than a board is screwed on.
    Raises MountingError for tilts that are too small, or not forward and left.
    """
    z, u1, u2 = (one / np.linalg.norm(one) for one in (level, forward, left))
    x, tilt1 = _tilted_away(z, u1, "forward")
    y, tilt2 = _tilted_away(z, u2, "left")
    across = float(np.dot(np.cross(z, x), y))
    skew = float(np.arctan2(np.dot(x, y), across))
    if across < 0 and abs(abs(skew) - np.pi) < MOST_SKEW:
        raise MountingError(
            "the two tilts contradict each other: one of them was to the other side; forward is "
            "with the robot's face down, left with its left side down"
        )
    if abs(skew) > MOST_SKEW:
        raise MountingError(
            f"the two tilts are {90 - np.degrees(skew):.0f}° apart and not 90°: one of them was "
            "not straight forward or not straight to the left"
        )
    x = x + np.cross(y, z)
    x /= np.linalg.norm(x)
    to_base = np.array([x, np.cross(z, x), z])
    yaw = _yaw(to_base)
    if square:
        to_base = _turn(_to_square(yaw) - yaw) @ to_base
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, to_base.ravel())
    return Mounting(quaternion, yaw, skew, (tilt1, tilt2))


def _tilted_away(up: Floats, tilted: Floats, name: str) -> tuple[Floats, float]:
    """Unit direction that went down, and how far."""
    away = -(tilted - np.dot(tilted, up) * up)
    size = float(np.linalg.norm(away))
    angle = float(np.arctan2(size, np.dot(tilted, up)))
    if not LEAST_TILT <= angle <= MOST_TILT:
        few = "little" if angle < LEAST_TILT else "much"
        raise MountingError(
            f"tilted {name} by {np.degrees(angle):.0f}°: too {few}, "
            f"{np.degrees(LEAST_TILT):.0f}° to {np.degrees(MOST_TILT):.0f}° are wanted"
        )
    return away / size, angle


def _yaw(to_base: Floats) -> float:
    """Turn about the vertical of the sensor axis that is most horizontal, against the torso."""
    flattest = int(np.argmin(np.abs(to_base[2])))
    axis = to_base[:, flattest]
    own = (0.0, np.pi / 2, 0.0)[flattest]
    yaw = float(np.arctan2(axis[1], axis[0])) - own
    return float(np.arctan2(np.sin(yaw), np.cos(yaw)))


def _to_square(yaw: float) -> float:
    """The nearest right angle; raises MountingError where none is near."""
    nearest = float(np.round(yaw / (np.pi / 2)) * np.pi / 2)
    if abs(yaw - nearest) > SQUARE:
        raise MountingError(
            f"the board sits at {np.degrees(yaw):.0f}° about the vertical, not square to the "
            "torso: tilt again, or --yaw measured if it is mounted so"
        )
    return nearest


def _turn(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
