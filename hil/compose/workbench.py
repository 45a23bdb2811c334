"""Robots put together for other things than a walk: to serve, to identify, to compare models."""

from collections.abc import Sequence

from controller.walking.stabilizer.model_comparison import ModelComparison
from drivers.identified_servo import keep_identified, require_identifiable
from drivers.motor_constants import motor_parameters
from drivers.robot_backend import BusBackend
from hil.compose.sessions import build_robot, control_rate
from hil.errors import InputError
from hil.fault_spec import FaultSpec
from hil.identify import Rig, joint_index
from hil.miswire import parse_miswires
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.session import Session
from sim_backends.hidden_servo import hidden_servo, joint_inertia
from sim_backends.plant import Plant
from sim_backends.virtual.server import run_server, stdin_is_pipe


def hoist(session: Session, joint: str) -> float:
    """Lift a simulated robot off its feet; the inertia at a joint, rotor included [kg·m²]."""
    if not isinstance(session.world, Plant):
        raise InputError("only a simulated robot in lockstep can be hoisted")
    session.world.hoist()
    return joint_inertia(session.world, session.description.joint_names.index(joint))


def servo_rig(request: RunRequest, joint: str) -> Rig:
    """A robot in the air whose joint is to be identified; a virtual one is hoisted.

    Raises InputError for what does not fit together, or a servo that measures no motor current.
    """
    description = load_robot(request.robot, request.overrides)
    index = joint_index(description.joint_names, joint)
    require_identifiable(description.joints[index])
    session = build_robot(request, description)
    backend = session.backend
    if not isinstance(backend, BusBackend):
        raise InputError("identify moves servos through the driver: use --backend bus")
    hidden = {}
    if isinstance(session.world, Plant):
        session.world.hoist()
        hidden = hidden_servo(session.world, index)
    calibration = backend.calibration
    return Rig(
        session,
        lambda: backend.goals,
        motor_parameters(description, calibration),
        calibration.offsets(description.joint_names),
        lambda path, found: keep_identified(
            description, calibration, path, joint, found.fit.as_dict(), found.method
        ),
        hidden,
    )


def model_comparison(request: RunRequest) -> ModelComparison:
    """The stabilizer's reduced models of a resolved request's robot, side by side."""
    description = load_robot(request.robot, request.overrides)
    return ModelComparison(description, control_rate(request))


def serve_virtual(
    robot: str,
    rate_hz: int | None,
    seed: int,
    overrides: tuple[str, ...],
    as_json: bool,
    faults: Sequence[FaultSpec] = (),
    miswire: Sequence[str] = (),
) -> None:
    """Serve a virtual robot on pseudo-terminals in this process until it is told to stop."""
    description = load_robot(robot, overrides)
    if not description.buses:
        raise InputError(f"{description.name} has no servo bus to emulate")
    rate_hz = rate_hz or description.defaults.rate_hz
    wrong = parse_miswires(miswire, description)
    run_server(description, rate_hz, seed, as_json, stdin_is_pipe(), faults, wrong)
