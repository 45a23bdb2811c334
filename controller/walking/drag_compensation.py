"""Compensation of drag on the swing leg: sideways all of it, ahead what exceeds that of water.

Ours. Seed 003_73fecd8ec8927aad, section 5.3, leaves drag out of its force-field compensation,
because it would take many small forces. Strips of the swing leg alone are few.
"""

import math

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.drag_strips import strips
from controller.walking.joint_groups import JointGroups
from controller.walking.liquid import Liquid
from hil.interface import Floats

STRIPS_A_LEG = 12
"""Strips along a leg."""


SIDEWAYS = 0.033
"""Coronal speed from which on all of the drag across is carried, in √(gL)."""


class DragCompensation:
    """τ_j = −Σ (p_k − p_j) × F_k over the strips k of the swing leg beyond its joint j.

    F_k = −½ρμ·C_d·w_k·√Σ(A_i·u_i)²·v with C_d = 1: the strip's centre p_k moves at v, which is u
    in its geom's axes, and shows the areas A_i; w_k is the share of its height under the level
    that the robot is told to expect. Along the walk ρμ is that of the liquid less that of water,
    which leaves the leg with water's drag, for which the poses are made. Across it is all of ρμ in
    a walk that goes sideways: no pose and no lead accounts for a foot that lags there.
    """

    def __init__(self, robot: RobotModel, groups: JointGroups) -> None:
        model, data = robot.model, robot.data
        self._anchors: Floats = data.xanchor
        self._joints = groups.anchor_joint
        self._places, self._axes, self._motion = data.geom_xpos, data.geom_xmat, data.cvel
        self._com: Floats = data.subtree_com[model.body_rootid[robot.root_body]]
        length = robot.leg_length / STRIPS_A_LEG
        self._sideways = SIDEWAYS * math.sqrt(robot.gravity * robot.leg_length)
        self._half = 0.5 * length
        moved = groups.moves(model.geom_bodyid)
        descends = groups.descends()
        self._legs = []
        for hip in groups.legs("hip"):
            geoms = np.flatnonzero(moved[:, hip])
            cut = [strips(model, int(geom), length) for geom in geoms]
            of = np.repeat(geoms, [len(points) for points, _ in cut])
            beyond = moved[of].T & descends[:, hip, None]
            points, areas = (np.concatenate(parts) for parts in zip(*cut, strict=True))
            self._legs.append((of, model.geom_bodyid[of], points, areas, beyond.astype(float)))

    def torques(self, swing: int, liquid: Liquid, across: Floats, speed: float) -> Floats:
        """World torque vectors [N·m], shape (groups, 3); zero but on the swing leg.

        `liquid` is what the robot expects, `across` the coronal direction, (3,), and `speed` what
        the robot is told to go that way [m/s].
        """
        geoms, bodies, points, areas, beyond = self._legs[swing]
        axes = self._axes.take(geoms, axis=0).reshape(-1, 3, 3)
        places = self._places.take(geoms, axis=0) + np.matvec(axes, points)
        motion = self._motion.take(bodies, axis=0)
        velocity = motion[:, 3:] + np.cross(motion[:, :3], places - self._com)
        shown = areas * np.vecmat(velocity, axes)
        wet = np.clip((liquid.level - places[:, 2]) / (2.0 * self._half) + 0.5, 0.0, 1.0)
        factor = 0.5 * wet * np.sqrt(np.vecdot(shown, shown))
        share = min(abs(speed) / self._sideways, 1.0)
        sideways = share * (liquid.thickness - liquid.excess) * (velocity @ across)
        against = factor[:, None] * (liquid.excess * velocity + np.outer(sideways, across))
        moment = beyond @ np.cross(places, against)
        moment -= np.cross(self._anchors[self._joints], beyond @ against)
        result: Floats = moment
        return result
