"""What every reduced model predicts for the same state and torques: how far each is from M0."""

import time
from typing import get_args

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.stabilizer.config import ModelName
from controller.walking.stabilizer.model_choice import ModelChoice
from controller.walking.stabilizer.sample_box import NO_TORQUE
from hil.description import RobotDescription
from hil.interface import Estimate, Floats

NAMES: tuple[ModelName, ...] = get_args(ModelName)


class ModelComparison:
    """Error of a reduced model in a tick: Σ|F_i − F_i(M0)| over the corners and the toe.

    Seed 000_bd1305a0ae731442, section 5.1, which gives it as a share of Σ F_i(M0), both summed
    over a walk.
    """

    def __init__(self, description: RobotDescription, rate_hz: int) -> None:
        self._robot = RobotModel(description)
        self._models = [
            ModelChoice(name, description, self._robot, 1.0 / rate_hz) for name in NAMES
        ]
        self.names: tuple[str, ...] = NAMES
        """Models, M0 first."""
        self.errors = np.zeros(len(NAMES))
        """Sum of the errors of each model so far [N]."""
        self.load = 0.0
        """Sum of the load under M0 so far [N]."""
        self.sample_ns = np.zeros(len(NAMES))
        """Wall time spent on one further sample a tick, in all [ns]."""
        self.ticks = 0

    def add(self, estimate: Estimate, torques: Floats, stance: int, swing_contact: bool) -> None:
        """Compare one tick: torques of all joints [N·m], shape (n,), applied at an estimate."""
        self._robot.set_state(estimate)
        forces = []
        for place, choice in enumerate(self._models):
            model = choice.choose(stance, swing_contact)
            forces.append(model.place(torques, stance))
            begin = time.perf_counter_ns()
            model.forces(NO_TORQUE)
            self.sample_ns[place] += time.perf_counter_ns() - begin
        predicted = np.array(forces)
        self.errors += np.abs(predicted - predicted[0]).sum(axis=1)
        self.load += float(predicted[0].sum())
        self.ticks += 1
