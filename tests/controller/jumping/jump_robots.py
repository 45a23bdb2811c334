"""Both shipped robots for the tests of jumping, loaded once."""

import functools
from dataclasses import dataclass

import numpy as np

from controller.jumping.posture import Posture, standing, with_soft_knees
from controller.robot_model import RobotModel
from hil.description import RobotDescription
from hil.interface import Floats
from hil.robot_files import load_robot

ROBOTS = ("human", "minibiped")


@dataclass(frozen=True)
class Jumper:
    description: RobotDescription
    model: RobotModel

    @property
    def start(self) -> Posture:
        angles = with_soft_knees(self.model, self.description, self.angles)
        return standing(self.model, angles)

    @property
    def angles(self) -> Floats:
        return np.array(self.description.start_position)


@functools.cache
def jumper(name: str) -> Jumper:
    description = load_robot(name)
    return Jumper(description, RobotModel(description))
