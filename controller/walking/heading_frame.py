"""Horizontal vectors between the world and the tracked heading, as plain numbers."""

import math

Pair = tuple[float, float]
"""Sagittal and lateral component, or world x and y."""


class HeadingFrame:
    """x' = c·x + s·y, y' = c·y − s·x, with c, s of the heading ψ."""

    def __init__(self) -> None:
        self.set(0.0)

    def set(self, heading: float) -> None:
        """Turn to a heading [rad]."""
        self._c, self._s = math.cos(heading), math.sin(heading)

    def to_heading(self, vector: Pair) -> Pair:
        """Sagittal and lateral component of world x and y."""
        x, y = vector
        return self._c * x + self._s * y, self._c * y - self._s * x

    def to_world(self, vector: Pair) -> Pair:
        """World x and y of a sagittal and a lateral component."""
        x, y = vector
        return self._c * x - self._s * y, self._s * x + self._c * y
