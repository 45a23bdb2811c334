"""What a servo protects itself from: overload, heat and a wrong supply."""

import numpy as np

from hil.interface import Floats, Ints

INPUT_VOLTAGE, OVERHEATING, OVERLOAD = 1, 4, 32
"""Bits of Hardware Error Status and Shutdown (X-series e-manual)."""
FACTORY_SHUTDOWN = 52
"""Overheating, electrical shock and overload (X-series e-manual, Shutdown)."""
FACTORY_TEMPERATURE = 80.0
"""Temperature Limit of the XM430 [°C] (e-manual)."""
OVERLOAD_SHARE = 0.38
"""Persistent current, in stall currents, that is an overload; assumed, see `ServoProtection`."""
OVERLOAD_TIME = 1.9
"""Time constant of what "persistent" means [s]; assumed."""


class ServoProtection:
    """Latched hardware errors of n servos, and which of them end the torque.

    The e-manual calls overload a persistent load above the maximum output, without figures. One
    public report has them: an XM430-W350 at 12 V trips after about 5 s at 941 mA, 0.41 of its
    stall current (DynamixelSDK issue 285). Here a first-order mean of |i|/i_stall with time
    constant 1.9 s trips above 0.38: 5.0 s at 0.41, 0.9 s at stall. Any share below 0.41 with a
    time to match would fit that report as well. Overheating is the case above
    the limit. The supply is judged by its mean over some 100 ms, as the slow register shows it.
    """

    def __init__(self, n: int) -> None:
        self.temperature_limit = np.full(n, FACTORY_TEMPERATURE)
        """[°C], shape (n,)."""
        self.lowest_voltage, self.highest_voltage = np.zeros(n), np.full(n, np.inf)
        """[V], shape (n,)."""
        self.shutdown = np.full(n, FACTORY_SHUTDOWN)
        """Errors that end the torque, shape (n,)."""
        self.errors: Ints = np.zeros(n, dtype=np.int64)
        """Latched errors, shape (n,)."""
        self._load = np.zeros(n)
        self.highest_load = np.zeros(n)
        """Highest persistent load so far [stall currents], shape (n,)."""

    def judge(self, load: Floats, temperature: Floats, voltage: float, duration: float) -> None:
        """Mean of |i|/i_stall, case [°C], both (n,), and supply [V] during some ms [s]."""
        self._load += (load - self._load) * (1.0 - np.exp(-duration / OVERLOAD_TIME))
        np.maximum(self.highest_load, self._load, out=self.highest_load)
        self.errors |= OVERLOAD * (self._load > OVERLOAD_SHARE)
        self.errors |= OVERHEATING * (temperature > self.temperature_limit)
        outside = (voltage < self.lowest_voltage) | (voltage > self.highest_voltage)
        self.errors |= INPUT_VOLTAGE * outside

    def tripped(self) -> list[int]:
        """Servos whose torque an error has ended."""
        tripped: list[int] = np.flatnonzero(self.errors & self.shutdown).tolist()
        return tripped

    def reboot(self, servo: int) -> None:
        """Forget the errors of one servo."""
        self.errors[servo] = 0
        self._load[servo] = 0.0
