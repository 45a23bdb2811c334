"""Our solver: a quadratic program on the affine response of full contact, checked by the model."""

import numpy as np

from controller.walking.stabilizer.contact_branch import full_contact_branch
from controller.walking.stabilizer.evaluation import ACCEPTED
from controller.walking.stabilizer.problem import Problem, Solution
from controller.walking.stabilizer.quadratic_program import nearest
from hil.interface import Floats

AIM = 0.01
"""Share by which the program aims beyond l: what it does not know should not cost a round."""
ROUNDS = 3
"""Programs solved at most."""
TOLERANCE = 1e-3
"""Of the program, as a part of F_all."""


class LinearSolver:
    """Smallest torques (in box widths) with r_side ≥ l on every side and no corner below zero.

    r_side ≥ l is linear in the forces, F_side − l·F_all ≥ 0, hence in the torques on the branch
    f = f₀ + G·u of full contact. One evaluation of the real, unilateral and slipping response
    accepts or refuses the result. A refused one corrects f₀ by what it shows (chord method: G
    stays), where a corner that stays lifted shows that its force on the branch is not positive.
    """

    def __init__(self, band: float) -> None:
        self._margins = [side_margins(band + AIM, flat) for flat in (False, True)]

    def solve(self, problem: Problem) -> Solution:
        """See `Solver`."""
        base, response = full_contact_branch(problem.response)
        base += problem.offset
        sides = self._margins[problem.flat]
        low, high = np.array(problem.box.low), np.array(problem.box.high)
        scale = 0.5 * (high - low)
        per_load = sides / max(problem.initial.total, 1e-9)
        matrix = per_load @ (response * scale)
        for k in range(1, ROUNDS + 1):
            unit = np.array(nearest(matrix, -(per_load @ base), TOLERANCE))
            sample = problem.box.clamped((scale * unit).tolist())
            if problem.total(sample) < ACCEPTED:
                return Solution(sample, k, limited=False)
            found = np.array(problem.corrected)
            base = _corrected_base(base, response @ np.array(sample), found)
        return Solution(None, ROUNDS, limited=True)


def _corrected_base(base: Floats, change: Floats, found: Floats) -> Floats:
    """f₀ that explains the forces found for a sample whose response is `change`."""
    expected = base + change
    shown = (found > 0.0) | (expected > 0.0)
    corrected: Floats = np.where(shown, found - change, base)
    return corrected


def side_margins(band: float, flat: bool) -> Floats:
    """Rows that must not be negative on the forces (…corners, toe): sides, corners and toe."""
    front_left, front_right, rear_left, rear_right, toe = np.eye(5)
    sole = front_left + front_right + rear_left + rear_right
    left, right = front_left + rear_left, front_right + rear_right
    rows = [left - band * sole, right - band * sole]
    if flat:
        foot = sole + toe
        rows += [front_left + front_right + toe - band * foot]
        rows += [rear_left + rear_right - band * foot]
    return np.array([*rows, *np.eye(5)])
