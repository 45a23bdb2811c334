"""Reduced models side by side: the forces that each predicts for the same tick, and its time.

Seed 000_bd1305a0ae731442, section 5.1 and Fig. 1: the error of the ground reaction force that
M1-M6 estimate, against M0.
"""

import time
from dataclasses import dataclass

import numpy as np

from controller.robot_model import BodyState, RobotModel
from controller.walking.stabilizer.config import ModelName
from controller.walking.stabilizer.model_choice import ModelChoice
from controller.walking.stabilizer.sample_box import NO_TORQUE
from hil.description import RobotDescription
from hil.interface import Floats

MODELS: tuple[ModelName, ...] = ("M0", "M1", "M2", "M3", "M4", "M5", "M6")


@dataclass(frozen=True, slots=True)
class ModelAccuracy:
    """One model over all ticks that were compared."""

    name: ModelName
    ticks: int
    error_pct: float
    """Mean of Σ|f − f_M0| over corners and toe, relative to the mean of Σ f_M0."""
    share_error: float
    """Mean error of the shares left, right, front and rear, absolute."""
    place_us: float
    """Mean time of a state with its first forces [µs]."""
    sample_us: float
    """Mean time of one sample more [µs]."""


class ModelComparison:
    """Feed it the ticks of a walk; it answers with one `ModelAccuracy` a model.

    Ticks whose stance foot carries less than `least_load` (a fraction of the weight) in M0 are
    left out. It changes nothing in the walk: it holds a robot model of its own.
    """

    def __init__(
        self, description: RobotDescription, rate_hz: int, least_load: float = 0.145
    ) -> None:
        self._robot = RobotModel(description)
        self._models = {
            name: ModelChoice(name, description, self._robot, 1.0 / rate_hz) for name in MODELS
        }
        self._least = least_load * self._robot.weight
        self._forces: dict[ModelName, list[Floats]] = {name: [] for name in MODELS}
        self._times: dict[ModelName, Floats] = {name: np.zeros(2) for name in MODELS}
        self._calls = 0

    def forces(
        self, state: BodyState, torques: Floats, stance: int, swing_contact: bool
    ) -> dict[ModelName, Floats]:
        """Forces on the stance foot's corners and toe [N], (5,) each, of a tick.

        `state` is an estimate or truth, `torques` [N·m], shape (n,), are those applied in it.
        """
        self._robot.set_state(state)
        self._calls += 1
        result: dict[ModelName, Floats] = {}
        for name, models in self._models.items():
            model = models.choose(stance, swing_contact)
            begin = time.perf_counter_ns()
            forces = model.place(torques, stance)
            placed = time.perf_counter_ns()
            model.forces(NO_TORQUE)
            self._times[name] += (placed - begin, time.perf_counter_ns() - placed)
            result[name] = np.array(forces)
        if result["M0"].sum() >= self._least:
            for name, vector in result.items():
                self._forces[name].append(vector)
        return result

    def accuracy(self) -> list[ModelAccuracy]:
        """Errors and times of all models so far; empty without a loaded tick."""
        reference = np.array(self._forces["M0"])
        if not len(reference):
            return []
        shares = _shares(reference)
        ticks = len(reference)
        table = []
        for name in MODELS:
            found = np.array(self._forces[name])
            error = float(np.abs(found - reference).sum() / reference.sum())
            share_error = float(np.abs(_shares(found) - shares).mean())
            place, sample = (self._times[name] / self._calls / 1e3).tolist()
            table.append(ModelAccuracy(name, ticks, 100.0 * error, share_error, place, sample))
        return table


def _shares(forces: Floats) -> Floats:
    """Shares left, right, front and rear of forces of shape (T, 5); shape (T, 4)."""
    front_left, front_right, rear_left, rear_right, toe = forces.T
    sole = np.maximum(forces[:, :4].sum(axis=1), 1e-9)
    total = np.maximum(forces.sum(axis=1), 1e-9)
    return np.stack(
        (
            (front_left + rear_left) / sole,
            (front_right + rear_right) / sole,
            (front_left + front_right + toe) / total,
            (rear_left + rear_right) / total,
        ),
        axis=1,
    )
