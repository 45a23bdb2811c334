"""Parasitic drag, form drag and friction in one, on the wetted elements of every body.

Seed 003_73fecd8ec8927aad, section 4: F_D = ½ρv²·A_n·C_d·μ, element by element, with C_d = 1.
"""

import mujoco
import numpy as np

from hil.interface import Floats, Ints
from sim_backends.water.surface import body_surface

DRAG_COEFFICIENT = 1.0
"""C_d: the seed's mean value for a man."""


def _resistance_map() -> Floats:
    """From (m, s, S_xx, S_yy, S_zz, S_xy, S_xz, S_yz) to the entries of D, shape (10, 36)."""
    entries = np.zeros((10, 6, 6))
    entries[0, :3, :3] = np.eye(3)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        entries[1 + i, 3 + k, j], entries[1 + i, 3 + j, k] = 1.0, -1.0  # [s]×
        entries[1 + i, j, 3 + k], entries[1 + i, k, 3 + j] = 1.0, -1.0  # its transpose
        entries[4 + i, 3 + j, 3 + j] = entries[4 + i, 3 + k, 3 + k] = 1.0
    for row, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), start=7):
        entries[row, 3 + i, 3 + j] = entries[row, 3 + j, 3 + i] = -1.0
    return entries.reshape(10, 36)


RESISTANCE = _resistance_map()


class Drag:
    """Wrenches of the liquid's resistance on a set of bodies.

    An element with normal n and area dS whose point p moves at u through the liquid shows it the
    area A_n = dS·max(n·u/|u|, 0) and feels −½ρμC_d·dS·max(n·u, 0)·u: along n that is form drag,
    across it friction. With u = v + ω × p the wrench of a body is that of a rigid cloud of masses
    c = k·dS·max(n·u, 0)·wet, of which only the mass m = Σc, the first moment s = Σc·p and the
    second moment S = Σc·p·pᵀ are needed: F = −(m·v + ω × s), T = −(s × v + (tr S)·ω − S·ω), or
    −D·(v, ω) with D = [[m·1, [s]×ᵀ], [[s]×, (tr S)·1 − S]].
    Everything is in the inertial frames of the bodies. An element is wet by the share of its
    height that is under the level, taken as ± half a cell.
    """

    def __init__(self, model: mujoco.MjModel, bodies: Ints, cell: float) -> None:
        surfaces = [body_surface(model, int(body), cell) for body in bodies]
        self._counts = [len(one.areas) for one in surfaces]
        most = max(self._counts)
        self._views = np.zeros((len(bodies), 9, most))
        self._moments = np.zeros((len(bodies), most, 10))
        for row, one in enumerate(surfaces):
            p, n, count = one.points, one.normals, self._counts[row]
            self._views[row, :, :count] = np.hstack((n, np.cross(p, n), p)).T
            x, y, z = p.T
            columns = (np.ones(count), x, y, z, x * x, y * y, z * z, x * y, x * z, y * z)
            self._moments[row, :count] = one.areas[:, None] * np.column_stack(columns)
        self._slope = 1.0 / cell
        self.elements = 0
        """Elements of the bodies chosen."""
        self.choose(np.arange(len(bodies)))

    def choose(self, rows: Ints) -> None:
        """Only these bodies are in the liquid; `wrenches` then takes as many rows."""
        counts = [self._counts[row] for row in rows]
        most = max(counts, default=0)
        self.elements = sum(counts)
        self._chosen_views = np.ascontiguousarray(self._views[rows, :, :most])
        self._chosen_moments = np.ascontiguousarray(self._moments[rows, :most])
        self._seen = np.zeros((len(rows), 2, 9))

    def wrenches(self, factor: float, depth: Floats, vertical: Floats, twist: Floats) -> Floats:
        """Force and torque on every chosen body in its own axes [N, N·m], shape (k, 2, 3).

        `factor` is ½ρμC_d [kg/m³], `depth` the level above each origin [m], (k,), `vertical` the
        world's z in the body's axes, (k, 3), `twist` its velocity and angular velocity, (k, 2, 3).
        """
        seen, motion = self._seen, twist.reshape(-1, 6)
        seen[:, 0, :6] = motion
        np.multiply(vertical, -self._slope, out=seen[:, 1, 6:])
        sight = np.matmul(seen, self._chosen_views)
        speed, wet = sight[:, 0], sight[:, 1]
        wet += (self._slope * depth + 0.5)[:, None]
        np.maximum(wet, 0.0, out=wet)
        np.minimum(wet, 1.0, out=wet)
        np.maximum(speed, 0.0, out=speed)
        speed *= wet
        sums = np.matmul(speed[:, None, :], self._chosen_moments)[:, 0]
        resistance = (sums @ RESISTANCE).reshape(-1, 6, 6)
        wrench: Floats = np.matmul(resistance, motion[:, :, None]).reshape(-1, 2, 3)
        wrench *= -factor
        return wrench
