"""The check before arming, after a fall, and what a hardware report takes along."""

import json
import platform
import zipfile
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from hil import __version__
from hil.bringup.facts import Inspection, WatchdogTrip
from hil.bringup.mirror import mirrored_pairs
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.description import RobotDescription
from hil.errors import InputError
from hil.run_folder import PARTS, git_commit
from hil.signals import StopSignals

ALIKE_DEG = 10.0
"""Legs of a hanging robot that differ by more tell of a slipped horn (assumed)."""

Images = dict[str, commissioning.RegisterImage]


class Check:
    """One check of one robot; ports are closed when it is done."""

    def __init__(self, description: RobotDescription, ports: dict[str, str], rate_hz: int) -> None:
        self.description = description
        self.ports = ports
        self.inspection = Inspection()
        self.images: Images = {}
        self._rate_hz = rate_hz
        self._calibration = commissioning.calibration_of(description)

    def run(self, after_fall: bool) -> Inspection:
        """Ask everything. Raises BackendError for a port that is lost meanwhile."""
        with commissioning.RobotBench(self.description, self.ports, MonotonicClock()) as bench:
            bench.require_bus()
            self.images = commissioning.inspect_servos(
                bench, self._calibration, self._rate_hz, self.inspection
            )
            commissioning.inspect_boards(bench, self._calibration, self.inspection)
        if after_fall:
            self._compare_legs()
        return self.inspection

    def _compare_legs(self) -> None:
        """A hanging robot's legs are alike; a horn that has slipped or a bent part is not."""
        offsets = self._calibration.joint_offsets if self._calibration else {}
        joints = {joint.name: joint for joint in self.description.joints}

        def angle_deg(name: str) -> float:
            joint = joints[name]
            offset = offsets.get(name, 0.0)
            angle = commissioning.joint_angle(self.images[name], joint.direction, offset)
            return float(np.degrees(angle))

        for left, right, sign in mirrored_pairs(self.description):
            if left in self.images and right in self.images:
                a, b = angle_deg(left), sign * angle_deg(right)
                self.inspection.expect(
                    abs(a - b) <= ALIKE_DEG, left.removeprefix("left_"),
                    f"hangs at {a:.1f}° on the left and {b:.1f}° (mirrored) on the right",
                    "if the legs hang alike, a horn has slipped or a part is bent: look, then "
                    "calibrate",
                )  # fmt: skip


def watchdog_trip(
    description: RobotDescription, ports: dict[str, str], joint: str, effort: float
) -> WatchdogTrip:
    """Torque on at one hanging joint, silence, torque off. Raises InputError or BackendError."""
    clock, signals = MonotonicClock(), StopSignals()
    with commissioning.RobotBench(description, ports, clock, boards=False) as bench:
        bus, servo = bench.find(joint)
        if bus not in bench.lines:
            raise InputError(f"--watchdog {joint}: {bus}: {bench.closed[bus]}")
        line = bench.lines[bus]
        commissioning.find_servo(line, servo.id, bench.baud(bus))
        one = commissioning.OneServo(line, servo.id)
        one.require_movable(0.0)
        with signals.caught():
            try:
                return commissioning.measure_watchdog(one, joint, effort, signals.check)
            finally:
                with signals.shielded():
                    one.end()


def finding_rows(inspection: Inspection) -> list[dict[str, str]]:
    """Findings as a program reads them, problems first."""
    remarks = [finding for finding in inspection.findings if finding.severity == "remark"]
    return [asdict(finding) for finding in (*inspection.problems, *remarks)]


def write_bundle(check: Check, path: Path) -> None:
    """Everything that somebody far away needs to understand a robot. Raises InputError."""
    description = check.description
    try:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as bundle:
            for file in (Path(description.file), description.model_path):
                bundle.write(file, file.name)
            file = Path(description.file).parent / (description.calibration or "")
            if description.calibration is not None and file.exists():
                bundle.write(file, file.name)
            for name, content in _bundle_content(check).items():
                bundle.writestr(name, json.dumps(content, indent=2) + "\n")
    except OSError as error:
        raise InputError(f"--bundle {path}: cannot be written: {error.strerror}") from error


def _bundle_content(check: Check) -> dict[str, Any]:
    return {
        "check.json": finding_rows(check.inspection),
        "registers.json": {joint: image.named() for joint, image in check.images.items()},
        "ports.json": {
            name: {"port": port, "latency_timer_ms": commissioning.latency_timer_ms(port)}
            for name, port in check.ports.items()
        },
        "versions.json": {
            "stridebridge": __version__,
            "git_commit": git_commit(),
            "python": platform.python_version(),
            "system": platform.platform(),
            **{part: version(part) for part in PARTS},
        },
    }
