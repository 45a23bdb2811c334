"""The liquid around a simulated robot: buoyancy and drag on every body, substep by substep."""

import mujoco
import numpy as np

from hil.interface import Bools, Floats
from hil.submerged import WATER_DENSITY, SubmergedParts
from sim_backends.water.drag import DRAG_COEFFICIENT, Drag
from sim_backends.water.impulse_limit import ImpulseLimit

CROSS = np.zeros((9, 3))
"""Maps the nine products a_i·b_j to a × b."""
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    CROSS[3 * _i + _j, _k], CROSS[3 * _j + _i, _k] = 1.0, -1.0


def cross(first: Floats, second: Floats) -> Floats:
    """Row by row first × second, shape (k, 3): numpy's own takes five times as long."""
    products = first[:, :, None] * second[:, None, :]
    result: Floats = products.reshape(-1, 9) @ CROSS
    return result


class Hydrodynamics:
    """Forces of a liquid at rest whose level is H above the floor.

    Buoyancy ρgV at the centroid of the submerged volume of every geom, and drag on its surface
    elements, limited so that it cannot add energy (seed 003_73fecd8ec8927aad, section 4). The
    forces are added to `xfrc_applied`, between `mj_step1` and `mj_step2`, and taken out again:
    other forces there stay what they are. MuJoCo's own medium (`opt.density`, `opt.viscosity`)
    stays at zero, or everything would count twice.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, root: int, cell: float) -> None:
        """`cell`: size of a surface element [m]; volumes take cells twice as large. Raises
        InputError for a geom that is no box, capsule or sphere."""
        self._model, self._data = model, data
        self._parts = SubmergedParts(model, data, root, 2.0 * cell)
        self.bodies = np.unique(self._parts.bodies)
        """Bodies with a volume, shape (k,)."""
        self._sums = (self.bodies[:, None] == self._parts.bodies).astype(np.float64)
        self._drag = Drag(model, self.bodies, cell)
        self._limit = ImpulseLimit(
            model.body_mass[self.bodies], model.body_inertia[self.bodies], model.opt.timestep
        )
        self._reach = self._reaches()
        self._com: Floats = data.subtree_com[model.body_rootid[root]]
        self._gravity = float(-model.opt.gravity[2])
        self._places, self._axes, self._motion = data.xipos, data.ximat, data.cvel
        self._applied, self._others = data.xfrc_applied, np.zeros_like(data.xfrc_applied)
        self._wet = np.ones(len(self.bodies), dtype=np.bool_)
        self._rows, self._wet_bodies = np.arange(len(self.bodies)), self.bodies
        self._twist = np.empty((len(self.bodies), 2, 3))
        self.wrenches = np.zeros((len(self.bodies), 2, 3))
        """Drag on every body of the last `act`: force and torque about its centre of mass, world
        axes [N, N·m], shape (k, 2, 3)."""
        self.buoyancy = np.zeros(len(self.bodies))
        """Upward force on every body of the last `act` [N], shape (k,)."""
        self.set_medium(0.0, WATER_DENSITY, 1.0)

    @property
    def elements(self) -> int:
        """Surface elements of the bodies that reach into the liquid."""
        return self._drag.elements

    def set_medium(self, level: float, density: float, viscosity: float) -> None:
        """Level above the floor [m], density [kg/m³] and viscosity factor, from now on."""
        self._level = level
        self._density = density
        self._factor = 0.5 * density * viscosity * DRAG_COEFFICIENT

    def act(self) -> None:
        """Add the liquid's forces, for the positions and velocities of `mj_step1`."""
        np.copyto(self._others, self._applied)
        places = self._places.take(self.bodies, axis=0)
        depth = self._level - places[:, 2]
        wet = depth > -self._reach
        if wet.tobytes() != self._wet.tobytes():
            self._choose(wet)
        self.wrenches[:], self.buoyancy[:] = 0.0, 0.0
        if self._rows.size:
            self._resist(places, depth)
            self._lift(places)

    def withdraw(self) -> None:
        """Take the forces of `act` out again."""
        np.copyto(self._applied, self._others)

    def _choose(self, wet: Bools) -> None:
        """These bodies reach into the liquid."""
        self._wet, self._rows = wet, np.flatnonzero(wet)
        self._wet_bodies = self.bodies[self._rows]
        self._twist = np.empty((len(self._rows), 2, 3))
        self._drag.choose(self._rows)

    def _resist(self, places: Floats, depth: Floats) -> None:
        rows, bodies, twist = self._rows, self._wet_bodies, self._twist
        axes = self._axes.take(bodies, axis=0).reshape(-1, 3, 3)
        motion = self._motion.take(bodies, axis=0)
        rate = motion[:, :3]
        lever = places.take(rows, axis=0)
        lever -= self._com
        np.add(motion[:, 3:], cross(rate, lever), out=twist[:, 0])
        twist[:, 1] = rate
        moved = np.matmul(twist, axes)
        wrench = self._drag.wrenches(self._factor, depth.take(rows), axes[:, 2], moved)
        self._limit.apply(wrench, moved, rows)
        wrench = np.matmul(wrench, axes.transpose(0, 2, 1))
        self.wrenches[rows] = wrench
        self._applied[bodies] += wrench.reshape(-1, 6)

    def _lift(self, places: Floats) -> None:
        parts = self._parts
        parts.update(self._level)
        lift = self._density * self._gravity * parts.volumes
        np.matmul(self._sums, lift, out=self.buoyancy)
        # (c − p) × B·ẑ = (c_y − p_y, p_x − c_x)·B, summed over the parts of a body.
        moments = self._sums @ (parts.centres[:, :2] * lift[:, None])
        moments -= places[:, :2] * self.buoyancy[:, None]
        force = np.zeros((len(self.bodies), 6))
        force[:, 2] = self.buoyancy
        force[:, 3] = moments[:, 1]
        np.negative(moments[:, 0], out=force[:, 4])
        self._applied[self.bodies] += force

    def _reaches(self) -> Floats:
        """Largest distance of any point of a body from its centre of mass [m], shape (k,)."""
        model, reach = self._model, np.zeros(len(self.bodies))
        for row, body in enumerate(self.bodies):
            for geom in np.flatnonzero(model.geom_bodyid == body):
                away = float(np.linalg.norm(model.geom_pos[geom] - model.body_ipos[body]))
                reach[row] = max(reach[row], away + float(model.geom_rbound[geom]))
        return reach
