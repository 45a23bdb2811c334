"""How far a robot may be steered while it walks."""

from dataclasses import dataclass

from hil.description import RobotDescription
from hil.robot_facts import robot_facts

FORWARD, BACKWARD, SIDEWAYS = 0.25, 0.06, 0.08
"""Largest speeds in √(gL): inside what both shipped robots walk (docs/studies.md); assumed for any
other."""
PUSH_SHARE = 0.5
"""Largest push, in body weights."""
PUSH_TIME_S = 1.0


@dataclass(frozen=True, slots=True)
class SteerLimits:
    """Bounds of what may be asked for; a command line may ask for more."""

    forward: float
    """[m/s]"""
    backward: float
    """[m/s], negative."""
    sideways: float
    """[m/s], either way."""
    push: float
    """[N] on each axis."""

    def speed(self, value: float) -> float:
        """A sagittal speed inside the bounds [m/s]."""
        return max(self.backward, min(value, self.forward))

    def lateral(self, value: float) -> float:
        """A coronal speed inside the bounds [m/s]."""
        return max(-self.sideways, min(value, self.sideways))

    def force(self, value: float) -> float:
        """One component of a push inside the bounds [N]."""
        return max(-self.push, min(value, self.push))


def steer_limits(description: RobotDescription) -> SteerLimits:
    """The limits of a robot, by its leg length and weight. Raises DescriptionError."""
    facts = robot_facts(description)
    scale = facts.speed_scale
    forward = max(FORWARD * scale, description.defaults.speed)
    return SteerLimits(forward, -BACKWARD * scale, SIDEWAYS * scale, PUSH_SHARE * facts.weight)
