"""The torques of one tick: every component's share, in the order of the seed's controller.

Seed 000_bd1305a0ae731442, section 3: pose tracking, root balance at the hips, gravity
compensation, virtual force, then the ankle limit and, where asked for, implicit PD.
"""

from typing import Literal

import numpy as np

from controller.robot_model import RobotModel
from controller.selection import selection
from controller.walking.ankle_guards import AnkleGuards
from controller.walking.ankle_limit import ground_slope, limited, sole_levers
from controller.walking.buoyancy import BuoyancyCompensation
from controller.walking.drag_compensation import DragCompensation
from controller.walking.gravity_compensation import GravityCompensation
from controller.walking.heading_frame import Pair
from controller.walking.hip_gravity import HipGravity
from controller.walking.implicit_pd import ImplicitPd
from controller.walking.joint_groups import JointGroups
from controller.walking.pose_tracking import PoseTracking
from controller.walking.root_balance import hip_damping, hip_moment, stance_share
from controller.walking.step_planner import StepPlanner
from controller.walking.torque_config import TorqueWalkingConfig
from controller.walking.virtual_force import VirtualForce
from hil.description import RobotDescription
from hil.interface import SIDES, Floats


class TorqueLaw:
    """Joint torques from the plan of the step and the targets of `tracking`."""

    def __init__(
        self,
        description: RobotDescription,
        config: TorqueWalkingConfig,
        robot: RobotModel,
        rate_hz: int,
        pd: Literal["explicit", "implicit"],
        ankle_limit: bool,
    ) -> None:
        self._config, self._robot = config, robot
        self.groups = groups = JointGroups(description, robot)
        implicit = pd == "implicit"
        dt = 1.0 / rate_hz
        gains = config.gains_at(rate_hz, implicit)
        self.tracking = PoseTracking(robot, groups, config, gains, dt if implicit else 0.0)
        self._hips, self._ankles = groups.legs("hip"), groups.legs("ankle")
        trunk = groups.parent == robot.root_body
        trunk[self._hips] = False
        self._trunk = np.flatnonzero(trunk)
        self._trunk_rows = selection(self._trunk)
        self._gravity = GravityCompensation(robot, groups)
        self._buoyancy: BuoyancyCompensation | None = None
        self._drag: DragCompensation | None = None
        weighed = config.hip_gravity == "always" or (config.hip_gravity == "implicit" and implicit)
        self._hip_gravity = HipGravity(robot, groups) if weighed else None
        self._virtual = VirtualForce(config.virtual_force, robot, groups, groups.index("back"))
        self._implicit = (
            ImplicitPd(robot, groups, self.tracking, self._trunk, dt) if implicit else None
        )
        self._levers = [sole_levers(robot, description.feet[side]) for side in SIDES]  # type: ignore[index]
        self._limit_ankle = ankle_limit
        self._ankle_joints = [
            [description.joint_names.index(f"{side}_ankle_{axis}") for axis in ("pitch", "roll")]
            for side in SIDES
        ]
        self._guards = AnkleGuards(robot) if config.ankle_guards else None
        self._last_loads: Pair = (0.0, 0.0)

    def torques(self, plan: StepPlanner, loads: Pair, forefeet: Pair) -> Floats:
        """Torques of all joints [N·m], shape (n,).

        `loads` are the vertical forces on the feet, `forefeet` their part on front corners and
        toe [N], left and right.
        """
        gait, tracking = plan.gait, self.tracking
        foot = plan.foot_heading
        flat = {} if foot is None else {int(self._ankles[gait.stance]): foot}
        tracking.set_frames(plan.heading, flat)
        vectors = tracking.torques()
        if self._config.drag_compensation and plan.drags:
            vectors[: len(self.groups)] += self._carry_drag(plan)
        shares = stance_share(loads[gait.stance], loads[gait.swing])
        hips = (int(self._hips[gait.stance]), int(self._hips[gait.swing]))
        standing = loads[gait.stance] > 0.0
        self._balance_root(vectors, hips, shares, standing)
        torque = vectors[: len(self.groups)]
        torque += self._gravity.torques(gait.stance)
        if plan.liquid.level > 0.0 and self._config.buoyancy_compensation:
            torque += self._lift(plan)
        if self._hip_gravity is not None:
            load = loads[gait.swing]
            torque[hips[0]] += self._hip_gravity.torque(gait.stance, shares[0], load)
        if gait.foot_flat:
            self._push_body(torque, plan, loads, forefeet)
        self._last_loads = loads
        axes = self._robot.joint_axes
        joints = self.groups.project(torque, axes)
        if self._limit_ankle and gait.foot_flat:
            self._limit(joints, gait.stance, loads[gait.stance])
        if self._implicit is not None:
            joints = self._implicit.correct(joints, hips, shares, standing)
        return joints

    def _lift(self, plan: StepPlanner) -> Floats:
        """What the liquid carries of what gravity compensation asks for."""
        if self._buoyancy is None:
            self._buoyancy = BuoyancyCompensation(self._robot, self.groups)
        return self._buoyancy.torques(plan.gait.stance, plan.liquid.level, plan.liquid.density)

    def _carry_drag(self, plan: StepPlanner) -> Floats:
        """What holds the swing leg back in the liquid; the stance hip balances it too."""
        if self._drag is None:
            self._drag = DragCompensation(self._robot, self.groups)
        across, speed = plan.heading[:, 1], plan.command[1]
        return self._drag.torques(plan.gait.swing, plan.liquid, across, speed)

    def _balance_root(
        self,
        torques: Floats,
        hips: tuple[int, int],
        shares: tuple[float, float],
        standing: bool,
    ) -> None:
        """Put the root's torque on the hips; the last row of `torques` is the root's.

        The stance hip gives its pose up for that. While its foot is off the floor, when it has
        bounced or slipped, the hip keeps the pose in which it landed: with no torque at all the
        leg would fly off sideways.
        """
        stance, swing = hips
        moment = hip_moment(torques[-1], torques[swing], torques[self._trunk_rows])
        torques[swing] += shares[1] * moment
        if standing:
            rates = self._robot.angular_velocities
            groups = self.groups
            relative = rates[groups.child[stance]] - rates[groups.parent[stance]]
            damping = hip_damping(self._config.root_balance, relative)
            torques[stance] = shares[0] * moment + damping

    def note_applied(self, torques: Floats) -> None:
        """Joint torques that are applied in place of what `torques` returned [N·m], (n,)."""
        if self._implicit is not None:
            self._implicit.note_applied(torques)

    def _push_body(self, torques: Floats, plan: StepPlanner, loads: Pair, forefeet: Pair) -> None:
        """Virtual force on the body, carried by the legs in proportion to two ticks' loads."""
        left, right = loads[0] + self._last_loads[0], loads[1] + self._last_loads[1]
        total = left + right
        if total > 0.0:
            before = None if self._guards is None else torques[self._ankles]
            force = self._virtual.force(plan.wanted, plan.velocity, plan.heading)
            self._virtual.add_torques(torques, force, (left / total, right / total))
            if self._guards is not None and before is not None:
                self._guard(self._guards, torques, before, plan, forefeet)

    def _guard(
        self,
        guards: AnkleGuards,
        torques: Floats,
        before: Floats,
        plan: StepPlanner,
        forefeet: Pair,
    ) -> None:
        """Withdraw from the ankles what the virtual force added to `before` and may not."""
        phase, heading = plan.gait.phase, plan.heading
        for foot, group in enumerate(self._ankles):
            added = torques[group] - before[foot]
            kept = guards.guarded(added, foot, forefeet[foot], phase, heading)
            torques[group] = before[foot] + kept

    def _limit(self, joints: Floats, stance: int, load: float) -> None:
        robot, levers = self._robot, self._levers[stance]
        slope = ground_slope(levers, robot.com, robot.ankles[stance], robot.feet[stance])
        pitch, roll = self._ankle_joints[stance]
        joints[pitch], joints[roll] = limited(
            levers,
            self._config.ankle_limit.fraction,
            load,
            slope,
            float(joints[pitch]),
            float(joints[roll]),
        )
