"""The walking controller of a torque robot: one tick from estimate to joint torques.

Seed 000_bd1305a0ae731442, section 3: state machine with key poses, pendulum foot placement, root
balance at the hips, gravity compensation and velocity control by a virtual force.
"""

from typing import Literal

from controller.robot_model import RobotModel
from controller.walking.pose_targets import PoseTargets
from controller.walking.step_planner import StepPlanner
from controller.walking.swing_leg import LegLinks, SwingLeg
from controller.walking.torque_config import TorqueWalkingConfig
from controller.walking.torque_law import TorqueLaw
from hil.description import RobotDescription
from hil.interface import Estimate, JointCommand, Reference, WalkStatus
from hil.validation import validate


class TorqueWalker:
    """Implements `hil.interface.Controller` for robots whose joints take torques.

    `speed` is the sagittal speed with which the body starts [m/s]; `ankle_limit` keeps the
    stance foot flat. Raises DescriptionError for a walking section that does not fit.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        pd: Literal["explicit", "implicit"] = "explicit",
        ankle_limit: bool = True,
        speed: float = 0.0,
    ) -> None:
        config = validate(TorqueWalkingConfig, description.walking, description.file, "walking")
        dt = 1.0 / rate_hz
        self._fallen_height = config.fallen_height
        self._robot = robot = RobotModel(description)
        self._plan = StepPlanner(config, robot, dt, speed)
        self._law = TorqueLaw(description, config, robot, rate_hz, pd, ankle_limit)
        self._targets = PoseTargets(
            description, config, robot, self._law.groups, self._law.tracking
        )
        links = LegLinks(robot.thigh_length, robot.shank_length, robot.knee_offset)
        self._swing_leg = SwingLeg(config.swing_leg, links, dt)
        self._command = JointCommand.zeros(len(description.joints))
        self.status = WalkStatus(walking=True)

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The torques of this tick; all zero once the robot lies on the floor."""
        if estimate.base_position[2] < self._fallen_height:
            self._command.torque[:] = 0.0
            self.status.walking = False
            return self._command
        self._robot.set_state(estimate)
        loads = estimate.foot_force.sum(axis=1) + estimate.toe_force
        self._plan.update(estimate, loads, reference)
        self._aim_swing_leg()
        self._command.torque[:] = self._law.torques(self._plan, loads)
        self._report()
        return self._command

    def _aim_swing_leg(self) -> None:
        """Key poses of the phase, then inverse kinematics of the swing leg to its foot target."""
        robot, plan = self._robot, self._plan
        swing = plan.gait.swing
        drop = self._targets.update(plan.gait)
        hip = robot.hip_positions[swing]
        plan.foot_target[2] = hip[2] - drop
        if plan.new_step:
            self._swing_leg.begin_step()
        self._swing_leg.update(hip, plan.foot_target, plan.heading[:, 1], robot.root_rotation)
        self._targets.set_swing_leg(swing, self._swing_leg)

    def _report(self) -> None:
        status, gait = self.status, self._plan.gait
        status.walking = True
        status.phase, status.stance, status.steps = gait.phase, gait.stance, gait.steps
        status.foot_flat = gait.foot_flat
        status.foot_target[:] = self._plan.foot_target
        status.heading = self._plan.heading_ramp.heading
