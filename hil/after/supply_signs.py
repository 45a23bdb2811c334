"""What a recording says of the battery: its voltage under the load of the run, and that load."""

from dataclasses import dataclass

import numpy as np

from hil.after.fitting import BLOCKS
from hil.after.recorded import RecordedRun
from hil.servo import COUNTS_PER_RADIAN, PWM_FULL, MotorParameters


@dataclass(frozen=True, slots=True)
class SupplySigns:
    """Means over the steady ticks. Voltages come too seldom to tell the pack's resistance."""

    voltage: float
    """[V]"""
    deviation: float
    """Of the voltage [V]."""
    current: float
    """What all servos together draw from it [A]."""


def supply_signs(run: RecordedRun, motors: MotorParameters) -> SupplySigns:
    """V as measured; the current is Σ u·i, with the duties u that the servos' goals make."""
    frame, applied = run.steady["frame"], run.steady["applied"]
    error = np.roll(applied["goal"], 1, axis=0) - frame["joint_position"]
    scale = COUNTS_PER_RADIAN / (PWM_FULL * motors.gain_divisor)
    duty = np.clip(scale * applied["p_gain"] * error, -1.0, 1.0)
    drawn = (duty * frame["joint_torque"] / motors.torque_constant).sum(axis=1)
    parts = [part.mean() for part in np.array_split(run.supply, BLOCKS)]
    deviation = float(np.std(parts, ddof=1) / np.sqrt(BLOCKS))
    return SupplySigns(float(run.supply.mean()), deviation, float(drawn.mean()))
