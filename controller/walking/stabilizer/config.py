"""What can be set of the ground contact stabilizer; nothing in it depends on the robot's size.

Torques are fractions of m·g·L (mass, gravity, leg length), loads fractions of m·g. The values
are those of the seed's stored code at human size (70.4 kg, 0.94 m): 10 N·m is 0.0154, 100 N 0.145.
"""

from typing import Literal

from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt

from hil.validation import Config

SolverName = Literal["cma", "linear", "scan"]
ModelName = Literal["M0", "M1", "M2", "M3", "M4", "M5", "M6"]


class StabilizerConfig(Config):
    """Bands, thresholds, sample box and model."""

    band: float = Field(default=0.2, gt=0, lt=0.5)
    """l that a solution aims at: least share of the load on every side of the foot."""
    trigger_band: float = Field(default=0.15, gt=0, lt=0.5)
    """l below which the search begins; also the seed's l."""
    trigger_quality: NonNegativeFloat = 0.0
    """Quality (Eq. 2 at `trigger_band`) above which the search begins; 0.1 in the stored code,
    which lets shares from 0.14 pass."""
    calm: float = Field(default=0.4, gt=0, lt=0.6)
    """Least measured share of a side above which nothing is predicted; above 0.5: always is."""
    load: PositiveFloat = 0.145
    """Load F_all below which a foot has no distribution to speak of."""
    correction: float = Field(default=0.3, ge=0, le=1)
    """Part of the load cells' deviation from the model that is adopted each tick."""
    centre: Literal["zero", "coded"] = "zero"
    """Centre of the sample box: no extra torque, or as in the seed's stored code."""
    pitch: tuple[PositiveFloat, PositiveFloat] = (0.0308, 0.0462)
    """Half width of the ankle pitch torque, before and after foot-flat."""
    roll: tuple[PositiveFloat, PositiveFloat] = (0.0154, 0.0308)
    """Half width of the ankle roll torque."""
    knee: tuple[PositiveFloat, PositiveFloat] = (0.0616, 0.1156)
    """Half width of the knee torque."""
    scan_steps: PositiveInt = 4
    """Growing torques that the scan tries."""
    model: ModelName = "M0"
    """Model that predicts the forces: M0 is the whole robot."""
