"""The plan of the present step: who stands, where to, how fast, and where the swing foot goes."""

import math

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.alteration import Alteration
from controller.walking.command_ramp import CommandRamp
from controller.walking.foot_placement import FootPlacement
from controller.walking.gait import Gait
from controller.walking.heading import HeadingRamp
from controller.walking.learned_velocity import LearnedVelocity
from controller.walking.rotations import about_z, heading_of
from controller.walking.step_average import StepAverage
from controller.walking.torque_config import TorqueWalkingConfig
from hil.interface import Estimate, Floats, Reference


class StepPlanner:
    """Gait, heading, commanded and learned speed, and foot placement, tick by tick.

    Its attributes belong to the last `update`; vectors of shape (2,) are sagittal and coronal.
    """

    def __init__(
        self, config: TorqueWalkingConfig, robot: RobotModel, dt: float, speed: float
    ) -> None:
        self._robot = robot
        self._dt = dt
        self.gait = Gait(config.gait, robot.weight)
        self.heading_ramp = HeadingRamp(config.heading)
        self._command = CommandRamp(config.command, np.array([speed, 0.0]))
        self._placement = FootPlacement(config.placement, robot.leg_length, robot.gravity)
        self._own_width = 2.0 * config.placement.half_width
        self.alteration = Alteration(config.alteration)
        self._average = StepAverage()
        longest = config.gait.max_phase * config.gait.period / dt
        self._learned = LearnedVelocity(config.learned_velocity, math.ceil(longest) + 1)
        self._swing_start = np.zeros(2)
        self._first = True
        self.new_step = True
        """This tick is the first of its step."""
        self.heading = np.eye(3)
        """Heading frame to world, shape (3, 3)."""
        self.foot_heading: Floats | None = None
        """Heading frame of the stance foot, from the moment when it lies flat."""
        self.velocity = np.zeros(2)
        """Of the centre of mass in the heading frame [m/s]."""
        self.wanted = np.zeros(2)
        """Speed for the virtual force: commanded plus learned deviation [m/s]."""
        self.foot_target = np.zeros(3)
        """World target of the swing ankle [m]; the height is left to the caller."""

    def update(self, estimate: Estimate, loads: Floats, reference: Reference) -> None:
        """Move the plan on by one tick; `loads` are the vertical forces on the feet [N]."""
        gait, robot = self.gait, self._robot
        command = self._command.update(self._dt, reference.speed, reference.lateral)
        stance = gait.stance
        ended = gait.advance(self._dt, float(loads[gait.swing]))
        if ended:
            self.alteration.end_step(self._average.finish(), float(command[0]))
            self._learned.end_step(stance, learn=not self.heading_ramp.turning)
        self.heading = about_z(self.heading_ramp.update(self._dt, gait, reference.heading))
        self.new_step = ended or self._first
        self._first = False
        if self.new_step:
            self._begin_step()
        self._latch_flat_foot(estimate.foot_force[gait.stance])
        self.velocity = self.heading.T[:2] @ robot.com_velocity
        self._average.add(float(self.velocity[0]))
        self._learned.observe(gait.phase, self.velocity)
        self.wanted = command + self._learned.deviation(gait.stance, gait.phase)
        self._place_foot(command, reference.step_width)

    def _begin_step(self) -> None:
        """Remember where the swing foot leaves; the new stance foot has yet to lie flat."""
        robot = self._robot
        offset = robot.ankle_positions[self.gait.swing] - robot.com
        self._swing_start = self.heading.T[:2] @ offset
        self.foot_heading = None

    def _latch_flat_foot(self, corners: Floats) -> None:
        gait = self.gait
        gait.update_foot_flat(int((corners > gait.config.flat_corner_load * gait.weight).sum()))
        if gait.foot_flat and self.foot_heading is None:
            self.foot_heading = about_z(heading_of(self._robot.foot_rotations[gait.stance]))

    def _place_foot(self, command: Floats, step_width: float) -> None:
        robot, gait = self._robot, self.gait
        com = robot.com
        width = self._own_width if math.isnan(step_width) else step_width
        landing = self._placement.distance(
            self.velocity,
            float(com[2] - robot.ankle_positions[gait.stance, 2]),
            command,
            self.alteration.value,
            -gait.stance_sign * 0.5 * width,
        )
        offset = self._placement.blend(gait.phase, landing, self._swing_start)
        self.foot_target[:] = com + self.heading[:, :2] @ offset
