"""Two runs joint by joint on standard output."""

import sys
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from hil.after.comparison import Comparison

ALIGNED = {
    "tick": "tick by tick",
    "phase": "by gait phase, {} and {} strides",
    "mean": "by their means: there are no strides",
}


def print_comparison(comparison: "Comparison", names: tuple[str, str]) -> None:
    """The table of joints, what is the whole robot's, and the verdict."""
    from rich.markup import escape

    from hil.cli.table import print_rows

    rows = [
        (
            row.joint,
            f"{np.degrees(row.position_rms):.2f}",
            f"{row.torque_rms:.3f}",
            f"{round(1e3 * row.delay, 1) + 0.0:+.1f}" if np.isfinite(row.delay) else "–",
            row.finding.cause if row.finding else "",
        )
        for row in comparison.rows
    ]
    how = ALIGNED[comparison.curves.aligned].format(*comparison.curves.strides)
    heads = ("", "position rms [°]", "torque rms [N·m]", "delay [ms]", "")
    print_rows(f"{names[1]} less {names[0]}, {how}", [escape(head) for head in heads], rows)
    for finding in comparison.findings:
        joint = finding.joint or "whole robot"
        sys.stdout.write(f"{joint}: {finding.cause} (score {finding.score:.1f}): "
                         f"{finding.evidence}\n")  # fmt: skip
    if not comparison.findings:
        sys.stdout.write(f"{comparison.verdict}\n")
    if comparison.measured < len(comparison.rows):
        sys.stdout.write(f"{comparison.measured} of {len(comparison.rows)} joints moved enough to "
                         "be measured\n")  # fmt: skip
