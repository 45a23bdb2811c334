"""The walking controller of a torque robot: one tick from estimate to joint torques.

Seed 000_bd1305a0ae731442, section 3: state machine with key poses, pendulum foot placement, root
balance at the hips, gravity compensation and velocity control by a virtual force.
"""

from typing import Literal

from controller.robot_model import RobotModel
from controller.walking.gait_styles import GaitStyles
from controller.walking.pose_targets import PoseTargets
from controller.walking.stabilizer.config import SolverName
from controller.walking.stabilizer.stabilizer import Stabilizer
from controller.walking.step_planner import StepPlanner
from controller.walking.swing_leg import LegLinks, SwingLeg
from controller.walking.torque_config import torque_walking_config
from controller.walking.torque_law import TorqueLaw
from hil.description import RobotDescription
from hil.interface import Estimate, Floats, JointCommand, Reference, WalkStatus


class TorqueWalker:
    """Implements `hil.interface.Controller` for robots whose joints take torques.

    `speed` is the sagittal speed with which the body starts [m/s]; `ankle_limit` keeps the
    stance foot flat, `stabilizer` keeps all its sides loaded, by the search `solver`. Raises
    DescriptionError for a walking section that does not fit.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        pd: Literal["explicit", "implicit"] = "explicit",
        ankle_limit: bool = True,
        speed: float = 0.0,
        stabilizer: bool = False,
        solver: SolverName = "linear",
    ) -> None:
        config = torque_walking_config(description)
        dt = 1.0 / rate_hz
        self._fallen_height = config.fallen_height
        self._robot = robot = RobotModel(description)
        styles = GaitStyles(config)
        self._plan = StepPlanner(config, robot, dt, speed, styles)
        self._law = TorqueLaw(description, config, robot, rate_hz, pd, ankle_limit)
        self._targets = PoseTargets(
            description, config, robot, self._law.groups, self._law.tracking, styles
        )
        links = LegLinks(robot.thigh_length, robot.shank_length, robot.knee_offset)
        self._swing_leg = SwingLeg(config.swing_leg, links, dt)
        self._stabilizer: Stabilizer | None = None
        if stabilizer:
            self._stabilizer = Stabilizer(config.stabilizer, solver, description, robot, rate_hz)
        self._command = JointCommand.zeros(len(description.joints))
        self.status = WalkStatus(walking=True)

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The torques of this tick; all zero once the robot lies on the floor."""
        if estimate.base_position[2] < self._fallen_height:
            self._command.torque[:] = 0.0
            self.status.walking = False
            return self._command
        self._robot.set_state(estimate)
        feet: list[list[float]] = estimate.foot_force.tolist()
        toes: list[float] = estimate.toe_force.tolist()
        loads = (sum(feet[0]) + toes[0], sum(feet[1]) + toes[1])
        self._plan.update(estimate, loads, reference)
        self._aim_swing_leg()
        forefeet = (feet[0][0] + feet[0][1] + toes[0], feet[1][0] + feet[1][1] + toes[1])
        torques = self._law.torques(self._plan, loads, forefeet)
        if self._stabilizer is not None:
            stance, swing = self._plan.gait.stance, self._plan.gait.swing
            measured = [*feet[stance], toes[stance]]
            self._stabilize(self._stabilizer, torques, measured, bool(estimate.contact[swing]))
        self._command.torque[:] = torques
        self._report()
        return self._command

    def _aim_swing_leg(self) -> None:
        """Key poses of the phase, then inverse kinematics of the swing leg to its foot target."""
        robot, plan = self._robot, self._plan
        swing = plan.gait.swing
        drop = self._targets.update(plan.gait)
        hip: list[float] = robot.hips[swing].tolist()
        plan.foot_target[2] = hip[2] - drop
        if plan.new_step:
            self._swing_leg.begin_step()
        lateral = plan.heading[:, 1].tolist()
        self._swing_leg.update(hip, plan.foot_target, lateral, robot.root_rotation)
        self._targets.set_swing_leg(swing, self._swing_leg)

    def _stabilize(
        self, stabilizer: Stabilizer, torques: Floats, measured: list[float], touching: bool
    ) -> None:
        """Add torques that keep the stance foot's sides loaded, in place."""
        gait = self._plan.gait
        stabilizer.add_torques(torques, gait.stance, gait.foot_flat, measured, touching)
        self._law.note_applied(torques)
        self.status.stabilizer_iterations = stabilizer.solution.iterations
        self.status.stabilizer_limited = stabilizer.solution.limited

    def _report(self) -> None:
        status, gait = self.status, self._plan.gait
        status.walking = True
        status.phase, status.stance, status.steps = gait.phase, gait.stance, gait.steps
        status.foot_flat = gait.foot_flat
        status.foot_target[:] = self._plan.foot_target
        status.heading = self._plan.heading_ramp.heading
        status.alteration = self._plan.alteration.value
        status.wanted_speed = self._plan.wanted[0]
        status.recovering = self._plan.recovery.active
