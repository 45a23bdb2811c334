"""The jump of a torque robot: one tick from estimate to joint torques, stage after stage."""

import numpy as np

from controller.jumping.body_tasks import BodyTasks
from controller.jumping.crouch import Crouch
from controller.jumping.flight import Flight
from controller.jumping.jump_plan import Heights, JumpPlan, plan_jump
from controller.jumping.jump_settings import (
    LEAN,
    REST_BEND,
    STANDING_BEND,
    TAKE_OFF_BEND,
    TOUCH_DOWN_BEND,
    WINDUP_TIME,
)
from controller.jumping.landing import Stand
from controller.jumping.path import JumpTarget
from controller.jumping.posture import standing
from controller.jumping.stage import Kit, Stage
from controller.jumping.thrust import Push
from controller.jumping.whole_body import WholeBody
from controller.walking.rotations import about_z, heading_of
from hil.description import RobotDescription
from hil.interface import Estimate, JointCommand, Reference, WalkStatus

STAGES = (Crouch, Push, Flight, Stand)
"""In this order; `WalkStatus.steps` of a jump counts those that are over."""
TUCK = 0.08
"""How far the feet are drawn up in the air from their distance at take-off, in leg lengths."""
STEP_TUCK = 0.5
"""And how much further to clear the edge of a step, as a share of its height."""
RISE_TIME = 2.6
"""From touch-down until the body begins to rise, in √(L/g)."""
PRESSURE = 0.01
"""How far ahead of the soles' centre the push is centred, in leg lengths."""
FALLEN_SHARE, FALLEN_COSINE = 0.45, 0.4
"""A centre of mass lower than this share of its standing height, or a root body that tilts further
than by this cosine, has fallen: no torque."""


class JumpController:
    """Implements `hil.interface.Controller`: windup, push, flight, landing, stand.

    Begins with a robot on both feet, at rest or walking slowly; ends standing still on both feet,
    knees slightly bent, so that it may follow and be followed by walking. A push that loses the
    ground, or a flight that is stopped short, goes over to landing, which takes any velocity.
    """

    def __init__(self, description: RobotDescription, rate_hz: int, target: JumpTarget) -> None:
        """`target` in axes of the robot's heading at the start."""
        self._target = target
        self.body = body = WholeBody(description, target.gravity)
        self.heights = jump_heights(body, description)
        posture = np.array(description.start_position)
        self._tasks = BodyTasks(description, body, posture)
        standing(body.robot, posture)
        self._stance = np.array(body.robot.ankles) - body.robot.corner_positions.mean(axis=(0, 1))
        """Ankles from the soles' centre in the start pose [m], (2, 3)."""
        self._tasks.upright, self._tasks.lean = self.heights.take_off, LEAN
        self._frame = np.eye(3)
        """Heading of the jump to world, (3, 3)."""
        self._kit = Kit(self._tasks, 1.0 / rate_hz, target.gravity, target.push_depth)
        self._command = JointCommand.zeros(len(description.joints))
        self.stage: Stage | None = None
        """What is being done; none before the first step."""
        self.plan: JumpPlan | None = None
        """Known from the first step on."""
        self.torque_ratio = 0.0
        """Largest torque asked for so far, as a share of its joint's limit, which cuts it."""
        self.asked = np.zeros(len(description.joints))
        """What the law asked for in the last step, before the limits [N·m], (n,)."""
        self._limits = np.array([joint.torque_limit for joint in description.joints])
        self.status = WalkStatus(walking=True)

    @property
    def over(self) -> bool:
        """The robot has landed and stands still: another controller may begin."""
        return isinstance(self.stage, Stand) and self.stage.settled

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The torques of this tick; all zero once the robot lies on the floor."""
        del reference  # The target was given once and for all.
        body, command = self.body, self._command
        body.set_state(estimate)
        low = float(body.robot.com[2] - body.corners[..., 2].min())
        upright = float(body.robot.root_rotation[2, 2])
        if low < FALLEN_SHARE * self.heights.standing or upright < FALLEN_COSINE:
            command.torque[:] = 0.0
            self.status.walking = False
            return command
        stage = self.stage
        if stage is None:
            stage = self.stage = self._begin()
        elif stage.over:
            stage = self.stage = self._next(stage)
        asked = body.torques(stage.task(estimate))
        self.asked[:] = asked
        self.torque_ratio = max(self.torque_ratio, float(np.abs(asked / self._limits).max()))
        np.clip(asked, -self._limits, self._limits, out=command.torque)
        return command

    def _begin(self) -> Stage:
        """Plan from where the feet are, and how fast the body goes."""
        body, target = self.body, self._target
        robot = body.robot
        heading = heading_of(robot.root_rotation)
        self._tasks.set_heading(heading)
        self._frame = frame = about_z(heading)
        forward = frame[:2, 0]
        feet = body.corners.mean(axis=(0, 1))
        x, y, z = (frame @ np.array(target.displacement)).tolist()
        turned = JumpTarget((x, y, z), target.airtime, target.push_depth, target.gravity)
        ahead = forward * PRESSURE * robot.leg_length
        time = WINDUP_TIME / self._tasks.pace

        def plan(speed: float) -> JumpPlan:
            return plan_jump(turned, robot.mass, self.heights, feet, speed * forward, ahead)

        speed = float(forward @ robot.com_velocity[:2])
        still, moving = (float(forward @ (plan(v).crouch - robot.com)[:2]) for v in (0.0, speed))
        speed *= carried_share(still, moving, speed, time)
        self.plan = plan(speed)
        return Crouch(self._kit, self.plan.crouch, np.append(speed * forward, 0.0), time)

    def _next(self, stage: Stage) -> Stage:
        plan, heights = self.plan, self.heights
        self.status.steps += 1
        self.status.phase = 0.0
        leg = self.body.robot.leg_length
        if plan is not None and isinstance(stage, Crouch):
            return Push(self._kit, plan)
        if plan is not None and isinstance(stage, Push):
            tuck = TUCK * leg + STEP_TUCK * abs(self._target.displacement[2])
            stance = self._stance @ self._frame.T
            return Flight(self._kit, plan, tuck, heights.touch_down, stance)
        low = heights.resting
        self.status.steps = len(STAGES) - 1
        floor = 0.0 if plan is None else float(plan.landing_feet[2])
        return Stand(self._kit, low, heights.standing, RISE_TIME / self._tasks.pace, floor)


def carried_share(still: float, moving: float, speed: float, time: float) -> float:
    """Share of a `speed` v [m/s] that a body should still have at its crouch, 0 to 1.

    The way with least effort to a place Δ ahead in the time T ends with the speed
    1.5·Δ/T − v/2. The crouch lies Δ = `still` ahead for a push from rest and `moving` for one at
    the whole speed [m], and between for a share s: s·v = 1.5·(still + s·(moving − still))/T − v/2.
    """
    if speed <= 0.0:
        return 0.0
    slope = speed - 1.5 * (moving - still) / time
    return min(max((1.5 * still / time - 0.5 * speed) / slope, 0.0), 1.0)


def jump_heights(body: WholeBody, description: RobotDescription) -> Heights:
    """Of the centre of mass over the soles, from the height on straight legs; leaves it there."""
    robot = body.robot
    joints = np.array(description.start_position)
    for index, name in enumerate(description.joint_names):
        if name.endswith("knee"):
            joints[index] = robot.knee_offset
        elif "hip" in name or "ankle" in name:
            joints[index] = 0.0
    standing(robot, joints)
    straight = float(robot.com[2])
    bends = (STANDING_BEND, TAKE_OFF_BEND, TOUCH_DOWN_BEND, REST_BEND)
    return Heights(*(straight - bend * robot.leg_length for bend in bends))
