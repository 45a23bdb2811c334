"""Limits and gains of every leg joint: the model's where it has them, else minibiped's, scaled."""

from dataclasses import dataclass

import numpy as np

from hil.interface import SIDES
from hil.new_robot.posture import Posture
from hil.new_robot.roles import LEG_JOINTS
from hil.new_robot.similar import Scale, pattern_armature, pattern_joint
from hil.new_robot.source import Source

TURN = 3.1
"""Widest angle that a servo's single turn surely covers [rad]."""

HOST_DAMPING = 1.95
"""Most damping, as a multiple of the motor's own: the driver's bound is 2."""


@dataclass(frozen=True, slots=True)
class Drive:
    """What moves the joints: the model's own limits, minibiped's scaled, or one servo model."""

    similar: bool = False
    """minibiped's torque, speed and rotor, scaled, whatever the model has."""
    servo: str | None = None
    """Dynamixel model of every joint."""
    torque: float | None = None
    """Its stall torque [N·m]."""
    speed: float | None = None
    """Its speed without load [rad/s]."""
    stiffness: float | None = None
    """[N·m/rad] at its factory gain."""
    voltage: float | None = None
    """At which these hold [V]."""

    @property
    def own(self) -> bool:
        """Whether the model's limits do not count."""
        return self.similar or self.servo is not None


@dataclass(frozen=True, slots=True)
class JointLines:
    """Everything that the files say about one joint."""

    name: str
    source: str
    """Name in the model that was read."""
    sign: int
    """Of the model's angle against ours."""
    offset: float
    """Of the model's angle, with that sign, where ours is 0 [rad]."""
    range: tuple[float, float]
    """[rad]"""
    torque_limit: float
    """[N·m]"""
    velocity_limit: float
    """[rad/s]"""
    stiffness: float
    """[N·m/rad]"""
    damping: float
    """[N·m·s/rad]: the motor's own, or up to twice that where similarity asks for more."""
    armature: float
    """[kg·m²]"""
    friction: float
    """[N·m]"""
    assumed: tuple[str, ...]
    """Keys that the model does not have."""


def joint_lines(
    source: Source, posture: Posture, scale: Scale, drive: Drive
) -> tuple[JointLines, ...]:
    """Both legs, left first, each from the hip down. Torque, speed and gains are
    the drive's where it has its own.
    """
    return tuple(
        _joint(source, posture, side, index, role, scale, drive)
        for index, side in enumerate(SIDES)
        for role in LEG_JOINTS
    )


def _joint(
    source: Source,
    posture: Posture,
    side: str,
    index: int,
    role: str,
    scale: Scale,
    drive: Drive,
) -> JointLines:
    model, leg, like = source.model, posture.legs[index], pattern_joint(role)
    joint = leg.roled.by_role(role)
    name, dof = model.joint(joint.joint).name, int(model.jnt_dofadr[joint.joint])
    assumed = []
    limits = like.range
    if model.jnt_limited[joint.joint]:
        ends = joint.sign * np.asarray(model.jnt_range[joint.joint]) - leg.offsets[role]
        limits = (max(float(ends.min()), -TURN), min(float(ends.max()), TURN))
    else:
        assumed.append("range")
    torque = drive.torque if drive.own else _torque_limit(source, joint.joint)
    if torque is None:
        torque = like.torque_limit * scale.torque
        assumed.append("torque_limit")
    speed = drive.speed if drive.own else source.speed_limits.get(name)
    if speed is None:
        speed = like.velocity_limit / scale.time
        assumed.append("velocity_limit")
    armature = 0.0 if drive.similar else float(model.dof_armature[dof])
    if armature <= 0.0:
        # As minibiped's motors start: rotor inertia over own damping goes with the time scale.
        armature = pattern_armature() / like.damping * torque / speed * scale.time
        assumed.append("armature")
    return JointLines(
        f"{side}_{role}", name, joint.sign, leg.offsets[role], limits, torque, speed,
        drive.stiffness or like.stiffness * scale.torque,
        torque / speed if drive.servo else _damping(torque / speed, like.damping * scale.damping),
        armature, float(model.dof_frictionloss[dof]), tuple(assumed),
    )  # fmt: skip


def _damping(own: float, similar: float) -> float:
    """What the host adds to a motor's own damping is bounded (`drivers` allow twice the own)."""
    return min(max(own, similar), HOST_DAMPING * own)


def _torque_limit(source: Source, joint: int) -> float | None:
    """From the joint's own force range, or that of the actuator that drives it."""
    model = source.model
    ends = []
    if model.jnt_actfrclimited[joint]:
        ends.append(np.abs(model.jnt_actfrcrange[joint]).max())
    for actuator in range(model.nu):
        if model.actuator_trnid[actuator, 0] != joint:
            continue
        gear = abs(model.actuator_gear[actuator, 0])
        if model.actuator_forcelimited[actuator]:
            ends.append(gear * np.abs(model.actuator_forcerange[actuator]).max())
        elif model.actuator_ctrllimited[actuator] and not model.actuator_biastype[actuator]:
            gain = abs(model.actuator_gainprm[actuator, 0])
            ends.append(gear * gain * np.abs(model.actuator_ctrlrange[actuator]).max())
    found = [float(end) for end in ends if end > 0.0]
    return min(found) if found else None
