"""Normal forces at the corners of both feet, from the contacts of a MuJoCo step."""

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats
from sim_backends.model import foot_geoms, named
from sim_backends.uneven_floor import feelers_of

_NONE, _TOE = -1, 2
"""Roles of geoms: left and right sole 0 and 1, left and right toe 2 and 3, others none."""
_CORNERS = 4


class FootLoads:
    """Reads the contacts between soles (and separate toes) and the static world.

    Each contact's normal force goes to the corner of the sole in whose quadrant its point lies,
    seen from the centre of the sole in the axes of the foot body: front is x ≥ 0, left is y ≥ 0.
    A feeler stays in its corner, so which that is, is known before.
    Valid between one mj_step and the next: forces, points and frames then all belong to the state
    before integration. With the dozen contacts of two feet, plain Python beats arrays here.
    It reads one MjData, whose arrays of fixed size it looks up once.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, description: RobotDescription
    ) -> None:
        self._model, self._data = model, data
        self._elliptic = model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        static = model.body_weldid[model.geom_bodyid] == 0
        self._static: list[bool] = static.tolist()
        self._role = [_NONE] * model.ngeom
        self._place = [_NONE] * model.ngeom
        """Where in the list of corners a feeler's force goes."""
        self._frames: list[tuple[Floats, Floats]] = []
        """Centre of each sole, and its foot's rotation matrix row by row."""
        feet = (description.feet["left"], description.feet["right"])
        names = [foot.sole for foot in feet] + [foot.toe for foot in feet]
        for role, name in enumerate(names):
            if name is not None:
                geom = named(model, mujoco.mjtObj.mjOBJ_GEOM, name, description.model_path)
                for touching in (geom, *feelers_of(model, name)):
                    self._role[touching] = role
                    if touching != geom and role < _TOE:
                        offset = (model.geom_pos[touching] - model.geom_pos[geom]).tolist()
                        self._place[touching] = _CORNERS * role + _quadrant(*offset[:2])
                if role < _TOE:
                    self._frames.append((data.geom_xpos[geom], data.xmat[model.geom_bodyid[geom]]))
        if max(self._place) != _NONE:  # With feelers the soles themselves touch nothing.
            self._frames.clear()
        self._wrench = np.zeros(6)

    def read(self) -> tuple[list[float], list[float]]:
        """Forces [N] of the step just made: four corners of each foot, and two toes."""
        corners, toes = [0.0] * 8, [0.0] * 2
        data = self._data
        if data.ncon:
            contact, static, places = data.contact, self._static, self._place
            points = contact.pos.tolist() if self._frames else []
            frames = [(centre.tolist(), axes.tolist()) for centre, axes in self._frames]
            addresses, forces = contact.efc_address.tolist(), data.efc_force.tolist()
            for i, (first, second) in enumerate(contact.geom.tolist()):
                geom = second if static[first] else first
                role, address = self._role[geom], addresses[i]
                ground = static[first] or static[second]
                if role == _NONE or not ground or address < 0:
                    continue
                force = forces[address] if self._elliptic else self._normal_force(i)
                if places[geom] != _NONE:
                    corners[places[geom]] += force
                elif role < _TOE:
                    corners[_CORNERS * role + _corner(points[i], frames[role])] += force
                else:
                    toes[role - _TOE] += force
        return corners, toes

    def _normal_force(self, contact: int) -> float:
        """Normal force of a pyramidal contact: its edges added up [N].

        An elliptic cone has the normal force in its first constraint row instead.
        """
        mujoco.mj_contactForce(self._model, self._data, contact, self._wrench)
        return float(self._wrench[0])


def _corner(point: list[float], frame: tuple[list[float], list[float]]) -> int:
    """Index of the corner in whose quadrant of the sole a point lies."""
    centre, axes = frame
    dx, dy, dz = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
    return _quadrant(
        axes[0] * dx + axes[3] * dy + axes[6] * dz, axes[1] * dx + axes[4] * dy + axes[7] * dz
    )


def _quadrant(forward: float, left: float) -> int:
    """Index of the corner on that side of the sole's centre."""
    return 2 * (forward < 0.0) + (left < 0.0)


def lowest_sole_point(
    model: mujoco.MjModel, data: mujoco.MjData, description: RobotDescription
) -> float:
    """Height of the lowest point of all soles and toes, by their boxes [m]."""
    lowest = np.inf
    for name in foot_geoms(description):
        geom = named(model, mujoco.mjtObj.mjOBJ_GEOM, name, description.model_path)
        centre, half = np.split(model.geom_aabb[geom], 2)
        up = data.geom_xmat[geom][6:9]
        bottom = data.geom_xpos[geom][2] + up @ centre - np.abs(up) @ half
        lowest = min(lowest, float(bottom))
    return lowest


def rise_to_ground(
    model: mujoco.MjModel, data: mujoco.MjData, description: RobotDescription
) -> float:
    """How far a robot at the origin must rise to stand on what is under it [m]."""
    height = -lowest_sole_point(model, data, description)
    if description.plant.platform is not None:
        x0, x1, y0, y1, top = description.plant.platform
        height += top if x0 <= 0.0 <= x1 and y0 <= 0.0 <= y1 else 0.0
    return height
