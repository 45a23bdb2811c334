"""The composition root: the one room that puts controller, drivers and simulation together."""

from drivers.assembly import bus_budgets
from drivers.bus_bench import BusMeasurement, measure_port, measure_robot
from drivers.commissioning import workshop as commissioning
from drivers.dynamixel.gain_facts import feasible_gains, servo_facts
from drivers.dynamixel.hot_path_bench import measure_hot_path
from hil.compose.ceilings import bus_delay_s, gain_ceiling, servo_ceiling
from hil.compose.jumps import default_push_depth
from hil.compose.reruns import RerunParts, build_rerun
from hil.compose.sessions import build, build_robot
from hil.compose.twins import TwinParts, build_twin, driver_motors
from hil.compose.virtual_hand import virtual_hand
from hil.compose.workbench import hoist, model_comparison, serve_virtual, servo_rig

__all__ = [
    "BusMeasurement",
    "RerunParts",
    "TwinParts",
    "build",
    "build_rerun",
    "build_robot",
    "build_twin",
    "bus_budgets",
    "bus_delay_s",
    "commissioning",
    "default_push_depth",
    "driver_motors",
    "feasible_gains",
    "gain_ceiling",
    "hoist",
    "measure_hot_path",
    "measure_port",
    "measure_robot",
    "model_comparison",
    "serve_virtual",
    "servo_ceiling",
    "servo_facts",
    "servo_rig",
    "virtual_hand",
]
