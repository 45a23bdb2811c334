"""Windups of a jump for those who know no controller: postures and numbers as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from controller.jumping.bvh import bvh_text
from controller.jumping.key_frames import key_frames_csv
from controller.jumping.muscle_laws import LAWS
from controller.jumping.muscles import Muscles
from controller.jumping.path import JumpPath, JumpTarget, estimate_path
from controller.jumping.posture import standing, with_soft_knees
from controller.jumping.skeleton import Skeleton
from controller.jumping.windup import Windup, WindupSettings, wind_up
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import UnknownNameError
from hil.interface import Floats

PATH_POINTS = 41


@dataclass(frozen=True, slots=True)
class Jump:
    """What is to be jumped, and by whom."""

    displacement: tuple[float, float, float]
    airtime: float
    push_depth: float
    gravity: float
    mass_scale: float = 1.0
    """How many times its own mass the character has, its muscles as they were."""


@dataclass(frozen=True, slots=True)
class Spring:
    """The muscles: the law and how many times the robot's own stiffness and width."""

    law: str
    stiffness_scale: float = 1.0
    width_scale: float = 1.0


@dataclass(frozen=True, slots=True)
class WindupOutcome:
    """A windup as arrays; k iterates of n joints, the first where it began."""

    converged: bool
    blocked_by: tuple[str, ...]
    wanted_force: float
    """[N]"""
    stiffness: float
    """[N/m]"""
    width: float
    """[m]"""
    push_stiffness: float
    """k with which the windup would be as deep as the push, from straight legs [N/m]."""
    knee_torque: float
    """r·F of one knee at the last force [N·m]."""
    base_positions: Floats
    """[m], shape (k, 3)."""
    base_orientations: Floats
    """(w, x, y, z), shape (k, 4)."""
    joint_positions: Floats
    """[rad], shape (k, n)."""
    coms: Floats
    """[m], shape (k, 3)."""
    forces: Floats
    """[N], shape (k,)."""
    errors: Floats
    """|E_all| [m], shape (k,)."""
    balance_errors: Floats
    """[m], shape (k, 2)."""
    least_margin: float
    """Closest that the centre of mass came to the edge of the support [m]."""
    depth: float
    """How far the centre of mass went down [m]."""
    support: Floats
    """Vertices of the supporting polygon [m], shape (v, 2)."""
    planned: Floats
    """Centre of mass from the crouch to the landing [m], shape (p, 3)."""
    planned_force: Floats
    """What the ground shall push with [N], shape (3,)."""
    push_time: float
    """[s]"""
    bvh: str
    csv: str


def wound_up(
    description: RobotDescription,
    jump: Jump,
    spring: Spring,
    frame_time: float,
    settings: Mapping[str, Any],
) -> WindupOutcome:
    """Wind up for a jump from the robot's start posture; key frames `frame_time` [s] apart.

    `settings` are those of `WindupSettings`. Raises InputError for what cannot be wound up.
    """
    if spring.law not in LAWS:
        raise UnknownNameError("muscle law", spring.law, LAWS)
    robot = RobotModel(description)
    plain = Muscles.of(robot, description, LAWS[spring.law])
    stiffness = spring.stiffness_scale * plain.stiffness
    width = spring.width_scale * plain.width
    muscles = Muscles.of(robot, description, LAWS[spring.law], stiffness, width)
    target = JumpTarget(jump.displacement, jump.airtime, jump.push_depth, jump.gravity)
    joints = with_soft_knees(robot, description, np.array(description.start_position))
    start = standing(robot, joints)
    mass = jump.mass_scale * robot.mass
    force = float(np.linalg.norm(estimate_path(target, mass).force))
    found = wind_up(robot, description, start, force, muscles, WindupSettings(**settings))
    path = estimate_path(target, mass, start=found.com)
    deep = muscles.matched(force, muscles.bend_at(robot.leg_length - jump.push_depth))
    return _outcome(robot, description, found, muscles, deep.stiffness, path, frame_time)


def _outcome(
    robot: RobotModel,
    description: RobotDescription,
    found: Windup,
    muscles: Muscles,
    push_stiffness: float,
    path: JumpPath,
    frame_time: float,
) -> WindupOutcome:
    frames = found.frames
    postures = [frame.posture for frame in frames]
    return WindupOutcome(
        converged=found.converged,
        blocked_by=found.blocked_by,
        wanted_force=found.wanted_force,
        stiffness=muscles.stiffness,
        width=muscles.width,
        push_stiffness=push_stiffness,
        knee_torque=muscles.torque(frames[-1].force),
        base_positions=np.array([posture.base_position for posture in postures]),
        base_orientations=np.array([posture.base_orientation for posture in postures]),
        joint_positions=np.array([posture.joint_position for posture in postures]),
        coms=np.array([frame.com for frame in frames]),
        forces=np.array([frame.force for frame in frames]),
        errors=np.array([np.linalg.norm(frame.error) for frame in frames]),
        balance_errors=np.array([frame.balance_error for frame in frames]),
        least_margin=found.least_margin,
        depth=found.depth,
        support=found.support.vertices,
        planned=path.position(np.linspace(0.0, path.duration, PATH_POINTS)),
        planned_force=path.force,
        push_time=path.push_time,
        bvh=bvh_text(Skeleton(robot), postures, frame_time),
        csv=key_frames_csv(frames, description.joint_names, frame_time),
    )
