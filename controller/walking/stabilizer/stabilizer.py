"""The ground contact stabilizer: load cells and model in, extra torques of the stance leg out."""

from dataclasses import dataclass

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.stabilizer.cma_solver import CmaSolver
from controller.walking.stabilizer.config import SolverName, StabilizerConfig
from controller.walking.stabilizer.distribution import distribution
from controller.walking.stabilizer.evaluation import Evaluation
from controller.walking.stabilizer.linear_solver import LinearSolver
from controller.walking.stabilizer.model_choice import ModelChoice
from controller.walking.stabilizer.problem import Problem, Solution, Solver, corrected
from controller.walking.stabilizer.sample_box import NO_TORQUE, Sample, sample_box
from controller.walking.stabilizer.scan_solver import ScanSolver
from controller.walking.stabilizer.trigger import triggered
from hil.description import RobotDescription
from hil.interface import SIDES, Floats

SAMPLE_JOINTS = ("ankle_pitch", "ankle_roll", "knee")
NOTHING = Solution(None, 0, limited=False)


@dataclass(slots=True)
class Statistics:
    """Counts over ticks with a loaded stance foot."""

    ticks: int = 0
    triggered: int = 0
    accepted: int = 0
    limited: int = 0
    iterations: int = 0
    evaluations: int = 0


class Stabilizer:
    """u = the first sample with f_eval < 1 when the foot is about to lose a side, else 0.

    The forces without and with a sample are the model's, plus what the load cells last showed
    beyond the model under the torques that were then applied: b ← b + c·(f_measured − f_model
    − b). So the cells give the distribution, moved on by one tick, and the model the response.
    """

    def __init__(
        self,
        config: StabilizerConfig,
        solver: SolverName,
        description: RobotDescription,
        robot: RobotModel,
        rate_hz: int,
    ) -> None:
        self._config = config
        self._models = ModelChoice(config.model, description, robot, 1.0 / rate_hz)
        self._solver = make_solver(solver, config)
        self._evaluation = Evaluation(config.band, config.load * robot.weight)
        self._scale = robot.weight * robot.leg_length
        self._limit = np.array([joint.torque_limit for joint in description.joints])
        self._least = -self._limit
        self._joints = [
            np.array([description.joint_names.index(f"{side}_{joint}") for joint in SAMPLE_JOINTS])
            for side in SIDES
        ]
        self._offset = [0.0] * 5
        self._predicted: list[float] | None = None
        self._stance = -1
        self._searching = False
        self.solution = NOTHING
        """Of the last tick."""
        self.statistics = Statistics()

    def add_torques(
        self,
        torques: Floats,
        stance: int,
        flat: bool,
        measured: list[float],
        swing_contact: bool,
    ) -> Sample:
        """Add the extra torques to the joint torques [N·m], shape (n,), in place.

        `measured` are the forces on the stance foot's corners and toe [N], of the last tick.
        Returns the extra torques of the three joints [N·m].
        """
        self._correct(stance, measured)
        self.solution = NOTHING
        self.statistics.ticks += 1
        response = self._models.choose(stance, swing_contact)
        if self._is_calm(measured, flat):
            self._predicted = None
            return NO_TORQUE
        np.minimum(torques, self._limit, out=torques)
        np.maximum(torques, self._least, out=torques)
        self._predicted = forces = response.place(torques, stance)
        initial = distribution(corrected(forces, self._offset))
        self._searching = False
        if triggered(self._config, self._evaluation, initial, flat):
            joints = self._joints[stance]
            room = _room(torques[joints].tolist(), self._limit[joints].tolist())
            box = sample_box(self._config, self._scale, initial, flat, room)
            self._searching = True
            problem = Problem(response, self._evaluation, box, initial, flat, self._offset)
            self._search(problem)
        extra = self.solution.sample
        if extra is None:
            return NO_TORQUE
        torques[self._joints[stance]] += extra
        return extra

    def _correct(self, stance: int, measured: list[float]) -> None:
        """Adopt a part of what the cells show beyond the last prediction; new foot, new start."""
        if stance != self._stance:
            self._stance, self._offset, self._predicted = stance, [0.0] * 5, None
            self._searching = False
        if self._predicted is None:
            return
        part = self._config.correction
        self._offset = [
            b + part * (cell - model - b)
            for b, cell, model in zip(self._offset, measured, self._predicted, strict=True)
        ]

    def _is_calm(self, measured: list[float], flat: bool) -> bool:
        """Whether all sides were loaded so well that this tick needs no model."""
        if self._searching:
            return False
        now = distribution(measured)
        least = min(now[: 4 if flat else 2])
        return now.total >= self._evaluation.least_load and least > self._config.calm

    def _search(self, problem: Problem) -> None:
        self.solution = found = self._solver.solve(problem)
        counts = self.statistics
        counts.triggered += 1
        counts.accepted += found.sample is not None
        counts.limited += found.limited
        counts.iterations += found.iterations
        counts.evaluations += problem.evaluations
        if found.sample is not None:
            self._predicted = problem.forces


def make_solver(name: SolverName, config: StabilizerConfig) -> Solver:
    """The solver of a name."""
    if name == "cma":
        return CmaSolver()
    if name == "scan":
        return ScanSolver(config.scan_steps)
    return LinearSolver(config.band)


def _room(torques: list[float], limits: list[float]) -> tuple[Sample, Sample]:
    """Least and largest extra torque within the joints' limits [N·m]."""
    low = [-limit - torque for torque, limit in zip(torques, limits, strict=True)]
    high = [limit - torque for torque, limit in zip(torques, limits, strict=True)]
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])
