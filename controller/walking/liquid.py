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
    """Drag over that of water at the same speed, ρμ/ρ_water; 1 on land."""

    def expect(self, reference: Reference) -> None:
        """Take over what the operator says of this tick."""
        self.level = reference.water_level
        if self.level > 0.0:
            self.density = reference.liquid_density
            self.resistance = self.density * reference.liquid_viscosity / WATER_DENSITY
        else:
            self.resistance = 1.0

    @property
    def thickness(self) -> float:
        """Its ρμ [kg/m³]."""
        return self.resistance * WATER_DENSITY

    @property
    def excess(self) -> float:
        """ρμ that the liquid has over water [kg/m³]; 0 on land and in thinner liquids."""
        if self.level <= 0.0:
            return 0.0
        return max(self.resistance - 1.0, 0.0) * WATER_DENSITY

    def alike(self, speed: float) -> float:
        """Speed whose styles in water suit a speed here [m/s].

        In a thinner liquid the one that meets the same drag, V·√(ρμ/ρ_water). A thicker one resists
        the lifting of the foot, too: V/√(ρμ/ρ_water), so that it rises no faster than suits it.
        """
        if self.level <= 0.0:
            return speed
        root = math.sqrt(self.resistance)
        return speed * min(root, 1.0 / root)
