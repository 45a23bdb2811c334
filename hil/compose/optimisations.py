"""What the studies need of the controller's costs and search spaces."""

from controller.search import gain_objective, gain_space, gait_objective, gait_space
from controller.search.motion import MotionMeter

__all__ = ["MotionMeter", "gain_objective", "gain_space", "gait_objective", "gait_space"]
