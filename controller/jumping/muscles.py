"""The muscles of a robot's legs: a spring across every knee, and what they push with together."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from controller.jumping.muscle_laws import MuscleLaw
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import SIDES, Floats

WIDTH = 0.05
"""Distance of the attachments from the joint, as a share of the leg, where none is given."""
STRAIGHT = 1e-3
"""Bends below are no basis for a slope over the leg's length [rad]."""


@dataclass(frozen=True, slots=True)
class Muscles:
    """The knees' extensors, two equal springs; the legs' force is the sum of theirs.

    A leg of thigh a and shank b, bent by θ, reaches from hip to ankle over
    d² = a² + b² + 2ab·cos θ; the force therefore changes with the drop of the hip by
    dF/dd = F'(θ)·d/(ab·sin θ), which makes metres of hip travel of newtons of force error.
    """

    law: MuscleLaw
    stiffness: float
    """k [N/m]"""
    width: float
    """r [m]"""
    joints: tuple[int, ...]
    """Knees, indices in description order."""
    straight: float
    """Knee angle at which thigh and shank lie on one line [rad]."""
    bones: tuple[float, float]
    """Lengths a and b of thigh and shank [m]."""

    @classmethod
    def of(
        cls,
        robot: RobotModel,
        description: RobotDescription,
        law: MuscleLaw,
        stiffness: float | None = None,
        width: float | None = None,
    ) -> Self:
        """Muscles that fit a robot: r a twentieth of its leg, k by `law.strength`.

        Raises InputError for a stiffness or width that is not above 0.
        """
        joints = tuple(description.joint_names.index(f"{side}_knee") for side in SIDES)
        width = WIDTH * robot.leg_length if width is None else width
        if width <= 0.0 or (stiffness is not None and stiffness <= 0.0):
            raise InputError(f"muscle: k and r must be above 0 (got {stiffness}, {width})")
        stiffness = law.strength * robot.weight / (2 * width) if stiffness is None else stiffness
        bones = (robot.thigh_length, robot.shank_length)
        return cls(law, stiffness, width, joints, robot.knee_offset, bones)

    def matched(self, force: float, bend: float) -> Self:
        """The same muscles, stiff enough for a force of the legs [N] at a bend [rad]."""
        unit = len(self.joints) * self.law.force(bend, 1.0, self.width)
        return type(self)(
            self.law, force / unit, self.width, self.joints, self.straight, self.bones
        )

    def force(self, joint_position: Floats) -> float:
        """What the legs push with at joint angles [rad], shape (n,): sum of the muscles [N]."""
        bends = np.abs(joint_position[list(self.joints)] - self.straight)
        return sum(self.law.force(bend, self.stiffness, self.width) for bend in bends.tolist())

    def bend(self, force: float) -> float:
        """Bend of both knees at a force of the legs [N]; raises InputError where there is none."""
        return self.law.bend(force / len(self.joints), self.stiffness, self.width)

    def torque(self, force: float) -> float:
        """Torque of one knee at a force of the legs [N·m]: r·F, the seed's simplified arm."""
        return self.width * force / len(self.joints)

    def reach(self, bend: float) -> float:
        """Distance of hip and ankle at a bend [m]."""
        a, b = self.bones
        return math.sqrt(a * a + b * b + 2.0 * a * b * math.cos(bend))

    def bend_at(self, reach: float) -> float:
        """Bend at a distance of hip and ankle [m]; raises InputError where no knee bends so."""
        a, b = self.bones
        cosine = (reach * reach - a * a - b * b) / (2.0 * a * b)
        if not -1.0 <= cosine <= 1.0:
            raise InputError(f"no knee makes a leg of {a + b:.3f} m {reach:.3f} m long")
        return math.acos(cosine)

    def stiffening(self, bend: float) -> float:
        """Rise of the legs' force with the drop of the hip, at a bend [N/m]."""
        bend = max(bend, STRAIGHT)
        a, b = self.bones
        slope = len(self.joints) * self.law.slope(bend, self.stiffness, self.width)
        return slope * self.reach(bend) / (a * b * math.sin(bend))
