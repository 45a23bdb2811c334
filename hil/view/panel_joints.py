"""The table of joints: target, actual, torque, temperature, gain achieved, age."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from hil.interface import NEVER_NS
from hil.view import gui

WIDTH = 380.0
ROW = 24.0
MOST_ROWS = 14
COLUMNS = ("joint", "target °", "actual °", "N·m", "°C", "gain %", "age ms")
OLD_MS = 10.0
"""An answer this old is shown in red: three ticks at 300 Hz are lost."""
LOAD_SHARE = 0.6
"""Of a joint's torque limit, from which its torque is coloured."""
COOL_K = 10.0
TRUE_PCT = 97.0
"""Share of the stiffness below which it is coloured: register steps take 1 %."""


class JointPanel:
    """One row a joint, coloured where it is wrong."""

    def __init__(
        self, names: Sequence[str], torque_limits: Sequence[float], temperature_limit: float
    ) -> None:
        self._names, self._limits = names, torque_limits
        self._hot = temperature_limit - COOL_K
        self.height = 60.0 + ROW * min(len(names), MOST_ROWS)

    def build(self, desk: gui.Desk, row: Any) -> None:
        """The panel of this frame."""
        left = -WIDTH - gui.MARGIN
        with desk.panel("Joints", left, gui.MARGIN, WIDTH, self.height) as shown:
            if shown:
                with gui.table("joints", COLUMNS) as seen:
                    if seen:
                        self._rows(row)

    def _rows(self, row: Any) -> None:
        frame, command, applied = row["frame"], row["command"], row["applied"]
        age_ms = np.minimum(frame["joint_age_ns"], NEVER_NS // 2) * 1e-6
        asked = command["stiffness"]
        gain = np.divide(applied["stiffness"], asked, where=asked > 0, out=np.ones(len(asked)))
        columns = (
            self._names,
            self._limits,
            np.degrees(command["position"]).tolist(),
            np.degrees(frame["joint_position"]).tolist(),
            frame["joint_torque"].tolist(),
            frame["joint_temperature"].tolist(),
            (100.0 * gain).tolist(),
            age_ms.tolist(),
        )
        for name, limit, target, actual, torque, heat, share, age in zip(*columns, strict=True):
            loaded = abs(torque) > LOAD_SHARE * limit
            gui.cells(
                [
                    (name, gui.PLAIN),
                    (f"{target:7.1f}", gui.PLAIN),
                    (f"{actual:7.1f}", gui.PLAIN),
                    (f"{torque:6.2f}", gui.WARN if loaded else gui.PLAIN),
                    (_known(heat, ".0f"), gui.WARN if heat > self._hot else gui.PLAIN),
                    (f"{share:4.0f}", gui.WARN if share < TRUE_PCT else gui.PLAIN),
                    (f"{age:5.1f}" if age < 1e4 else "never", gui.BAD if age > OLD_MS else gui.DIM),
                ]
            )


def _known(value: float, form: str) -> str:
    return "-" if math.isnan(value) else format(value, form)
