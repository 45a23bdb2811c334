"""The model that the view draws, and the poses it is given."""

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from hil.body_motion import CORNERS
from hil.description import RobotDescription
from hil.interface import Floats
from hil.robot_facts import body_weight

AZIMUTH, ELEVATION = 140.0, -18.0
"""Of the camera at first [deg]."""
SQUARE = 0.2
"""Side of a square on the floor [m]."""
FLOOR = 10.0
"""Half side of the floor that is drawn [m]."""
SKY, HORIZON = (0.45, 0.60, 0.78), (0.88, 0.91, 0.94)
LIGHT, DARK = (0.72, 0.74, 0.77), (0.64, 0.66, 0.70)


def stage_model(description: RobotDescription) -> Any:
    """The robot's own MJCF on a floor whose squares show how far it goes, as an MjModel."""
    spec = mujoco.MjSpec.from_file(str(description.model_path))
    spec.add_texture(
        name="view_squares", type=mujoco.mjtTexture.mjTEXTURE_2D, width=256, height=256,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER, rgb1=LIGHT, rgb2=DARK,
    )  # fmt: skip
    spec.add_texture(
        name="view_sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, rgb1=SKY, rgb2=HORIZON,
    )  # fmt: skip
    repeat = 0.5 / SQUARE
    material = spec.add_material(name="view_floor", texrepeat=[repeat, repeat], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "view_squares"
    planes = [geom for geom in spec.geoms if geom.type == mujoco.mjtGeom.mjGEOM_PLANE]
    floor = planes[0] if planes else spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE)
    floor.size, floor.material, floor.rgba = [FLOOR, FLOOR, 0.05], "view_floor", [1, 1, 1, 1]
    height = float(spec.body(description.root).pos[2])
    spec.stat.extent, spec.stat.center = 3.0 * height, [0.0, 0.0, height]
    spec.visual.global_.azimuth, spec.visual.global_.elevation = AZIMUTH, ELEVATION
    return spec.compile()


@dataclass(frozen=True, slots=True)
class Sole:
    """A box sole."""

    geom: int
    half: Floats
    """Half size [m], (3,)."""


class Stage:
    """Puts a recorded pose into an MjData."""

    def __init__(self, description: RobotDescription, model: Any) -> None:
        self._free = int(model.jnt_qposadr[model.body(description.root).jntadr[0]])
        self._angles = [int(model.joint(name).qposadr[0]) for name in description.joint_names]
        feet = description.feet
        geoms = [int(model.geom(foot.sole).id) for foot in (feet["left"], feet["right"])]
        self.soles = [Sole(geom, model.geom_size[geom].copy()) for geom in geoms]
        self.root = int(model.body(description.root).id)
        self.weight = body_weight(description)
        self.height = float(model.body(description.root).pos[2])

    def place(self, model: Any, data: Any, motion: Any) -> None:
        """`motion`: the estimate or the truth of a recorded tick."""
        free = self._free
        data.qpos[free : free + 3] = motion["base_position"]
        data.qpos[free + 3 : free + 7] = motion["base_orientation"]
        data.qpos[self._angles] = motion["joint_position"]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)

    def corners(self, data: Any) -> Floats:
        """World points of the corners of both soles [m], (2, 4, 3)."""
        points = np.empty((2, 4, 3))
        for foot, sole in enumerate(self.soles):
            local = np.column_stack([CORNERS * sole.half[:2], np.full(4, -sole.half[2])])
            axes = data.geom_xmat[sole.geom].reshape(3, 3)
            points[foot] = data.geom_xpos[sole.geom] + local @ axes.T
        return points
