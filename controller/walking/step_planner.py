"""The plan of the present step: who stands, where to, how fast, and where the swing foot goes."""

import math

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.alteration import Alteration
from controller.walking.command_ramp import CommandRamp
from controller.walking.foot_placement import FootPlacement
from controller.walking.gait import Gait
from controller.walking.gait_styles import GaitStyles
from controller.walking.heading import HeadingRamp
from controller.walking.heading_frame import HeadingFrame, Pair
from controller.walking.learned_velocity import LearnedVelocity
from controller.walking.leg_crossing import LegCrossing
from controller.walking.liquid import Liquid
from controller.walking.recovery import Recovery
from controller.walking.rotations import about_z, heading_of
from controller.walking.step_average import StepAverage
from controller.walking.take_over import TakeOver
from controller.walking.torque_config import TorqueWalkingConfig
from controller.walking.velocity_offset import VelocityOffset
from hil.interface import Estimate, Floats, Reference

LEAD_MEMORY = 0.5
"""Time constant of the mean speed by which drag is foreseen, in nominal step times."""


class StepPlanner:
    """Gait, heading, commanded and learned speed, and foot placement, tick by tick.

    Its attributes belong to the last `update`; pairs are sagittal and coronal.
    """

    def __init__(
        self,
        config: TorqueWalkingConfig,
        robot: RobotModel,
        dt: float,
        speed: float,
        styles: GaitStyles,
    ) -> None:
        sole_half_width = float(robot.corner_offsets[0, :, 1].max())
        self._robot = robot
        self._styles = styles
        self._dt = dt
        self.gait = Gait(config.gait, robot.weight)
        self.heading_ramp = HeadingRamp(config.heading)
        self._ramp = CommandRamp(config.command, (speed, 0.0))
        self._carried = config.drag_compensation
        self._placement = FootPlacement(config.placement, robot.leg_length, robot.gravity)
        self._take_over = TakeOver(config.take_over)
        self._crossing = LegCrossing(2.0 * sole_half_width + config.leg_crossing.clearance)
        self._own_width = 2.0 * config.placement.half_width
        self.alteration = Alteration(config.alteration)
        self.coronal_alteration = Alteration(config.coronal_alteration)
        self._last_coronal: float | None = None
        self._mean_speed = speed
        self._mean_share = dt / (LEAD_MEMORY * config.gait.period)
        self._averages = (StepAverage(), StepAverage())
        longest = config.gait.max_phase * config.gait.period / dt
        self._offset = VelocityOffset(config.velocity_offset)
        self.recovery = Recovery(config.recovery)
        self._learned = LearnedVelocity(config.learned_velocity, math.ceil(longest) + 1)
        self._frame = HeadingFrame()
        self._angle = 0.0
        self._swing_start = self._lift_off = (0.0, 0.0)
        self._first = True
        self._turned = self._turned_before = False
        self.new_step = True
        """This tick is the first of its step."""
        self.heading = np.eye(3)
        """Heading frame to world, shape (3, 3)."""
        self.foot_heading: Floats | None = None
        """Heading frame of the stance foot, from the moment when it lies flat."""
        self.velocity: Pair = (0.0, 0.0)
        """Of the centre of mass in the heading frame [m/s]."""
        self.command: Pair = (0.0, 0.0)
        """Commanded speed, as fast as it may change [m/s]."""
        self.wanted: Pair = (0.0, 0.0)
        """Speed for the virtual force: commanded plus learned deviation [m/s]."""
        self.liquid = Liquid()
        """What the robot is told to walk in."""
        self.foot_target = [0.0, 0.0, 0.0]
        """World target of the swing ankle [m]; the height is left to the caller."""

    @property
    def drags(self) -> bool:
        """The liquid holds the swing leg back in a way that the poses do not allow for."""
        liquid = self.liquid
        return liquid.level > 0.0 and (liquid.excess > 0.0 or self.command[1] != 0.0)

    def update(self, estimate: Estimate, loads: Pair, reference: Reference) -> None:
        """Move the plan on by one tick; `loads` are the vertical forces on the feet [N]."""
        gait = self.gait
        self.liquid.expect(reference)
        command = self._ramp.update(self._dt, reference.speed, reference.lateral)
        self.command = command
        stance = gait.stance
        ended = gait.advance(self._dt, loads[gait.swing])
        if ended:
            self._end_step(stance, command)
        self._turn(self.heading_ramp.update(self._dt, gait, reference.heading))
        self._turned |= self.heading_ramp.turning
        self.new_step = ended or self._first
        self._first = False
        if self.new_step:
            liquid = self.liquid
            self._styles.choose(liquid.alike(command[0]), liquid.level, liquid.resistance)
            self._begin_step()
        self._latch_flat_foot(estimate.foot_force[gait.stance])
        self._observe_speed(command)
        self._place_foot(command, reference.step_width)

    def _end_step(self, stance: int, command: Pair) -> None:
        """Judge the step that `stance` carried, and adapt to it if it was an ordinary one.

        A turn rotates the frame in which speeds are measured, so the steps that turn, and the one
        after them, teach nothing; nor do recovery steps (first author's code), until there were so
        many that learning starts again.
        """
        averages = self._averages[0].finish(), self._averages[1].finish()
        recovered, turned = self.recovery.frozen, self._turned
        if self.recovery.end_step(turned):
            self._learned.reset()
            self._offset.clear()
        ordinary = not (self.recovery.frozen or recovered or turned or self._turned_before)
        self._turned_before, self._turned = turned, False
        if ordinary:
            self.alteration.end_step(averages[0], command[0])
            if self._last_coronal is not None:
                both = 0.5 * (averages[1] + self._last_coronal)
                self.coronal_alteration.end_step(both, command[1])
            self._offset.end_step(averages, command)
        self._last_coronal = averages[1] if ordinary else None
        self._learned.end_step(stance, learn=ordinary, wanted=command[0])

    def _observe_speed(self, command: Pair) -> None:
        """Take the speed of the tick, and what is wanted of it."""
        gait = self.gait
        u, v, vertical = self._robot.com_velocity.tolist()
        self.velocity = self._frame.to_heading((u, v))
        self._averages[0].add(self.velocity[0])
        self._averages[1].add(self.velocity[1])
        self._learned.observe(gait.phase, self.velocity)
        sagittal, coronal = self._learned.deviation(gait.stance, gait.phase)
        offset = self._offset.value
        self.wanted = (command[0] + sagittal + offset[0], command[1] + coronal + offset[1])
        self.recovery.observe(self.velocity, self.wanted, command)
        self._take_over.update(gait.phase, vertical)

    def _turn(self, angle: float) -> None:
        """Set the heading frame [rad]."""
        if angle != self._angle:
            self._angle = angle
            self.heading = about_z(angle)
            self._frame.set(angle)

    def _begin_step(self) -> None:
        """Remember where the swing foot leaves; the new stance foot has yet to lie flat."""
        robot = self._robot
        x, y, _ = (robot.ankles[self.gait.swing] - robot.com).tolist()
        self._swing_start = self._lift_off = self._frame.to_heading((x, y))
        self.foot_heading = None
        self._take_over.begin_step(self.recovery.active)

    def _latch_flat_foot(self, corners: Floats) -> None:
        gait = self.gait
        loaded = gait.config.flat_corner_load * gait.weight
        gait.update_foot_flat(sum(force > loaded for force in corners.tolist()))
        if gait.foot_flat and self.foot_heading is None:
            self.foot_heading = about_z(heading_of(self._robot.feet[gait.stance]))

    def _place_foot(self, command: Pair, step_width: float) -> None:
        robot, gait = self._robot, self.gait
        x, y, height = robot.com.tolist()
        width = self._own_width if math.isnan(step_width) else step_width
        landing = self._placement.distance(
            self.velocity,
            height - float(robot.ankles[gait.stance][2]),
            command,
            self.alteration.value + self._lead(),
            self.coronal_alteration.value - gait.stance_sign * 0.5 * width,
        )
        share = self._placement.share(gait.phase, self._take_over.phase)
        start = self._follow_path() if self._take_over.phase is None else self._swing_start
        ahead = start[0] + share * (landing[0] - start[0])
        aside = start[1] + share * (landing[1] - start[1])
        aside += self._sidestep(start, landing, share)
        ahead_x, ahead_y = self._frame.to_world((ahead, aside))
        self.foot_target[:2] = x + ahead_x, y + ahead_y

    def _follow_path(self) -> Pair:
        """Place of the swing foot before the take-over, from the centre of mass [m].

        Where it left the floor, or what the styles of the step say; the pendulum will begin where
        it is then.
        """
        path = self._styles.path
        if path is not None:
            ahead, aside, said = path.at(self.gait.phase)
            x, y, _ = (self._robot.hips[self.gait.swing] - self._robot.com).tolist()
            hip = self._frame.to_heading((x, y))
            left = self._lift_off
            aside *= self.gait.stance_sign
            self._swing_start = (
                (1.0 - said) * left[0] + said * hip[0] + ahead,
                (1.0 - said) * left[1] + said * hip[1] + aside,
            )
        return self._swing_start

    def _lead(self) -> float:
        """How much further the swing foot is sent in water [m].

        For the speed that the body has: after a hit, or while the command runs ahead, drag is
        that of the real speed, not of the wanted one. Where the leg's drag beyond that of water is
        compensated, what holds the foot back is water.
        """
        liquid = self.liquid
        self._mean_speed += self._mean_share * (self.velocity[0] - self._mean_speed)
        if liquid.level <= 0.0:
            return 0.0
        felt = min(liquid.resistance, 1.0) if self._carried else liquid.resistance
        return self._placement.lead(self._mean_speed, liquid.level, felt)

    def _sidestep(self, start: Pair, landing: Pair, share: float) -> float:
        """Coronal offset that leads the swing foot round the stance foot [m]."""
        gait, robot = self.gait, self._robot
        x, y, _ = (robot.com - robot.ankles[gait.stance]).tolist()
        com_x, com_y = self._frame.to_heading((x, y))
        return self._crossing.sidestep(
            (com_x + start[0], com_y + start[1]),
            (com_x + landing[0], com_y + landing[1]),
            share,
            -gait.stance_sign,
        )
