"""The twin of a recorded run: its goals, through the driver, to a virtual robot that is carried."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from drivers.dynamixel.replayed_goals import ReplayedGoals
from drivers.motor_constants import motor_parameters
from drivers.robot_backend import BusBackend
from hil.body_motion import BodyMotion
from hil.compose.sessions import control_rate, ideal_calibration, nominal_motors
from hil.description import RobotDescription
from hil.interface import AppliedCommand, Controller, Estimator, Floats
from hil.request import RunRequest
from hil.servo import MotorParameters
from hil.session import Session
from sim_backends.carried_plant import CarriedPlant
from sim_backends.draws import hidden_values
from sim_backends.virtual.robot import VirtualRobot


def driver_motors(description: RobotDescription) -> MotorParameters:
    """Constants that measured torques of a robot are made with: identified ones or nominal."""
    return motor_parameters(description, ideal_calibration(description, {}))


@dataclass(frozen=True, slots=True)
class TwinParts:
    """A virtual robot that waits for recorded goals."""

    session: Session
    applied: AppliedCommand
    """What the next write sends: filled before each one."""
    begin: Callable[[Floats], None]
    """Puts the joints where the encoders show these angles [rad], and lets the body move."""


def build_twin(
    request: RunRequest,
    description: RobotDescription,
    motion: BodyMotion,
    estimator: Estimator,
    controller: Controller,
    meta: dict[str, Any],
) -> TwinParts:
    """The parts of a replay, not open yet; as in a dry run, but for what moves body and goals.

    Raises InputError for a robot without servos, or with joints that are not in mode position.
    """
    resolved = request.resolved(description)
    rate_hz, seed = control_rate(resolved), resolved.seed
    plant = CarriedPlant(description, rate_hz, seed, nominal_motors(description), motion)
    robot = VirtualRobot(description, plant, seed, rate_hz)
    calibration = ideal_calibration(description, robot.calibration_data)
    goals = ReplayedGoals(description, calibration)
    backend = BusBackend(description, robot.clock, rate_hz, robot.port_urls, calibration, goals)
    hidden = hidden_values(description, seed).as_dict()
    session = Session(
        resolved,
        description,
        backend,
        estimator,
        controller,
        plant,
        {**meta, "hidden": hidden},
        figures=plant.figures,
        closers=(robot.close,),
    )
    robot.start()
    return TwinParts(session, goals.applied, plant.begin)
