"""Torque off on a robot or on one port."""

from collections.abc import Sequence
from pathlib import Path

from hil.bringup.facts import Relaxation
from hil.bringup.ports import robot_ports
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.robot_files import load_robot


def is_port(target: str) -> bool:
    """Whether a target is a port and not a robot: a path that is no robot file, or a URL."""
    if target.endswith((".yaml", ".yml")):
        return False
    return "/" in target or "://" in target or target.upper().startswith("COM")


def relax(target: str, options: Sequence[str], file: Path | None) -> Relaxation:
    """Every servo that answers. Raises InputError, PortError or BackendError."""
    clock = MonotonicClock()
    if is_port(target):
        line = commissioning.open_line(target, clock)
        try:
            return commissioning.relax_line(line)
        finally:
            line.close()
    description = load_robot(target)
    ports = robot_ports(description, options, file)
    with commissioning.RobotBench(description, ports, clock, boards=False) as bench:
        bench.require_bus()
        return commissioning.relax_bench(bench)
