"""Two runs of one robot, joint by joint: how far apart, and the likely cause."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hil.after.causes import Finding, find_causes, sign
from hil.after.differences import JointCurves, joint_curves
from hil.after.recorded import RecordedRun
from hil.after.signs import read_signs
from hil.errors import InputError

NOTHING = "nothing stands out"
STILL = "nothing moved enough to be measured"


@dataclass(frozen=True, slots=True)
class JointRow:
    """One joint of both runs."""

    joint: str
    position_rms: float
    """Difference [rad]."""
    torque_rms: float
    """[N·m]"""
    delay: float
    """Second run minus first [s]; NaN: unknown."""
    finding: Finding | None
    """What stands out most; none: nothing does."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """What is to be said of two runs."""

    rows: list[JointRow]
    """The joint that stands out most comes first; those in which nothing does, by torque."""
    findings: list[Finding]
    """All that stand out, the robot's and the joints', the largest score first."""
    curves: JointCurves
    joints: tuple[str, ...]
    """In the order of the curves' columns."""
    measured: int
    """Joints that moved enough in both runs for their servos to be measured."""

    @property
    def verdict(self) -> str:
        """One line."""
        if not self.findings:
            return NOTHING if self.measured else STILL
        first = self.findings[0]
        return f"{first.joint or 'whole robot'}: {first.cause}: {first.evidence}"

    @property
    def headline(self) -> str:
        """The verdict in a few words."""
        if not self.findings:
            return self.verdict
        first = self.findings[0]
        amount = f"{first.difference:+.2g} {first.unit}"
        return f"{first.joint or 'whole robot'}: {first.cause}, {amount}"

    def as_dict(self) -> dict[str, Any]:
        """For `--json`; what is unknown is null."""
        return {
            "aligned_by": self.curves.aligned,
            "strides": list(self.curves.strides),
            "verdict": self.verdict,
            "joints_measured": self.measured,
            "causes": [_plain(finding) for finding in self.findings],
            "joints": [
                {
                    "joint": row.joint,
                    "position_rms_rad": row.position_rms,
                    "torque_rms_nm": row.torque_rms,
                    "delay_s": row.delay if np.isfinite(row.delay) else None,
                    "cause": None if row.finding is None else row.finding.cause,
                }
                for row in self.rows
            ],
        }


def compare_runs(first: RecordedRun, second: RecordedRun) -> Comparison:
    """Lay two runs over each other and look for causes. Raises InputError where there are none."""
    if first.joints != second.joints:
        raise InputError(f"{first.name} and {second.name} are runs of different robots")
    a, b = read_signs(first), read_signs(second)
    findings = find_causes(a, b)
    curves = joint_curves(first, second)
    positions, torques = curves.rms()
    delays = sign(b, "delay")[0] - sign(a, "delay")[0]
    rows = []
    for place, joint in enumerate(first.joints):
        own = next((finding for finding in findings if finding.joint == joint), None)
        position, torque = float(positions[place]), float(torques[place])
        rows.append(JointRow(joint, position, torque, float(delays[place]), own))
    rows.sort(key=lambda row: (-(row.finding.score if row.finding else 0.0), -row.torque_rms))
    measured = int(np.count_nonzero(np.isfinite(delays)))
    return Comparison(rows, findings, curves, tuple(first.joints), measured)


def _plain(finding: Finding) -> dict[str, Any]:
    data = asdict(finding)
    data["candidates"] = list(finding.candidates)
    return data
