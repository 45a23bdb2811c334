"""Mass and leg length of a robot, by which speeds, pushes and rates of robots are compared."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hil.description import RobotDescription
from hil.errors import DescriptionError
from hil.interface import GRAVITY, Floats

if TYPE_CHECKING:  # the command line and the recorder start without the simulator
    import mujoco


@dataclass(frozen=True, slots=True)
class RobotFacts:
    """Nominal figures of a robot's model.

    With leg length L and gravity g, a speed v is as fast as v/√(gL) (the square root of the
    Froude number), and a control period h is as long as h·√(g/L).
    """

    mass: float
    """[kg]"""
    leg_length: float
    """Hip pitch axis to knee axis to ankle point, straight leg [m]."""
    gravity: float
    """[m/s²]"""

    @property
    def weight(self) -> float:
        """[N]"""
        return self.mass * self.gravity

    @property
    def speed_scale(self) -> float:
        """√(gL) [m/s]."""
        return math.sqrt(self.gravity * self.leg_length)

    @property
    def time_scale(self) -> float:
        """√(L/g) [s]."""
        return math.sqrt(self.leg_length / self.gravity)


def robot_facts(description: RobotDescription) -> RobotFacts:
    """The facts of a described robot. Raises DescriptionError for a leg that is not found."""
    import mujoco

    model = _model(description)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    names = ("left_hip_pitch", "left_knee", description.feet["left"].ankle)
    hip, knee, ankle = (_anchor(description, data, name) for name in names)
    length = float(np.linalg.norm(hip - knee) + np.linalg.norm(knee - ankle))
    return RobotFacts(_mass(description, model), length, float(-model.opt.gravity[2]))


def body_weight(description: RobotDescription) -> float:
    """Weight of the robot's model [N]."""
    return _mass(description, _model(description)) * GRAVITY


def _model(description: RobotDescription) -> "mujoco.MjModel":
    import mujoco

    return mujoco.MjModel.from_xml_path(str(description.model_path))


def _mass(description: RobotDescription, model: "mujoco.MjModel") -> float:
    return float(model.body(description.root).subtreemass[0])


def _anchor(description: RobotDescription, data: "mujoco.MjData", name: str) -> Floats:
    try:
        anchor = data.joint(name).xanchor
    except KeyError:
        problem = f"{name!r} is not in the model"
        raise DescriptionError(description.file, "joints", problem) from None
    return np.asarray(anchor, dtype=np.float64)
