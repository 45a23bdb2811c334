"""Controller, drivers and simulation of one run, put together as its request says."""

from collections.abc import Mapping
from contextlib import ExitStack
from datetime import UTC, datetime
from typing import Any

from controller.estimation.hanging import HangingEstimator
from controller.estimation.sensors import SensorEstimator
from controller.estimation.truth import TruthEstimator
from controller.holding import PoseHolder
from controller.walking.servo_walker import ServoWalker
from controller.walking.torque_walker import TorqueWalker
from drivers.calibration import RobotCalibration, load_calibration
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.motor_constants import motor_parameters
from drivers.robot_backend import BusBackend
from hil.bringup.ladder import calibration_file, on_the_ground, require_hoisted_walk
from hil.clock import MonotonicClock
from hil.compose.jumps import Jumper, jump_changes, jump_controller, jump_review
from hil.description import RobotDescription
from hil.errors import DescriptionError, InputError
from hil.interface import Controller, Estimator, WalkStatus, World
from hil.request import DEFAULT_SOLVER, RunRequest
from hil.robot_files import load_robot
from hil.servo import MotorParameters
from hil.session import Session
from hil.start_plan import sit_position
from hil.submerged import WATER_DENSITY
from hil.validation import validate
from sim_backends.draws import hidden_values
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant
from sim_backends.virtual.remote import RemoteWorld, ServerProcess, VirtualPorts
from sim_backends.virtual.robot import VirtualRobot


def build(request: RunRequest) -> Session:
    """Everything a run needs, not open yet. Raises InputError for what does not fit together, and
    for a walk on the ground of a real robot that has not passed one in the air.
    """
    more = {
        "plant.ball=true": bool(request.schedules.balls),
        "plant.hoist=true": request.hoisted and not request.live,
    }
    jump = () if request.jump is None else jump_changes(request, request.jump)
    added = (change for change, wanted in more.items() if wanted)
    overrides = (*jump, *request.overrides, *added)
    request = request.model_copy(update={"overrides": overrides})
    session = build_robot(request, load_robot(request.robot, overrides))
    if on_the_ground(session):
        require_hoisted_walk(session)
    return session


def build_robot(request: RunRequest, description: RobotDescription) -> Session:
    """`build` for a description that is no file's."""
    resolved = request.resolved(description)
    description = description.at_rate(control_rate(resolved))
    if resolved.backend == "mujoco":
        return _on_mujoco(resolved, description)
    if resolved.bus == "real":
        return _on_real_bus(resolved, description)
    if resolved.realtime:
        return _on_terminals(resolved, description)
    return _in_lockstep(resolved, description)


def _on_mujoco(request: RunRequest, description: RobotDescription) -> Session:
    if request.realtime:
        raise InputError("--realtime belongs to --backend bus: it paces a robot behind ports")
    rate_hz, seed = control_rate(request), request.seed
    velocity = (0.0, 0.0)
    stands = request.jump is not None and request.jump.run_up is None
    if description.start.moving and not stands:
        velocity = (_initial_speed(request, description), description.start.lateral_velocity)
    mapping, motors = None, None
    if description.actuation == "servo":
        mapping = GainMapping(description, ideal_calibration(description, {}))
        motors = nominal_motors(description)
    plant = Plant(description, rate_hz, seed, motors, velocity)
    backend = MujocoBackend(description, plant, mapping, rate_hz, seed)
    return _session(request, description, backend, plant, figures=plant.figures)


def _in_lockstep(request: RunRequest, description: RobotDescription) -> Session:
    """The dry run: the real driver on a virtual robot, both on the virtual clock."""
    rate_hz, seed = control_rate(request), request.seed
    plant = Plant(description, rate_hz, seed, nominal_motors(description))
    robot = VirtualRobot(description, plant, seed, rate_hz)
    robot.faults.plan(request.faults)
    calibration = ideal_calibration(description, robot.calibration_data)
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
    server = ServerProcess(request.robot, control_rate(request), request.seed, request.overrides)
    return on_virtual_robot(request, description, server)


def on_virtual_robot(
    request: RunRequest, description: RobotDescription, server: VirtualPorts
) -> Session:
    """A run on a virtual robot in another process, which is told to end with the session."""
    rate_hz = control_rate(request)
    with ExitStack() as stack:
        stack.callback(server.close)
        world = RemoteWorld(server.control)
        stack.callback(world.close)
        if request.faults:
            world.plan_faults(request.faults)
        if request.schedules.water:
            world.set_medium(0.0, WATER_DENSITY, 1.0)  # cut into elements before anything moves
        calibration = ideal_calibration(description, world.calibration_data)
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
        **{name: bus.port for name, bus in description.buses.items()},
        **{name: board.port for name, board in description.boards.items()},
        **request.ports,
    }
    unknown = [name for name, port in ports.items() if port is None]
    if unknown:
        kind = "buses" if unknown[0] in description.buses else "boards"
        raise DescriptionError(
            description.file, f"{kind}.{unknown[0]}.port", "is missing: a real robot has a port "
            f"for each bus and board (missing here: {', '.join(unknown)}); write it there, or "
            "give --port NAME=DEVICE"
        )  # fmt: skip
    file = calibration_file(description)
    calibration = load_calibration(file)
    backend = BusBackend(
        description,
        MonotonicClock(),
        control_rate(request),
        {name: port for name, port in ports.items() if port is not None},
        calibration,
        GainMapping(description, calibration),
        guarded=True,
    )
    session = _session(request, description, backend, None)
    session.meta["calibration"] = {"file": str(file), "identity": calibration.identity()}
    return session


def _session(
    request: RunRequest,
    description: RobotDescription,
    backend: MujocoBackend | BusBackend,
    world: World | None,
    **more: Any,
) -> Session:
    controller = make_controller(request, description)
    estimator = make_estimator(request, description, world, controller.status)
    hidden = hidden_values(description, request.seed).as_dict() if world is not None else {}
    meta = {"hidden": hidden}
    if isinstance(controller, Jumper):
        more["jump"] = jump_review(description, controller)
    if isinstance(backend, BusBackend) and not request.lockstep:
        more["watch"] = lambda: "guardian lost" if backend.guardian_lost() else None
    return Session(request, description, backend, estimator, controller, world, meta, **more)


def make_estimator(
    request: RunRequest, description: RobotDescription, world: World | None, status: WalkStatus
) -> Estimator:
    """What makes estimates in a resolved request's run; `status` is its controller's."""
    hangs = request.hoisted or request.activity in ("stand", "sit")
    if request.estimator == "sensors" and hangs:
        return HangingEstimator(description, control_rate(request), status)
    if request.estimator == "sensors":
        return SensorEstimator(description, control_rate(request))
    if world is None:
        raise InputError("--estimator truth needs a simulated robot; a real one has sensors")
    return TruthEstimator(description, world.truth)


def make_controller(request: RunRequest, description: RobotDescription) -> Controller:
    """The controller of a resolved request."""
    rate_hz, ankle_limit = control_rate(request), bool(request.ankle_limit)
    if request.activity == "stand":
        return PoseHolder(description, description.start_position)
    if request.activity == "sit":
        return PoseHolder(description, sit_position(description))
    if request.jump is not None:
        return jump_controller(request.jump, description, rate_hz)
    if description.actuation == "servo":
        return ServoWalker(description, rate_hz, ankle_limit, hoisted=request.hoisted)
    return TorqueWalker(
        description,
        rate_hz,
        request.pd or "explicit",
        ankle_limit,
        _initial_speed(request, description),
        bool(request.stabilizer),
        request.stabilizer_solver or DEFAULT_SOLVER,
    )


def control_rate(request: RunRequest) -> int:
    """Control rate of a resolved request [Hz]."""
    if request.rate_hz is None:
        raise InputError("--rate: the robot has no default rate")
    return request.rate_hz


def _initial_speed(request: RunRequest, description: RobotDescription) -> float:
    at_start = (speed for time_s, speed in request.schedules.speed if time_s == 0.0)
    speed, limit = next(at_start, description.defaults.speed), description.start.speed_limit
    return speed if limit is None else max(-limit, min(speed, limit))


def ideal_calibration(description: RobotDescription, data: Mapping[str, Any]) -> RobotCalibration:
    """What a virtual robot's calibration would find, but for the errors that its seed draws.

    Servos that were identified are the file's, for a virtual robot as for a real one.
    """
    provenance = {"date": datetime.now(UTC).date(), "method": "ideal"}
    content = {"robot": description.name, "provenance": provenance, **data}
    where = f"calibration of the virtual {description.name}"
    calibration = validate(RobotCalibration, content, where)
    if description.calibration is None:
        return calibration
    found = load_calibration(calibration_file(description))
    return calibration.model_copy(update={"servos": found.servos})


def nominal_motors(description: RobotDescription) -> MotorParameters:
    """The data sheet's, from which a seed draws what a virtual robot has."""
    ideal = ideal_calibration(description, {})
    return motor_parameters(description, ideal.model_copy(update={"servos": {}}))
