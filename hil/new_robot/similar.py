"""minibiped as the pattern: what a robot of another mass and leg length has in its place.

Robots of one shape move alike if lengths go with L, times with √(L/g), masses with m: speeds then
have one Froude number v²/(gL), torques go with mgL. What no model file says is taken from
minibiped by these laws, and so is the gait.
"""

import math
from dataclasses import dataclass
from functools import cache

from hil.description import Joint, RobotDescription
from hil.joint_gains import kind_of
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot

PATTERN = "minibiped"
P_GAIN = 800
"""Position P Gain of its servos, register value: the factory's."""


@dataclass(frozen=True, slots=True)
class Scale:
    """Factors from minibiped to another robot."""

    length: float
    """Of lengths: leg over leg."""
    mass: float
    """Of masses."""

    @property
    def time(self) -> float:
        """Of times."""
        return math.sqrt(self.length)

    @property
    def speed(self) -> float:
        """Of speeds."""
        return self.length / self.time

    @property
    def torque(self) -> float:
        """Of torques and joint stiffness: m·g·L."""
        return self.mass * self.length

    @property
    def damping(self) -> float:
        """Of joint damping."""
        return self.torque * self.time

    @property
    def inertia(self) -> float:
        """Of moments of inertia."""
        return self.mass * self.length**2


@cache
def pattern() -> RobotDescription:
    """minibiped."""
    return load_robot(PATTERN)


def pattern_joint(role: str) -> Joint:
    """minibiped's joint of a role."""
    return next(joint for joint in pattern().joints if kind_of(joint.name) == role)


@cache
def pattern_armature() -> float:
    """Rotor inertia of minibiped's joints [kg·m²]: the middle of what its seeds draw."""
    draws = pattern().plant.draws
    low, high = draws.armature if draws and draws.armature else (0.03, 0.03)
    return (low + high) / 2


def scale_of(mass: float, leg_length: float) -> Scale:
    """The scale of a robot of a mass [kg] and a leg [m]."""
    facts = robot_facts(pattern())
    return Scale(leg_length / facts.leg_length, mass / facts.mass)
