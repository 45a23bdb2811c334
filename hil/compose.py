"""The composition root: the one module that puts controller, drivers and simulation together."""

from datetime import UTC, datetime

from controller.estimation.sensors import SensorEstimator
from controller.estimation.truth import TruthEstimator
from controller.walking.servo_walker import ServoWalker
from controller.walking.torque_walker import TorqueWalker
from drivers.calibration import Provenance, RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from hil.description import RobotDescription, load_robot
from hil.errors import InputError
from hil.interface import Controller, Estimator, World
from hil.request import RunRequest
from hil.session import Session
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant


def build(request: RunRequest) -> Session:
    """Everything a run needs, unopened. Raises InputError for what cannot be put together."""
    description = load_robot(request.robot, request.overrides)
    resolved = request.resolved(description)
    return _on_mujoco(resolved, description)


def _on_mujoco(request: RunRequest, description: RobotDescription) -> Session:
    rate_hz = request.rate_hz or description.defaults.rate_hz
    mapping = None
    if description.actuation == "servo":
        mapping = GainMapping(description, _ideal_calibration(description))
    motors = None if mapping is None else mapping.motor_parameters()
    plant = Plant(description, rate_hz, request.seed, motors, _initial_velocity(request, description))
    backend = MujocoBackend(description, plant, mapping, rate_hz, request.seed)
    return Session(
        request, description, backend, _estimator(request, description, plant),
        _controller(request, description), plant,
    )


def _initial_velocity(request: RunRequest, description: RobotDescription) -> tuple[float, float]:
    if not description.start.moving:
        return 0.0, 0.0
    return _initial_speed(request, description), description.start.lateral_velocity


def _initial_speed(request: RunRequest, description: RobotDescription) -> float:
    return next((v for t, v in request.schedules.speed if t == 0.0), description.defaults.speed)


def _ideal_calibration(description: RobotDescription) -> RobotCalibration:
    today = datetime.now(UTC).date().isoformat()
    return RobotCalibration(robot=description.name,
                            provenance=Provenance(date=today, method="ideal"))


def _estimator(
    request: RunRequest, description: RobotDescription, world: World | None
) -> Estimator:
    rate_hz = request.rate_hz or description.defaults.rate_hz
    if request.estimator == "sensors":
        return SensorEstimator(description, rate_hz)
    if world is None:
        raise InputError("--estimator truth needs a simulated robot; a real one has sensors")
    return TruthEstimator(description, world.truth)


def _controller(request: RunRequest, description: RobotDescription) -> Controller:
    rate_hz = request.rate_hz or description.defaults.rate_hz
    ankle_limit = bool(request.ankle_limit)
    if description.actuation == "servo":
        return ServoWalker(description, rate_hz, ankle_limit)
    speed = _initial_speed(request, description)
    pd = request.pd or "explicit"
    return TorqueWalker(description, rate_hz, pd, ankle_limit, speed)
