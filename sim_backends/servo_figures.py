"""What the servos went through in a run, and the report keys for it."""

from dataclasses import dataclass

from hil.interface import Floats

SERVO_KEYS = (
    "temperature_max_c",
    "torque_rms_ratio_max",
    "duty_saturation_pct_max",
    "voltage_min_v",
    "energy_wh",
)
"""Keys of the report, in the order of the fields of `ServoTotals`."""


@dataclass(frozen=True, slots=True)
class ServoTotals:
    """What the servos went through since the start, for the report."""

    temperature_max: float
    """[°C]"""
    torque_rms_ratio: Floats
    """RMS motor torque over stall torque, shape (n,)."""
    saturation: Floats
    """Share of substeps with the drive at its limit, shape (n,)."""
    voltage_min: float
    """[V]"""
    energy: float
    """Taken from the supply [J]."""

    def figures(self) -> dict[str, float | None]:
        """The totals under their report keys."""
        values = (
            self.temperature_max,
            float(self.torque_rms_ratio.max()),
            100.0 * float(self.saturation.max()),
            self.voltage_min,
            self.energy / 3600.0,
        )
        return dict(zip(SERVO_KEYS, values, strict=True))
