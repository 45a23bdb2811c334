"""The volume of a robot that is under the level of a liquid, part by part.

Shared by the simulated liquid, which lifts the body by it, and by the controller, which
compensates that lift (seed 003_73fecd8ec8927aad, sections 4 and 5.3).
"""

import mujoco
import numpy as np

from hil.interface import Floats, Ints
from hil.solids import solid

WATER_DENSITY = 1000.0
"""[kg/m³]"""


class SubmergedParts:
    """V_i and its centroid of every geom of the robot's bodies, for a level above the floor.

    A cell at height z counts with clip((H − z)/(2η) + ½, 0, 1) of its volume. With half sizes h_i
    and the vertical e in its axes, η² = Σ(e_i·h_i)², which has the spread of the cell's heights.
    Exact for a part that is wholly in or out and for upright boxes at every level, otherwise
    converging with the cell. Geoms that overlap count twice. Reads positions of `data` that
    `mj_kinematics` has computed.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, root: int, cell: float) -> None:
        """`root` is the robot's root body, `cell` the size of a cell [m]. Raises InputError."""
        self.geoms = robot_geoms(model, root)
        """Parts, shape (p,)."""
        self.bodies: Ints = model.geom_bodyid[self.geoms].astype(np.int64)
        """Body of every part, shape (p,)."""
        solids = [solid(model, int(geom), cell) for geom in self.geoms]
        most = max(len(one.volumes) for one in solids)
        self._points = np.zeros((len(solids), most, 3))
        self._weights = np.zeros((len(solids), most, 4))
        for part, one in enumerate(solids):
            count = len(one.volumes)
            self._points[part, :count] = one.points
            self._weights[part, :count, 0] = one.volumes
            self._weights[part, :count, 1:] = one.volumes[:, None] * one.points
        self._half = np.array([one.half for one in solids])
        self._whole = np.array([one.volumes.sum() for one in solids])
        self._reach: Floats = model.geom_rbound[self.geoms]
        self._places, self._axes = data.geom_xpos, data.geom_xmat
        self.volumes = np.zeros(len(solids))
        """V_i of the last update [m³], shape (p,)."""
        self.centres = np.zeros((len(solids), 3))
        """Centroid of the part under the level [m], world axes, shape (p, 3); of the whole part
        where nothing is."""

    def update(self, level: float) -> None:
        """Compute volumes and centroids for a level [m] above the floor's origin."""
        self.centres[:] = self._places[self.geoms]
        depth = level - self.centres[:, 2]
        np.multiply(self._whole, depth > 0.0, out=self.volumes)
        (cut,) = np.nonzero(np.abs(depth) < self._reach)
        if cut.size:
            self._cut(cut, depth[cut])

    def _cut(self, cut: Ints, depth: Floats) -> None:
        axes = self._axes[self.geoms[cut]].reshape(-1, 3, 3)
        vertical = axes[:, 2]
        extent = 2.0 * np.sqrt(np.add.reduce((vertical * self._half[cut]) ** 2, axis=1))
        heights = np.matmul(self._points[cut], vertical[:, :, None])[..., 0]
        share = (depth[:, None] - heights) / extent[:, None] + 0.5
        np.clip(share, 0.0, 1.0, out=share)
        sums = np.matmul(share[:, None, :], self._weights[cut])[:, 0]
        volumes = sums[:, 0]
        self.volumes[cut] = volumes
        offsets = sums[:, 1:] / np.maximum(volumes, 1e-12)[:, None]
        self.centres[cut] += np.matmul(axes, offsets[:, :, None])[..., 0]


def robot_geoms(model: mujoco.MjModel, root: int) -> Ints:
    """Geoms of the root body and of everything that hangs on it, shape (p,)."""
    of_robot = model.body_rootid[model.geom_bodyid] == model.body_rootid[root]
    return np.flatnonzero(of_robot)
