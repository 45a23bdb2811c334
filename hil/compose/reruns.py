"""Estimator and controller of a recorded run, without a robot behind them."""

from dataclasses import dataclass

from hil.compose.sessions import control_rate, make_controller, make_estimator
from hil.description import RobotDescription
from hil.interface import Controller, Estimator
from hil.request import RunRequest


@dataclass(frozen=True, slots=True)
class RerunParts:
    """What is run again."""

    estimator: Estimator | None
    """None where the run was told the simulation's truth: its estimates are then the recorded
    ones."""
    controller: Controller


def build_rerun(request: RunRequest, description: RobotDescription) -> RerunParts:
    """The parts of a run that need no backend, fresh from their start. Nothing is opened."""
    resolved = request.resolved(description)
    description = description.at_rate(control_rate(resolved))
    controller = make_controller(resolved, description)
    estimator = None
    if resolved.estimator == "sensors":
        estimator = make_estimator(resolved, description, None, controller.status)
    return RerunParts(estimator, controller)
