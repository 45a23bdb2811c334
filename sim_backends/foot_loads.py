"""Normal forces at the corners of both feet, from the contacts of a MuJoCo step."""

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats, Ints
from sim_backends.model import named

_NONE, _TOE = -1, 2
"""Roles of geoms: no foot; left and right sole are 0 and 1, left and right toe 2 and 3."""


class FootLoads:
    """Reads the contacts between soles (and separate toes) and the static world.

    Each contact's normal force goes to the corner of the sole in whose quadrant its point lies,
    seen from the centre of the sole in the axes of the foot body:
    front is x ≥ 0, left is y ≥ 0. Valid between one mj_step and the next: forces, points and
    frames then all belong to the state before integration.
    """

    def __init__(self, model: mujoco.MjModel, description: RobotDescription) -> None:
        self._model = model
        self._role = np.full(model.ngeom, _NONE)
        self._ground = model.body_weldid[model.geom_bodyid] == 0
        for side, foot in enumerate((description.feet["left"], description.feet["right"])):
            self._assign(foot.sole, side, description)
            if foot.toe is not None:
                self._assign(foot.toe, _TOE + side, description)
        self._elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        self._none: tuple[Floats, Floats] = (np.zeros((2, 4)), np.zeros(2))

    def _assign(self, geom: str, role: int, description: RobotDescription) -> None:
        found = named(self._model, mujoco.mjtObj.mjOBJ_GEOM, geom, description.model_path)
        self._role[found] = role

    def read(self, data: mujoco.MjData) -> tuple[Floats, Floats]:
        """Corner forces (2, 4) and toe forces (2,) [N] of the step just made."""
        if data.ncon == 0:
            return self._none
        contact = data.contact
        geoms = contact.geom
        roles = self._role[geoms].max(axis=1)
        address = contact.efc_address
        touching = (roles != _NONE) & self._ground[geoms].any(axis=1) & (address >= 0)
        index = np.flatnonzero(touching)
        if index.size == 0:
            return self._none
        geoms, roles = geoms[index], roles[index]
        force = self._normal_forces(data, index, address[index])
        # The foot's geom is the one that is not the ground.
        foot = np.where(self._ground[geoms[:, 0]], geoms[:, 1], geoms[:, 0])
        bins = roles * 4 + self._corner(data, contact.pos[index], foot)
        sums: Floats = np.bincount(bins, weights=force, minlength=16).astype(np.float64)
        return sums[:8].reshape(2, 4), sums[8:].reshape(2, 4).sum(axis=1)

    def _corner(self, data: mujoco.MjData, points: Floats, geoms: Ints) -> Ints:
        """Index of the corner whose quadrant each point lies in, shape (contacts,)."""
        offset = points - data.geom_xpos[geoms]
        axes = data.xmat[self._model.geom_bodyid[geoms]]
        x = (axes[:, 0::3] * offset).sum(axis=1)
        y = (axes[:, 1::3] * offset).sum(axis=1)
        corner: Ints = 2 * (x < 0) + (y < 0)
        return corner

    def _normal_forces(self, data: mujoco.MjData, index: Ints, address: Ints) -> Floats:
        """Normal force of each contact [N].

        An elliptic cone has it in its first row. A pyramidal one spreads it over its edges,
        which MuJoCo's mj_contactForce adds up.
        """
        if self._elliptic:
            rows: Floats = data.efc_force[address]
            return rows
        wrench = np.zeros(6)
        force = np.empty(index.size)
        for k, contact in enumerate(index):
            mujoco.mj_contactForce(self._model, data, int(contact), wrench)
            force[k] = wrench[0]
        return force
