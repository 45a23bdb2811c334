"""The composition root: the one module that puts controller, drivers and simulation together."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from controller.estimation.sensors import SensorEstimator
from controller.estimation.truth import TruthEstimator
from controller.walking.servo_walker import ServoWalker
from controller.walking.stabilizer.model_comparison import ModelComparison
from controller.walking.torque_walker import TorqueWalker
from drivers.assembly import bus_budgets
from drivers.bus_bench import BusMeasurement, measure_port, measure_robot
from drivers.calibration import RobotCalibration, load_calibration
from drivers.commissioning import workshop as commissioning
from drivers.dynamixel.gain_facts import feasible_gains, servo_facts
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.dynamixel.hot_path_bench import measure_hot_path
from drivers.identified_servo import keep_identified, require_identifiable
from drivers.motor_constants import motor_parameters
from drivers.robot_backend import BusBackend
from hil.clock import MonotonicClock
from hil.description import RobotDescription
from hil.errors import DescriptionError, InputError
from hil.fault_spec import FaultSpec
from hil.identify import Rig, joint_index
from hil.interface import Controller, Estimator, World
from hil.request import DEFAULT_SOLVER, RunRequest
from hil.robot_files import load_robot
from hil.servo import MotorParameters
from hil.session import Session
from hil.validation import validate
from sim_backends.draws import hidden_values
from sim_backends.hidden_servo import hidden_servo, joint_inertia
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant
from sim_backends.virtual.remote import RemoteWorld, ServerProcess
from sim_backends.virtual.robot import VirtualRobot
from sim_backends.virtual.server import run_server, stdin_is_pipe

__all__ = [
    "BusMeasurement",
    "build",
    "build_robot",
    "bus_budgets",
    "commissioning",
    "feasible_gains",
    "hoist",
    "measure_hot_path",
    "measure_port",
    "measure_robot",
    "model_comparison",
    "serve_virtual",
    "servo_facts",
    "servo_rig",
]

HOIST = 0.3
"""How high a virtual robot is lifted to be moved without touching the floor [m]."""


def build(request: RunRequest) -> Session:
    """Everything a run needs, not open yet. Raises InputError for what does not fit together."""
    if request.schedules.balls:
        overrides = (*request.overrides, "plant.ball=true")
        request = request.model_copy(update={"overrides": overrides})
    return build_robot(request, load_robot(request.robot, request.overrides))


def build_robot(request: RunRequest, description: RobotDescription) -> Session:
    """`build` for a description that is no file's."""
    resolved = request.resolved(description)
    if resolved.backend == "mujoco":
        return _on_mujoco(resolved, description)
    if resolved.bus == "real":
        return _on_real_bus(resolved, description)
    if resolved.realtime:
        return _on_terminals(resolved, description)
    return _in_lockstep(resolved, description)


def hoist(session: Session, joint: str) -> float:
    """Lift a simulated robot off its feet; the inertia at a joint, rotor included [kg·m²]."""
    if not isinstance(session.world, Plant):
        raise InputError("only a simulated robot in lockstep can be hoisted")
    session.world.hoist(HOIST)
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
        session.world.hoist(HOIST)
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
    return ModelComparison(description, _rate(request))


def serve_virtual(
    robot: str,
    rate_hz: int | None,
    seed: int,
    overrides: tuple[str, ...],
    as_json: bool,
    faults: Sequence[FaultSpec] = (),
) -> None:
    """Serve a virtual robot on pseudo-terminals in this process until it is told to stop."""
    description = load_robot(robot, overrides)
    if not description.buses:
        raise InputError(f"{description.name} has no servo bus to emulate")
    rate_hz = rate_hz or description.defaults.rate_hz
    run_server(description, rate_hz, seed, as_json, stdin_is_pipe(), faults)


def _on_mujoco(request: RunRequest, description: RobotDescription) -> Session:
    if request.realtime:
        raise InputError("--realtime belongs to --backend bus: it paces a robot behind ports")
    rate_hz, seed = _rate(request), request.seed
    velocity = (0.0, 0.0)
    if description.start.moving:
        velocity = (_initial_speed(request, description), description.start.lateral_velocity)
    mapping, motors = None, None
    if description.actuation == "servo":
        mapping = GainMapping(description, _ideal_calibration(description, {}))
        motors = _nominal_motors(description)
    plant = Plant(description, rate_hz, seed, motors, velocity)
    backend = MujocoBackend(description, plant, mapping, rate_hz, seed)
    return _session(request, description, backend, plant, figures=plant.figures)


def _in_lockstep(request: RunRequest, description: RobotDescription) -> Session:
    """The dry run: the real driver on a virtual robot, both on the virtual clock."""
    rate_hz, seed = _rate(request), request.seed
    plant = Plant(description, rate_hz, seed, _nominal_motors(description))
    robot = VirtualRobot(description, plant, seed, rate_hz)
    robot.faults.plan(request.faults)
    calibration = _ideal_calibration(description, robot.calibration_data)
    mapping = GainMapping(description, calibration)
    backend = BusBackend(description, robot.clock, rate_hz, robot.port_urls, calibration, mapping)
    session = _session(
        request,
        description,
        backend,
        plant,
        figures=plant.figures,
        closers=(robot.close,),
        begin_faults=robot.faults.begin if request.faults else None,
    )
    robot.start()
    return session


def _on_terminals(request: RunRequest, description: RobotDescription) -> Session:
    """The dry run in real time: the virtual robot is another process behind ptys."""
    rate_hz = _rate(request)
    with ExitStack() as stack:
        server = ServerProcess(request.robot, rate_hz, request.seed, request.overrides)
        stack.callback(server.close)
        world = RemoteWorld(server.control)
        stack.callback(world.close)
        if request.faults:
            world.plan_faults(request.faults)
        calibration = _ideal_calibration(description, world.calibration_data)
        mapping = GainMapping(description, calibration)
        backend = BusBackend(
            description,
            MonotonicClock(),
            rate_hz,
            server.port_urls,
            calibration,
            mapping,
            guarded=True,
        )
        closing = stack.pop_all()
    return _session(
        request,
        description,
        backend,
        world,
        figures=world.figures,
        closers=(closing.close,),
        begin_faults=world.begin_faults if request.faults else None,
    )


def _on_real_bus(request: RunRequest, description: RobotDescription) -> Session:
    ports = {
        **{f"buses.{name}": bus.port for name, bus in description.buses.items()},
        **{f"boards.{name}": board.port for name, board in description.boards.items()},
    }
    unknown = [key for key, port in ports.items() if port is None]
    if unknown:
        raise DescriptionError(
            description.file, f"{unknown[0]}.port", "is missing: a real robot has a port for each "
            f"bus and board (missing here: {', '.join(unknown)})"
        )  # fmt: skip
    if description.calibration is None:
        raise DescriptionError(description.file, "calibration", "is missing: a real robot has one")
    calibration = load_calibration(Path(description.file).parent / description.calibration)
    mapping = GainMapping(description, calibration)
    urls = {key.partition(".")[2]: port for key, port in ports.items() if port is not None}
    backend = BusBackend(
        description, MonotonicClock(), _rate(request), urls, calibration, mapping, guarded=True
    )
    return _session(request, description, backend, None)


def _session(
    request: RunRequest,
    description: RobotDescription,
    backend: MujocoBackend | BusBackend,
    world: World | None,
    **more: Any,
) -> Session:
    estimator = _estimator(request, description, world)
    controller = _controller(request, description)
    hidden = hidden_values(description, request.seed).as_dict() if world is not None else {}
    meta = {"hidden": hidden}
    if isinstance(backend, BusBackend) and not request.lockstep:
        more["watch"] = lambda: "guardian lost" if backend.guardian_lost() else None
    return Session(request, description, backend, estimator, controller, world, meta, **more)


def _estimator(
    request: RunRequest, description: RobotDescription, world: World | None
) -> Estimator:
    if request.estimator == "sensors":
        return SensorEstimator(description, _rate(request))
    if world is None:
        raise InputError("--estimator truth needs a simulated robot; a real one has sensors")
    return TruthEstimator(description, world.truth)


def _controller(request: RunRequest, description: RobotDescription) -> Controller:
    rate_hz, ankle_limit = _rate(request), bool(request.ankle_limit)
    if description.actuation == "servo":
        return ServoWalker(description, rate_hz, ankle_limit)
    return TorqueWalker(
        description,
        rate_hz,
        request.pd or "explicit",
        ankle_limit,
        _initial_speed(request, description),
        bool(request.stabilizer),
        request.stabilizer_solver or DEFAULT_SOLVER,
    )


def _rate(request: RunRequest) -> int:
    if request.rate_hz is None:
        raise InputError("--rate: the robot has no default rate")
    return request.rate_hz


def _initial_speed(request: RunRequest, description: RobotDescription) -> float:
    at_start = (speed for time_s, speed in request.schedules.speed if time_s == 0.0)
    speed, limit = next(at_start, description.defaults.speed), description.start.speed_limit
    return speed if limit is None else max(-limit, min(speed, limit))


def _ideal_calibration(description: RobotDescription, data: Mapping[str, Any]) -> RobotCalibration:
    """What a virtual robot's calibration would find, but for the errors that its seed draws.

    Servos that were identified are the file's, for a virtual robot as for a real one.
    """
    provenance = {"date": datetime.now(UTC).date(), "method": "ideal"}
    content = {"robot": description.name, "provenance": provenance, **data}
    where = f"calibration of the virtual {description.name}"
    calibration = validate(RobotCalibration, content, where)
    if description.calibration is None:
        return calibration
    found = load_calibration(Path(description.file).parent / description.calibration)
    return calibration.model_copy(update={"servos": found.servos})


def _nominal_motors(description: RobotDescription) -> MotorParameters:
    """The data sheet's, from which a seed draws what a virtual robot has."""
    ideal = _ideal_calibration(description, {})
    return motor_parameters(description, ideal.model_copy(update={"servos": {}}))
