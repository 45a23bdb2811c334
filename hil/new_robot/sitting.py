"""A pose to rest in: knees as deep as they go, the torso leant until it is over the feet."""

import mujoco
import numpy as np

from hil.interface import SIDES
from hil.new_robot.joints import JointLines

DEEPEST, SHALLOWEST = 2.1, 1.0
"""Knee angles that are tried, minibiped's first [rad]."""
LEAN = 0.9
"""Most that the torso leans, forward or back [rad]."""
TRIES = 121


def sitting(mjcf: str, joints: dict[str, JointLines]) -> dict[str, float] | None:
    """Angles of hip pitch, knee and ankle pitch [rad], by role, with which the centre of mass is
    over the middle of the soles; None where no bend of the knees has any within the ranges.
    """
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    for knee in np.arange(DEEPEST, SHALLOWEST, -0.1).tolist():
        ankle = _within(-knee / 2, joints["left_ankle_pitch"])
        low, high = joints["left_knee"].range
        if not low <= knee <= high:
            continue
        upright = -(knee + ankle)
        low, high = joints["left_hip_pitch"].range
        hips = np.linspace(max(upright - LEAN, low), min(upright + LEAN, high), TRIES)
        ahead = [_ahead(model, data, hip, knee, ankle) for hip in hips.tolist()]
        if min(ahead) < 0.0 < max(ahead):
            hip = float(hips[np.abs(ahead).argmin()])
            return {"hip_pitch": hip, "knee": knee, "ankle_pitch": ankle}
    return None


def _within(angle: float, joint: JointLines) -> float:
    return min(max(angle, joint.range[0]), joint.range[1])


def _ahead(
    model: mujoco.MjModel, data: mujoco.MjData, hip: float, knee: float, ankle: float
) -> float:
    """How far the centre of mass is ahead of the soles' middle, on level soles [m]."""
    data.qpos[:] = model.qpos0
    for side in SIDES:
        for role, angle in (("hip_pitch", hip), ("knee", knee), ("ankle_pitch", ankle)):
            data.qpos[model.joint(f"{side}_{role}").qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    foot = data.body("left_foot").xmat.reshape(3, 3)
    away = data.subtree_com[0] - data.geom("left_sole").xpos
    return float(foot[:, 0] @ away)
