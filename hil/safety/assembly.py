"""The safety chain of a robot: which monitors it has and how it comes to rest."""

from hil.description import RobotDescription
from hil.request import Feet
from hil.safety.decision import WayOut
from hil.safety.feet import FeetMonitor
from hil.safety.monitor import Monitor
from hil.safety.program import ClampMonitor, PauseMonitor
from hil.safety.servos import (
    ErrorMonitor,
    FrozenMonitor,
    LoadMonitor,
    TemperatureMonitor,
    VoltageMonitor,
)
from hil.safety.silence import BoardMonitor, SilenceMonitor
from hil.safety.supervisor import Supervisor
from hil.safety.way_out import LAND_S, sit_time_s


def make_supervisor(
    description: RobotDescription,
    rate_hz: int,
    weight_n: float,
    *,
    paced: bool,
    feet: Feet = "carry",
) -> Supervisor:
    """The supervisor of a run. `paced`: ticks are those of the wall clock, and can be late.

    `feet`: carry the walking robot, hang in the air, may do either, or leave the ground.
    """
    sit_ns = round(sit_time_s(description) * 1e9)
    way_out = WayOut(sit_ns, round(LAND_S * 1e9) if sit_ns else 0)
    # A pause comes first: it explains whatever else is seen in its tick.
    monitors: list[Monitor] = [PauseMonitor()] if paced else []
    monitors += [SilenceMonitor(description), BoardMonitor(description)]
    if description.actuation == "servo":
        monitors += [
            ErrorMonitor(description),
            FrozenMonitor(description),
            LoadMonitor(description, rate_hz),
            TemperatureMonitor(description),
            VoltageMonitor(description),
            FeetMonitor(description, rate_hz, weight_n, feet),
            ClampMonitor(),
        ]
    return Supervisor(monitors, way_out, leaps=feet == "leap")
