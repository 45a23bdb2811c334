"""Counters of a run on servo buses, for the report."""

from collections.abc import Sequence

import numpy as np

from drivers.dynamixel.budget import wire_time_ns
from drivers.dynamixel.bus import ServoBus
from hil.interface import AppliedCommand, Limit, SensorFrame


class BusStatistics:
    """Extremes of what was measured, and the traffic since the robot was opened."""

    def __init__(self, n: int) -> None:
        self._ticks = 0
        self._saturated = np.zeros(n, dtype=np.int64)
        self._hottest = np.full(n, np.nan)
        self._lowest_voltage = np.full(n, np.nan)
        self._buses: tuple[ServoBus, ...] = ()
        self._bytes: list[int] = []
        self._opened_ns = self._time_ns = 0

    def begin(self, buses: Sequence[ServoBus], now_ns: int) -> None:
        """Count traffic from now on."""
        self._buses, self._opened_ns = tuple(buses), now_ns
        self._bytes = [_bytes_of(bus) for bus in self._buses]

    def take_frame(self, frame: SensorFrame) -> None:
        """Note what was measured."""
        self._time_ns = frame.time_ns
        np.fmax(self._hottest, frame.joint_temperature, out=self._hottest)
        np.fmin(self._lowest_voltage, frame.joint_voltage, out=self._lowest_voltage)

    def take_command(self, applied: AppliedCommand) -> None:
        """Note what was sent."""
        self._ticks += 1
        self._saturated += (applied.limit & int(Limit.SATURATION)) != 0

    def report(self) -> dict[str, float | None]:
        """Values by the report's keys."""
        counters = [bus.counters for bus in self._buses]
        saturated_pct = 100 * self._saturated.max() / self._ticks if self._ticks else np.nan
        return {
            "bus_utilisation_pct": self._utilisation_pct(),
            "bus_crc_errors": float(sum(counter.crc_errors for counter in counters)),
            "bus_timeouts": float(sum(counter.timeouts for counter in counters)),
            "bus_stale_frames": float(sum(counter.stale for counter in counters)),
            "temperature_max_c": _known(np.fmax.reduce(self._hottest)),
            "voltage_min_v": _known(np.fmin.reduce(self._lowest_voltage)),
            "duty_saturation_pct_max": _known(saturated_pct),
        }

    def _utilisation_pct(self) -> float | None:
        """Share of time from `begin` to the last tick in which the busiest bus carried bytes."""
        elapsed_ns = self._time_ns - self._opened_ns
        if not self._buses or elapsed_ns <= 0:
            return None
        busy_ns = max(
            wire_time_ns(_bytes_of(bus) - before, bus.port.baud)
            for bus, before in zip(self._buses, self._bytes, strict=True)
        )
        return 100 * busy_ns / elapsed_ns


def _bytes_of(bus: ServoBus) -> int:
    return bus.port.sent_bytes + bus.port.received_bytes


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
