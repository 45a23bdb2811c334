"""Points of a model's geoms: how low they reach, and what a foot stands on."""

import itertools

import mujoco
import numpy as np

from hil.interface import Floats

_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_G = mujoco.mjtGeom


def low_points(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Floats:
    """World points among which the lowest of a geom are [m], (k, 3): the corners of a box, the
    vertices of a mesh, the bottoms of round shapes. None of a plane or a height field.
    """
    kind, size = model.geom_type[geom], model.geom_size[geom]
    centre, axes = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
    down = np.array([0.0, 0.0, -1.0])
    points: Floats = np.empty((0, 3))
    if kind == _G.mjGEOM_BOX:
        points = centre + (_CORNERS * size) @ axes.T
    elif kind == _G.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        points = centre + np.asarray(model.mesh_vert[first : first + count]) @ axes.T
    elif kind == _G.mjGEOM_SPHERE:
        points = (centre + size[0] * down)[None, :]
    elif kind == _G.mjGEOM_CAPSULE:
        ends = np.array([1.0, -1.0])[:, None] * size[1] * axes[:, 2]
        points = centre + ends + size[0] * down
    elif kind == _G.mjGEOM_CYLINDER:
        points = centre + (_CORNERS * size[[0, 0, 1]]) @ axes.T
    elif kind == _G.mjGEOM_ELLIPSOID:
        points = (centre + down * np.linalg.norm(size * axes[2]))[None, :]
    return points


def lowest_points(model: mujoco.MjModel, data: mujoco.MjData) -> Floats:
    """Height of the lowest point of every body [m], (bodies,); its own origin where it has no
    shape.
    """
    heights = np.array(data.xpos[:, 2])
    for geom in range(model.ngeom):
        points = low_points(model, data, geom)
        body = model.geom_bodyid[geom]
        if points.size:
            heights[body] = min(heights[body], float(points[:, 2].min()))
    return heights
