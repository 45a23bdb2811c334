"""The plain solver: torques that grow towards the unloaded sides."""

from controller.walking.stabilizer.evaluation import ACCEPTED
from controller.walking.stabilizer.problem import Problem, Solution


class ScanSolver:
    """Tries k/K of the box's roll and pitch, k = 1…K, towards sides that carry less than l.

    Roll presses the right edge down, pitch the front edge; the knee stays as it is. Ours.
    """

    def __init__(self, steps: int) -> None:
        self._steps = steps

    def solve(self, problem: Problem) -> Solution:
        """See `Solver`."""
        start, box, limit = problem.initial, problem.box, problem.evaluation.band
        roll = (start.right < limit) - (start.left < limit)
        pitch = ((start.front < limit) - (start.rear < limit)) if problem.flat else 0
        for k in range(1, self._steps + 1):
            part = k / self._steps
            reach = (
                part * (box.high[0] if pitch > 0 else -box.low[0]) * pitch,
                part * (box.high[1] if roll > 0 else -box.low[1]) * roll,
                0.0,
            )
            sample = box.clamped(reach)
            if problem.total(sample) < ACCEPTED:
                return Solution(sample, k, limited=k == self._steps)
        return Solution(None, self._steps, limited=True)
