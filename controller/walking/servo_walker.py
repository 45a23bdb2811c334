"""Walking of a servo robot: the shared gait, with inverse kinematics and feed-forward at its end.

Structure of seed 000_bd1305a0ae731442 (state machine, placement of the swing foot by an inverted
pendulum, velocity control by a virtual force, gravity compensation), for joints whose servos
close a stiff position loop: horizontal freedom of the stance leg comes from targets that follow
the measured place of the torso, and the virtual force acts as a centre of pressure.
"""

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.hoisted_step import HoistedStep
from controller.walking.learned_load import LearnedLoad
from controller.walking.leg_inertia import LegInertia
from controller.walking.leg_kinematics import Vector
from controller.walking.leg_targets import INSTANTS, LegPlanner, LegTargets
from controller.walking.rotations import heading_of
from controller.walking.servo_config import servo_walking_config
from controller.walking.servo_step import ServoStep
from controller.walking.support_force import SoleForce, SupportForce
from controller.walking.swing_governor import SwingGovernor
from controller.walking.swing_trajectory import SwingTrajectory
from controller.walking.weight_shift import WeightShift
from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.interface import SIDES, Estimate, Floats, Ints, JointCommand, Reference, WalkStatus

LEG_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")

PITCH = slice(2, 5)
"""Hip pitch, knee and ankle pitch among the joints of a leg."""
ANKLES = slice(4, 6)
"""Ankle pitch and roll among the joints of a leg."""


class ServoWalker:
    """Controller of a robot with six position servos a leg.

    Sends q*, q̇*, the description's stiffness and damping, and the feed-forward torque
    τ_ff + M·q̈* (M the swing leg's inertia); what a servo needs to realise them is not its concern.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        ankle_limit: bool = True,
        *,
        hoisted: bool = False,
    ) -> None:
        """`hoisted`: the robot hangs. It steps at once, its body is imagined (`HoistedStep`), and
        no foot carries anything.
        """
        self._hoisted = hoisted
        self.status = WalkStatus()
        self.config = config = servo_walking_config(description)
        self._dt = 1.0 / rate_hz
        self._lead = config.latency + self._dt / 2
        self._model = model = RobotModel(description)
        self._legs = _leg_joints(description)
        self._pitch_joints = self._legs[:, PITCH]
        self._planner = LegPlanner(model, config.hip_height)
        self._force = SupportForce(model)
        self._shift = WeightShift(config.weight_shift)
        step = HoistedStep if hoisted else ServoStep
        self._step = step(config, model, rate_hz, ankle_limit)
        self._swing = SwingTrajectory(config.swing)
        self._command = JointCommand.zeros(len(description.joints))
        self._command.stiffness[:] = [joint.stiffness for joint in description.joints]
        self._command.damping[:] = [joint.damping for joint in description.joints]
        self._rest: Floats = np.array(description.start_position)
        self._inertia = LegInertia(model, self._legs)
        self._governor = self._swing_governor(description)
        self._load = self._learned_load(description)
        self._governed_step = -1

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The command of this tick. The returned object is reused by the next call."""
        self._model.set_state(estimate)
        if not (self._hoisted or self._shift.finished):
            return self._shift_weight()
        step = self._step
        step.update(estimate, reference)
        targets = self._walk(estimate)
        self._govern(targets, estimate)
        targets.position[:, ANKLES] += step.sole_trim.value
        torque = self.config.balance.torque_gain * self._force.torques(self._reactions())
        swing = step.gait.swing
        torque[self._legs[swing]] += self._swing_torque(swing, targets)
        self._load.add(
            estimate.joint_position[self._pitch_joints[swing]],
            targets.position[swing, PITCH],
            targets.velocity[swing, PITCH],
            targets.acceleration[swing, PITCH],
            torque[self._pitch_joints[swing]],
        )
        self._report()
        return self._fill(targets, torque)

    def _reactions(self) -> list[SoleForce]:
        """What the ground gives to the soles that carry."""
        step = self._step
        if self._hoisted:
            return []
        return step.balance.ground_reaction(
            step.state.place, step.gait, step.frame, self._planner.ankle_height
        )

    def _swing_torque(self, leg: int, targets: LegTargets) -> Floats:
        """What moves the swing leg beyond its weight [N·m], (6,)."""
        acceleration = targets.acceleration[leg]
        torque = self.config.balance.inertia_gain * self._inertia.torque(leg, acceleration)
        torque[PITCH] += self._load.torque(leg, targets.velocity[leg, PITCH], acceleration[PITCH])
        return torque

    def _shift_weight(self) -> JointCommand:
        """Both legs carry the torso, which moves above the first stance foot."""
        shift, model, planner = self._shift, self._model, self._planner
        place, velocity = shift.update(self._dt, model)
        for leg, ankle in enumerate(model.ankles):
            x, y, _ = ankle.tolist()
            seen = (x - place[0], y - place[1])
            yaw = heading_of(model.feet[leg])
            planner.support(leg, seen, velocity, self._lead, 0.0, yaw)
        reactions = shift.ground_reaction(model, planner.ankle_height)
        torque = self.config.balance.torque_gain * self._force.torques(reactions)
        return self._fill(planner.solve(), torque)

    def _walk(self, estimate: Estimate) -> LegTargets:
        step, planner, lead = self._step, self._planner, self._lead
        stance = step.gait.stance
        u, v, w = step.base_velocity(estimate)
        base_x, base_y, _ = estimate.base_position.tolist()
        ankle = (step.ankle[0] - base_x, step.ankle[1] - base_y)
        yaw = heading_of(self._model.feet[stance])
        limit = self.config.yaw_limit
        heading = yaw + max(-limit, min(step.heading - yaw, limit))
        planner.support(stance, ankle, (u, v), lead, heading, yaw)
        planner.swing(step.gait.swing, self._swing_points(), (u, v, w), lead, step.swing_yaw())
        return planner.solve()

    def _swing_points(self) -> list[Vector]:
        """World points of the swing ankle at the three instants [m]."""
        step, swing = self._step, self._swing
        rate, period = step.phase_rate, 1.0 / step.phase_rate
        ground = self._planner.ankle_height + step.height_trim.value[step.gait.swing]
        points = []
        for instant in INSTANTS:
            phase = step.gait.phase + rate * (self._lead + instant)
            x, y = swing.horizontal(phase, step.lift_off, step.landing)
            height = ground + swing.lift(phase, period)
            points.append((x + step.ankle[0], y + step.ankle[1], height))
        return points

    def _fill(self, targets: LegTargets, torque: Floats) -> JointCommand:
        command = self._command
        command.position[:] = self._rest
        command.position[self._legs] = targets.position
        command.velocity[self._legs] = targets.velocity
        command.torque[:] = torque
        return command

    def _govern(self, targets: LegTargets, estimate: Estimate) -> None:
        """Bring the swing leg's targets to what its servos can follow."""
        gait, legs = self._step.gait, self._legs
        swing = gait.swing
        if gait.steps != self._governed_step:
            self._governed_step = gait.steps
            joints = legs[swing]
            measured = estimate.joint_position[joints], estimate.joint_velocity[joints]
            self._load.begin(swing)
            self._governor.begin(*measured, self._lead - self._dt, self._load.inertia[swing])
        self._governor.update(
            self._dt, targets.position[swing], targets.velocity[swing], targets.acceleration[swing]
        )

    def _swing_governor(self, description: RobotDescription) -> SwingGovernor:
        """The governor of either leg, in the start pose's inertia."""
        share = self.config.balance.inertia_gain  # what else there is, is learnt
        inertia = [share * inertia for inertia in self._inertia.at_rest(self._rest)]
        joints = [description.joints[joint] for joint in self._legs[0].tolist()]
        damping = [joint.damping for joint in joints]
        stall = [joint.torque_limit for joint in joints]
        return SwingGovernor(self.config.governor, inertia, damping, stall)

    def _learned_load(self, description: RobotDescription) -> LearnedLoad:
        joints = [description.joints[joint] for joint in self._pitch_joints[0].tolist()]
        return LearnedLoad(
            self.config.learned_load,
            [joint.stiffness for joint in joints],
            [joint.damping for joint in joints],
            [joint.torque_limit for joint in joints],
            self._lead / self._dt,
            self._dt,
        )

    def _report(self) -> None:
        step, status = self._step, self.status
        status.walking = True
        status.phase = step.gait.phase
        status.stance = step.gait.stance
        status.steps = step.gait.steps
        status.foot_flat = step.gait.foot_flat
        status.heading = step.heading
        (x, y, _), (ahead_x, ahead_y) = step.ankle, step.landing
        status.foot_target[:] = (x + ahead_x, y + ahead_y, self._planner.ankle_height)


def _leg_joints(description: RobotDescription) -> Ints:
    """Index of each leg joint in the description's order, shape (2, 6)."""
    names = description.joint_names
    wanted = [[f"{side}_{joint}" for joint in LEG_JOINTS] for side in SIDES]
    missing = [name for leg in wanted for name in leg if name not in names]
    if missing:
        raise DescriptionError(
            description.file, "joints", f"a servo walker needs {', '.join(missing)}"
        )
    return np.array([[names.index(name) for name in leg] for leg in wanted])
