"""What buses achieve, of a virtual robot or at a real port, as rows of a table."""

from collections.abc import Sequence
from contextlib import closing
from typing import Any

import numpy as np

from hil.clock import MonotonicClock
from hil.compose import BusMeasurement, build_robot, measure_port, measure_robot
from hil.description import RobotDescription
from hil.errors import InputError
from hil.request import RunRequest
from hil.robot_files import load_robot

DEFAULT_BAUD = 4_000_000


def measure_buses(
    robot: str,
    port: str | None,
    baud: int | None,
    ids: Sequence[int],
    cycles: int,
    realtime: bool,
    overrides: tuple[str, ...],
) -> list[BusMeasurement]:
    """Load the bus at a port, or every bus of a virtual robot. Raises StrideError.

    `baud`: of the port; of the virtual robot's buses another than the robot file says.
    """
    if port is not None:
        return [measure_port(port, baud or DEFAULT_BAUD, ids, MonotonicClock(), cycles)]
    if realtime and baud is not None:
        raise InputError("--baud: the virtual robot's terminals have no speed, leave --realtime")
    request = RunRequest.checked(robot=robot, backend="bus", realtime=realtime, overrides=overrides)
    description = load_robot(robot, overrides)
    if not description.buses:
        raise InputError(f"{description.name} has no servo bus")
    if baud is not None:
        description = with_buses(description, baud, len(description.buses))
    session = build_robot(request, description)
    with closing(session):
        urls = getattr(session.backend, "port_urls", {})
        return measure_robot(description, session.backend.clock, urls, cycles)


def rows_of(measured: Sequence[BusMeasurement]) -> list[dict[str, Any]]:
    """One row a bus: rate, percentiles of the cycle [ms], errors, and what limits it."""
    rows = []
    for bus in measured:
        p50, p90, p99, worst = np.percentile(bus.cycle_ms, (50, 90, 99, 100)).tolist()
        rows.append(
            {
                "bus": bus.bus,
                "baud": bus.baud,
                "servos": bus.servos,
                "read": "fast" if bus.fast else "plain",
                "rate_hz": bus.rate_hz,
                "p50_ms": p50,
                "p90_ms": p90,
                "p99_ms": p99,
                "max_ms": worst,
                "timeouts": bus.timeouts,
                "crc_errors": bus.crc_errors,
                "lost_pct": bus.lost_pct,
                "limit": bus.limit,
                **{f"{name} ms": value for name, value in bus.parts_ms.items()},
            }
        )
    return rows


def with_buses(description: RobotDescription, baud: int, ports: int) -> RobotDescription:
    """The robot at another speed, on its own buses or all on its first one."""
    buses = {name: bus.model_copy(update={"baud": baud}) for name, bus in description.buses.items()}
    if ports > 1:
        return description.model_copy(update={"buses": buses})
    name = next(iter(buses))
    joints = [joint.model_copy(update={"bus": name}) for joint in description.joints]
    return description.model_copy(update={"buses": {name: buses[name]}, "joints": joints})
