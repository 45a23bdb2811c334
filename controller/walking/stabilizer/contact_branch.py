"""Corner forces as an affine function of the extra torques, on the branch of full contact.

Corner forces are linear in the torques as long as the set of loaded corners stays the same. The
local response of a foot on its edge is therefore that of an edge, and points nowhere useful: its
lifted corners do not answer at all. The branch wanted is the one on which every corner carries
load, and the model's constraint rows give it directly, by treating all of them as active.
"""

import mujoco
import numpy as np

from controller.walking.stabilizer.response import ResponseModel
from hil.interface import Floats, Ints

_QUADRATIC = int(mujoco.mjtConstraintState.mjCNSTRSTATE_QUADRATIC)
PLACES = 5


def full_contact_branch(response: ResponseModel) -> tuple[Floats, Floats]:
    """f₀ [N], shape (5,), and G [N per N·m], shape (5, 3), of f = f₀ + G·u.

    With the rows J of the foot's contacts, sticking and bilateral, and of other active
    constraints, the forces solve (J·M⁻¹·Jᵀ + R)·f = a_ref − J·a₀(u) (MuJoCo manual, computation,
    constraint model), where a₀ is the acceleration without them. Valid where no force of f is
    negative and nothing slips. Must follow `ResponseModel.place`.
    """
    model, data, dofs = response.model, response.data, response.dofs
    if not response.rows:
        return np.zeros(PLACES), np.zeros((PLACES, 3))
    rows = _rows(response)
    jacobian = data.efc_J.reshape(-1, model.nv)[rows]
    answer = np.empty_like(jacobian)
    mujoco.mj_solveM(model, data, answer, jacobian)
    system = jacobian @ answer.T
    system.flat[:: len(rows) + 1] += data.efc_R[rows]
    sides = np.empty((len(rows), 4))
    sides[:, 0] = data.efc_aref[rows] - jacobian @ data.qacc_smooth
    sides[:, 1:] = -answer[:, dofs]
    solved = np.linalg.solve(system, sides)
    total = np.zeros((PLACES, 4))
    at = np.searchsorted(rows, [row for row, _, _ in response.rows])
    for k, (_, place, _) in zip(at, response.rows, strict=True):
        total[place] += solved[k]
    return total[:, 0], total[:, 1:]


def _rows(response: ResponseModel) -> Ints:
    """All rows of the foot's contacts and the other active ones, in order."""
    wanted = response.data.efc_state == _QUADRATIC
    sizes = response.data.contact.dim
    for row, _, contact in response.rows:
        wanted[row : row + sizes[contact]] = True
    found: Ints = np.flatnonzero(wanted)
    return found
