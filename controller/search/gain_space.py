"""The variables of the gain study: stiffness and damping of each kind of joint.

A vector of the search holds gains divided by those of the start, two for each kind of joint: the
normalisation keeps the search from favouring joints with large gains (seed 000_bd1305a0ae731442,
section 4.2).
"""

from collections.abc import Sequence

from controller.walking.torque_config import torque_walking_config
from hil.description import Joint, RobotDescription
from hil.joint_gains import GainSet, kind_of


def gains_at(description: RobotDescription, rate_hz: int, implicit: bool) -> GainSet:
    """The set with which a robot walks at a control rate [Hz], by kind of joint.

    Of a servo robot: the stiffness and damping that its servos are asked for.
    Raises DescriptionError for a walking section that does not fit.
    """
    if description.actuation == "servo":
        joints = description.at_rate(rate_hz).joints
        return {kind_of(joint.name): (joint.stiffness, joint.damping) for joint in joints}
    config = torque_walking_config(description)
    return dict(config.gains_at(rate_hz, implicit))


def with_gains(description: RobotDescription, rate_hz: int, gains: GainSet) -> RobotDescription:
    """The robot with these gains in place of its own, at a control rate [Hz]."""
    if description.actuation == "servo":
        joints = tuple(_driven(joint, gains) for joint in description.joints)
        return description.model_copy(update={"joints": joints, "gains": {}})
    only = {
        "gains": {rate_hz: gains},
        "gain_rate": rate_hz,
        "explicit_gain_rates": (rate_hz,),
        "implicit_gain_rate": rate_hz,
    }
    return description.model_copy(update={"walking": description.walking | only})


def variable_names(joints: Sequence[str]) -> tuple[str, ...]:
    """Names of a vector's entries: `knee.kp`, `knee.kd`, and so on."""
    return tuple(f"{joint}.{gain}" for joint in joints for gain in ("kp", "kd"))


def scaled(start: GainSet, joints: Sequence[str], vector: Sequence[float]) -> GainSet:
    """`start` times the factors of a vector, two for each of `joints`; others keep theirs."""
    factors = iter(vector)
    found = dict(start)
    for joint in joints:
        stiffness, damping = start[joint]
        found[joint] = (stiffness * next(factors), damping * next(factors))
    return found


def blended(first: GainSet, second: GainSet, share: float) -> GainSet:
    """(1 − share)·first + share·second, gain by gain."""
    return {
        joint: (
            (1.0 - share) * first[joint][0] + share * second[joint][0],
            (1.0 - share) * first[joint][1] + share * second[joint][1],
        )
        for joint in first
    }


def _driven(joint: Joint, gains: GainSet) -> Joint:
    stiffness, damping = gains[kind_of(joint.name)]
    return joint.model_copy(update={"stiffness": stiffness, "damping": damping})
