"""The robot's outline from the side, drawn from its own model at recorded poses."""

from dataclasses import dataclass

import mujoco
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Polygon

from hil.convex_hull import convex_hull
from hil.description import RobotDescription
from hil.figure_style import BODY, LEFT, RIGHT
from hil.interface import Floats
from hil.posed_model import PosedModel
from hil.trace import Trace

CIRCLE = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


@dataclass(frozen=True, slots=True)
class Part:
    """One geom: points on its surface in its own frame, and how it is drawn."""

    geom: int
    body: int
    parent: int
    """Body to which the trunk goes on from here; the same one for limbs and root."""
    points: Floats
    """Shape (p, 3) [m]."""
    colour: str
    depth: float
    """Drawing order: the right side is nearer to the eye."""


class Outline:
    """Draws a robot at recorded poses, seen from its right."""

    def __init__(self, description: RobotDescription) -> None:
        self._body = PosedModel(description)
        self._model, self._root = self._body.model, description.root
        parts = [self._part(geom) for geom in range(self._model.ngeom)]
        self._parts = sorted((part for part in parts if part), key=lambda part: part.depth)

    def draw(self, axes: Axes, trace: Trace, tick: int, offset: float) -> None:
        """Add the outline of one tick, its root body at the abscissa `offset` [m]."""
        base, orientation = trace.base_position[tick], trace.base_orientation[tick]
        yaw = float(trace.yaw[tick])
        self.draw_posture(axes, base, orientation, trace.joint_position[tick], yaw, offset)

    def draw_posture(
        self,
        axes: Axes,
        base_position: Floats,
        base_orientation: Floats,
        joint_position: Floats,
        yaw: float,
        offset: float,
    ) -> None:
        """Add the outline of one posture, seen across the heading `yaw` [rad]."""
        self._body.place(base_position, base_orientation, joint_position)
        data = self._body.data
        # World axes to the picture's: along the heading, and up.
        view = np.array([[np.cos(yaw), np.sin(yaw), 0.0], [0.0, 0.0, 1.0]])
        origin = view @ base_position - [offset, base_position[2]]
        for part in self._parts:
            world = part.points @ data.geom_xmat[part.geom].reshape(3, 3).T
            outline = convex_hull((world + data.geom_xpos[part.geom]) @ view.T - origin)
            joints = (data.xpos[part.parent], data.xpos[part.body], data.geom_xpos[part.geom])
            bone = np.array(joints) @ view.T - origin
            order = 2.0 + part.depth
            axes.plot(*bone.T, color=part.colour, linewidth=2.0, zorder=order - 0.5)
            fill = (*to_rgb(part.colour), 0.9)
            axes.add_patch(
                Polygon(outline, facecolor=fill, edgecolor="white", linewidth=0.5, zorder=order)
            )

    def _part(self, geom: int) -> Part | None:
        model = self._model
        kind, size = model.geom_type[geom], model.geom_size[geom]
        points = surface_points(kind, size)
        body = int(model.geom_bodyid[geom])
        if points is None or body == 0 or model.geom_rgba[geom, 3] == 0:
            return None
        name = self._side(body)
        depth = {"left": 0.0, "": 1.0, "right": 2.0}[name]
        trunk = name == "" and model.body(body).name != self._root
        parent = int(model.body_parentid[body]) if trunk else body
        return Part(
            geom, body, parent, points, {"left": LEFT, "right": RIGHT, "": BODY}[name], depth
        )

    def _side(self, body: int) -> str:
        """Side of a limb by the name of its body or of the nearest parent that says one."""
        while body:
            name = str(self._model.body(body).name)
            for side in ("left", "right"):
                if name.startswith(side):
                    return side
            body = int(self._model.body_parentid[body])
        return ""


def surface_points(kind: int, size: Floats) -> Floats | None:
    """Points whose convex hull is the geom, in its own frame; None for planes and meshes."""
    ring = np.column_stack((np.cos(CIRCLE), np.sin(CIRCLE), np.zeros_like(CIRCLE)))
    types = mujoco.mjtGeom
    if kind == types.mjGEOM_BOX:
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return np.asarray(signs * size)
    ball = np.vstack([ring * np.sin(t) + [0, 0, np.cos(t)] for t in np.linspace(0, np.pi, 13)])
    if kind == types.mjGEOM_SPHERE:
        return np.asarray(ball * size[0])
    if kind == types.mjGEOM_ELLIPSOID:
        return np.asarray(ball * size)
    if kind == types.mjGEOM_CAPSULE:
        ends = np.array([0.0, 0.0, size[1]])
        return np.vstack((ball * size[0] + ends, ball * size[0] - ends))
    if kind == types.mjGEOM_CYLINDER:
        ends = np.array([0.0, 0.0, size[1]])
        return np.vstack((ring * size[0] + ends, ring * size[0] - ends))
    return None
