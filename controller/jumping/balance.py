"""The balance error: from the centre of mass to where it would be over the middle of the support.

Seed 004_2880d7939e94ed85, section 3.2.2 and figure 3.6.
"""

from controller.jumping.support_polygon import SupportPolygon
from controller.robot_model import RobotModel
from hil.interface import Floats


def balance_error(robot: RobotModel, polygon: SupportPolygon) -> Floats:
    """Centre of the polygon less the centre of mass of the model's state, level [m], shape (2,)."""
    error: Floats = polygon.centre - robot.com[:2]
    return error
