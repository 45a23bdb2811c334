"""The pack that all servos share: sag, energy, and the most that it gives."""


class PackSupply:
    """Open-circuit voltage behind a resistance, V = V₀ − R·i, folding back at i_max.

    Servos take a current that grows with V, so V·i_max/i of the substep before is the voltage at
    which they take i_max.
    """

    def __init__(self, voltage: float, resistance: float, current_limit: float | None) -> None:
        self._open, self._resistance, self._limit = voltage, resistance, current_limit
        self.voltage = voltage
        """At the servos [V]."""
        self.lowest = voltage
        """[V]"""
        self.energy = 0.0
        """Sum of the power over the substeps [W]."""
        self._sum, self._substeps = 0.0, 0

    def load(self, current: float) -> None:
        """Give a current [A] for one substep."""
        self.energy += self.voltage * current
        voltage = self._open - self._resistance * current
        if self._limit is not None and current > 0.0:
            voltage = min(voltage, self.voltage * self._limit / current)
        self.voltage = voltage
        self._sum += voltage
        self._substeps += 1
        if voltage < self.lowest:
            self.lowest = voltage

    def mean(self) -> float:
        """Mean voltage since this was asked last [V]."""
        mean = self._sum / self._substeps if self._substeps else self.voltage
        self._sum, self._substeps = 0.0, 0
        return mean
