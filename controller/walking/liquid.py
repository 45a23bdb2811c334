"""The liquid that a walking robot is told to expect, as the operator's schedule has it."""

import math
from dataclasses import dataclass

from hil.interface import Reference
from hil.submerged import WATER_DENSITY


@dataclass(slots=True)
class Liquid:
    """Level, density and drag of a liquid; dry land with a level of 0."""

    level: float = 0.0
    """Above the floor [m]."""
    density: float = WATER_DENSITY
    """[kg/m³]"""
    resistance: float = 1.0
    """Drag over that of water at the same speed, ρμ/ρ_water."""

    def expect(self, reference: Reference) -> None:
        """Take over what the operator says of this tick."""
        self.level = reference.water_level
        if self.level > 0.0:
            self.density = reference.liquid_density
            self.resistance = self.density * reference.liquid_viscosity / WATER_DENSITY

    def alike(self, speed: float) -> float:
        """Speed that meets the same drag in water as a speed does here [m/s].

        Drag goes with ρμ·V²: V·√(ρμ/ρ_water).
        """
        return speed if self.level <= 0.0 else speed * math.sqrt(self.resistance)
