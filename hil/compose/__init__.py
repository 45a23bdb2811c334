"""The composition root: the one room that puts controller, drivers and simulation together."""

from drivers.assembly import bus_budgets
from drivers.bus_bench import BusMeasurement, measure_port, measure_robot
from drivers.commissioning import workshop as commissioning
from drivers.dynamixel.gain_facts import feasible_gains, servo_facts
from drivers.dynamixel.hot_path_bench import measure_hot_path
from hil.compose.sessions import build, build_robot
from hil.compose.workbench import hoist, model_comparison, serve_virtual, servo_rig

__all__ = [
    "BusMeasurement",
    "build",
    "build_robot",
    "bus_budgets",
    "commissioning",
    "feasible_gains",
    "hoist",
    "measure_hot_path",
    "measure_port",
    "measure_robot",
    "model_comparison",
    "serve_virtual",
    "servo_facts",
    "servo_rig",
]
