"""Jumps put together: what the plant needs for one, its controller, and what became of it."""

import numpy as np

from controller.jumping.feasibility import require_feasible
from controller.jumping.jump_controller import JumpController
from controller.jumping.jump_settings import JumpSettings
from controller.jumping.path import JumpTarget
from controller.jumping.servo_hop import ServoHop
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Floats
from hil.jump_order import JumpOrder
from hil.jump_report import JumpReview, Placed
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.trace import Trace

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


def jump_controller(
    order: JumpOrder, description: RobotDescription, rate_hz: int
) -> JumpController | ServoHop:
    """The controller of a jump that the actuators can do; anything else raises InputError."""
    target = jump_target(order)
    curves = require_feasible(description, target)
    if description.actuation == "torque":
        return JumpController(description, rate_hz, target)
    if order.target[2] != 0.0:
        raise InputError("--target: a robot with servos hops on the level: Z must be 0")
    pace = float(np.sqrt(order.gravity / RobotModel(description).leg_length))
    return ServoHop(description, rate_hz, curves, pace)


def jump_review(description: RobotDescription, controller: JumpController | ServoHop) -> JumpReview:
    """What report and picture of a jump are made from, beside its trace."""
    robot = RobotModel(description)

    def soles(trace: Trace, tick: int) -> Floats:
        robot.set_state(Placed(trace, tick))
        return robot.corner_positions.copy()

    return JumpReview(lambda: controller.plan, soles, lambda: controller.torque_ratio)


def default_push_depth(robot: str, overrides: tuple[str, ...]) -> float:
    """How deep a robot crouches for its push if nobody says [m]: 0.32 of its leg, or what bent
    knees leave a servo robot.
    """
    description = load_robot(robot, overrides)
    leg = RobotModel(description).leg_length
    deep = 0.32 if JumpSettings.of(description).lean > 0.0 else 0.14
    return round(deep * leg, 3)
