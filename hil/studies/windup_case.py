"""One windup of the study: what it varies, and what is kept of it."""

from typing import Any

import numpy as np
from pydantic import PositiveFloat

from hil.compose.windups import Jump, Spring, WindupOutcome, wound_up
from hil.description import RobotDescription
from hil.interface import Floats
from hil.joint_gains import kind_of
from hil.robot_files import load_robot
from hil.studies.study import Case, Result

FRAME_TIME = 1.0 / 30.0
"""Between key frames [s], as animators count."""
DECIMALS = 6
"""Of the arrays that are kept for the figure: micrometres."""


class WindupCase(Case):
    """A jump, the muscles, the controller's constants and the limits of one kind of joint."""

    displacement: tuple[float, float, float]
    airtime: PositiveFloat
    push_depth: PositiveFloat
    gravity: PositiveFloat
    mass_scale: PositiveFloat = 1.0
    law: str
    stiffness_scale: PositiveFloat = 1.0
    width_scale: PositiveFloat = 1.0
    settings: dict[str, float] = {}
    """Of the controller, where it has other than its own."""
    limits: tuple[str, float] | None = None
    """Kind of joint, and by how much its range is narrowed about the start posture."""
    key_frames: bool = False
    """Keep the files for animators as well."""


def windup_of(case: WindupCase) -> Result:
    """Wind up; numbers of the table and arrays of the figure."""
    description = narrowed(load_robot(case.request.robot, case.request.overrides), case.limits)
    jump = Jump(case.displacement, case.airtime, case.push_depth, case.gravity, case.mass_scale)
    spring = Spring(case.law, case.stiffness_scale, case.width_scale)
    settings: dict[str, Any] = {
        key: int(value) if key == "iterations" else value for key, value in case.settings.items()
    }
    outcome = wound_up(description, jump, spring, FRAME_TIME, settings)
    texts = {"bvh": outcome.bvh, "csv": outcome.csv} if case.key_frames else {}
    return _numbers(description, outcome) | {"figure": _arrays(outcome)} | texts


def narrowed(description: RobotDescription, limits: tuple[str, float] | None) -> RobotDescription:
    """The robot with the range of one kind of joint times a share, always around its start."""
    if limits is None:
        return description
    kind, share = limits
    joints = tuple(
        joint.model_copy(
            update={
                "range": tuple(start + share * (end - start) for end in joint.range),
            }
        )
        if kind_of(joint.name) == kind
        else joint
        for joint, start in zip(description.joints, description.start_position, strict=True)
    )
    return description.model_copy(update={"joints": joints})


def _numbers(description: RobotDescription, outcome: WindupOutcome) -> Result:
    names = description.joint_names
    angles = np.degrees(outcome.joint_positions[-1])
    bends = {
        f"{kind}_deg": float(angles[names.index(f"left_{kind}")])
        for kind in ("hip_pitch", "knee", "ankle_pitch")
    }
    steps = np.linalg.norm(np.diff(outcome.base_positions, axis=0), axis=1)
    return {
        "converged": outcome.converged,
        "iterations": len(outcome.forces) - 1,
        "blocked_by": " ".join(outcome.blocked_by),
        "stiffness_n_per_m": outcome.stiffness,
        "width_m": outcome.width,
        "push_stiffness_n_per_m": outcome.push_stiffness,
        "wanted_force_n": outcome.wanted_force,
        "force_n": float(outcome.forces[-1]),
        "force_overshoot": float(outcome.forces.max() / outcome.wanted_force - 1.0),
        "balance_error_m": float(np.linalg.norm(outcome.balance_errors[-1])),
        "least_margin_m": outcome.least_margin,
        "depth_m": outcome.depth,
        "largest_step_m": float(steps.max()) if len(steps) else 0.0,
        "knee_torque_nm": outcome.knee_torque,
        **bends,
    }


def _arrays(outcome: WindupOutcome) -> dict[str, Any]:
    arrays: dict[str, Floats] = {
        "base_positions": outcome.base_positions,
        "base_orientations": outcome.base_orientations,
        "joint_positions": outcome.joint_positions,
        "coms": outcome.coms,
        "errors": outcome.errors,
        "support": outcome.support,
        "planned": outcome.planned,
        "planned_force": outcome.planned_force,
    }
    return {name: np.round(array, DECIMALS).tolist() for name, array in arrays.items()}
