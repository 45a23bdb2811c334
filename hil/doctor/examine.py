"""All checks in the order of the report."""

from hil.doctor.board import disk, throttling
from hil.doctor.machine import Finding, Machine
from hil.doctor.ports import dialout, ports
from hil.doctor.software import drawing, mujoco, python
from hil.doctor.timing import clock_source, governor, kernel, locked_memory, priority

CHECKS = (
    python, mujoco, drawing, dialout, governor, throttling, kernel, priority, locked_memory,
    clock_source, disk,
)  # fmt: skip
"""One line each; `ports` gives several."""


def examine(machine: Machine) -> list[Finding]:
    """Every line of the report."""
    return [*(check(machine) for check in CHECKS), *ports(machine)]
