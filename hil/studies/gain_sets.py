"""Gain sets of a robot as studies handle them: where they are stored, and their sum."""

from collections.abc import Mapping

from hil.compose.optimisations import gain_space
from hil.description import RobotDescription
from hil.interface import SIDES
from hil.joint_gains import GainSet


def stored_sets(description: RobotDescription) -> dict[int, GainSet]:
    """The sets of a robot file by rate [Hz], the lowest first; of a servo robot all joints.

    Joints of a torque robot are its joint groups (`hip` for three hinges) and the `root`.
    """
    if description.actuation == "torque":
        found = description.walking["gains"]
        return {
            int(rate): {joint: (float(kp), float(kd)) for joint, (kp, kd) in found[rate].items()}
            for rate in sorted(found)
        }
    rates = sorted(description.gains) or [description.defaults.rate_hz]
    return {rate: gain_space.gains_at(description, rate, implicit=False) for rate in rates}


def gain_overrides(description: RobotDescription, rate: int, gains: GainSet) -> tuple[str, ...]:
    """`--set` changes that give the robot's stored set of a rate these gains, and choose it."""
    torque = description.actuation == "torque"
    section = "walking.gains" if torque else "gains"
    changes = tuple(
        f"{section}.{rate}.{joint}=[{kp!r}, {kd!r}]" for joint, (kp, kd) in gains.items()
    )
    return (*changes, f"walking.gain_rate={rate}") if torque else changes


def scaled(gains: GainSet, factors: Mapping[str, float]) -> GainSet:
    """Gains times the factors of their joints; joints not named stay."""
    return {
        joint: (factors.get(joint, 1.0) * kp, factors.get(joint, 1.0) * kd)
        for joint, (kp, kd) in gains.items()
    }


def sum_of(pair: tuple[float, float]) -> float:
    """Kp + 10·Kd of a joint: seed 000_bd1305a0ae731442, Figs. 2 and 3."""
    return pair[0] + 10.0 * pair[1]


def total_of(description: RobotDescription, gains: Mapping[str, tuple[float, float]]) -> float:
    """ΣKp + 10·ΣKd over all joints, left and right counted."""
    return sum(sides_of(description, joint) * sum_of(pair) for joint, pair in gains.items())


def sides_of(description: RobotDescription, joint: str) -> int:
    """2 for a joint that the robot has on both sides, else 1."""
    paired = any(name.startswith(f"{SIDES[0]}_{joint}") for name in description.joint_names)
    return 2 if paired else 1
