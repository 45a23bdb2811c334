"""Jumps put together: what the plant needs for one, its controller, and what became of it."""

from dataclasses import replace

from controller.jumping.feasibility import require_feasible
from controller.jumping.hop_rehearsal import HopCurves
from controller.jumping.hop_settings import HopSettings
from controller.jumping.jump_controller import JumpController
from controller.jumping.jump_settings import PUSH_DEPTH
from controller.jumping.path import JumpTarget
from controller.jumping.posture import Posture
from controller.jumping.running_jump import RunningJump
from controller.jumping.servo_hop import ServoHop
from controller.robot_model import RobotModel
from controller.walking.torque_walker import TorqueWalker
from drivers.dynamixel.servo_models import find_servo_model
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import GRAVITY, Floats
from hil.jump_order import JumpOrder
from hil.jump_report import JumpReview
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.trace import Trace

Jumper = JumpController | ServoHop | RunningJump
RUN_UP_S = 3.0
"""How long a robot walks before it slows down for its jump [s]."""
SUBSTEPS, PAD_STIFFNESS = 4, 16
"""Of the plant of a torque robot that jumps: feet that push a fast body leave a ground as soft and
as coarsely stepped as the walking one (docs/jumping-results.md)."""
CLEARANCE = 0.03
"""Between the feet and the edge of a step [m]."""
WIDE = 2.0
"""Half width of a step, and its length [m]."""


def jump_target(order: JumpOrder) -> JumpTarget:
    """The target of an order. Raises InputError."""
    return JumpTarget(order.target, order.airtime, order.push_depth, order.gravity)


def jump_changes(request: RunRequest, order: JumpOrder) -> tuple[str, ...]:
    """Overrides of the description that make the ground of a jump; a user's own come after them.

    Raises InputError.
    """
    description = load_robot(request.robot, request.overrides)
    changes = [f"plant.gravity={order.gravity}"]
    if description.actuation == "torque":
        changes += [f"plant.substeps={SUBSTEPS}", f"plant.pad_stiffness={PAD_STIFFNESS}"]
    if order.target[2] != 0.0:
        if order.run_up is not None:
            raise InputError("--run-up: a walk begins and ends on level ground: Z must be 0")
        box = ", ".join(f"{value:.4f}" for value in _platform(order, description))
        changes.append(f"plant.platform=[{box}]")
    return tuple(changes)


def _platform(order: JumpOrder, description: RobotDescription) -> tuple[float, ...]:
    """The box under the landing, or under the start of a jump downwards.

    Its edge is halfway between the toes at the start and the heels at the landing.
    """
    x, _, z = order.target
    near, far = _foot_reach(description)
    if x + near - far < 2.0 * CLEARANCE:
        least = far - near + 2.0 * CLEARANCE
        raise InputError(
            f"--target: a step needs room for the feet: at least {least:.2f} m forward (got {x:g})"
        )
    edge = (far + x + near) / 2.0
    span = (edge, edge + WIDE) if z > 0.0 else (edge - WIDE, edge)
    return (*span, -WIDE, WIDE, abs(z))


def _foot_reach(description: RobotDescription) -> tuple[float, float]:
    """Rearmost and foremost point of the feet in the start pose, from the root [m]."""
    robot = RobotModel(description)
    model, data = robot.model, robot.data
    names = [name for foot in description.feet.values() for name in (foot.sole, foot.toe) if name]
    geoms = [model.geom(name).id for name in names]
    reach = [(float(data.geom_xpos[g][0]), float(model.geom_aabb[g][3])) for g in geoms]
    return min(x - half for x, half in reach), max(x + half for x, half in reach)


def jump_controller(order: JumpOrder, description: RobotDescription, rate_hz: int) -> Jumper:
    """The controller of a jump that the actuators can do; anything else raises InputError."""
    if order.run_up is not None and description.actuation != "torque":
        raise InputError("--run-up: a robot with servos hops from a stand")
    if order.run_up is not None and order.gravity != GRAVITY:
        raise InputError(f"--run-up: the walk is made for a gravity of {GRAVITY} m/s²")
    target = jump_target(order)
    description = _at_supply(description)
    curves = require_feasible(description, target)
    if not isinstance(curves, HopCurves):
        jump = JumpController(description, rate_hz, target)
        if order.run_up is None:
            return jump
        walk = TorqueWalker(description, rate_hz, speed=order.run_up)
        walk_on = TorqueWalker(description, rate_hz)
        return RunningJump(walk, jump, walk_on, rate_hz, RUN_UP_S)
    return ServoHop(description, rate_hz, curves)


def _at_supply(description: RobotDescription) -> RobotDescription:
    """With the stall torque and the no-load speed of its servos, at the robot's supply.

    Both grow with the voltage, as those of a DC motor do. Servos without a name keep the limits of
    the robot file.
    """
    joints = []
    for joint in description.joints:
        if joint.servo is not None and description.supply is not None:
            servo = find_servo_model(joint.servo)
            share = description.supply.voltage / servo.voltage
            torque, speed = share * servo.stall_torque, share * servo.no_load_speed
            joint = joint.model_copy(update={"torque_limit": torque, "velocity_limit": speed})
        joints.append(joint)
    return description.model_copy(update={"joints": tuple(joints)})


def jump_review(description: RobotDescription, controller: Jumper) -> JumpReview:
    """What report and picture of a jump are made from, beside its trace."""
    robot = RobotModel(description)

    def soles(trace: Trace, tick: int) -> Floats:
        base, turned = trace.base_position[tick], trace.base_orientation[tick]
        robot.set_state(Posture(base, turned, trace.joint_position[tick]))
        return robot.corner_positions.copy()

    review = JumpReview(lambda: controller.plan, soles, lambda: controller.torque_ratio)
    if isinstance(controller, RunningJump):
        return replace(review, span=lambda: controller.span)
    return review


def default_push_depth(robot: str, overrides: tuple[str, ...]) -> float:
    """How deep a robot crouches for its push if nobody says [m]."""
    description = load_robot(robot, overrides)
    leg = RobotModel(description).leg_length
    torque = description.actuation == "torque"
    return round((PUSH_DEPTH if torque else HopSettings().push_depth) * leg, 3)
