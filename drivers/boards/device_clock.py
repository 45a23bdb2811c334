"""A board's device time on the host's clock."""

from drivers.boards.frames import DEVICE_TIME_MODULUS

DRIFT = 100e-6
"""How fast a board's crystal may run against the host's (50 ppm each)."""
RESET_GAP_NS = 500_000_000
"""Device and host disagree by this much on the time between two frames: the board restarted."""


class DeviceClock:
    """Maps device time [µs, 32 bit] to host time [ns].

    A frame that was sampled at device time d and is seen at host time h was late by
    h − (d + offset). Delays only ever add, so the offset is the least h − d seen; it may rise
    with the crystals' drift, or an old minimum would outlive its truth. What even the fastest
    frame needs (its bytes on the wire) is known and taken off, so that times are those of the
    sampling.
    """

    def __init__(self, least_delay_ns: int) -> None:
        self._least_delay_ns = least_delay_ns
        self._started = False
        self._device_us = 0
        self._device_ns = 0
        self._host_ns = 0
        self._offset_ns = 0
        self.resets = 0
        """How often the board restarted."""

    def to_host_ns(self, device_us: int, now_ns: int) -> int:
        """Host time of a sample of a frame that is seen now [ns]; never in the future."""
        if self._started:
            self._advance(device_us, now_ns)
        else:
            self._restart(now_ns)
            self._started = True
        self._device_us = device_us
        self._host_ns = now_ns
        self._offset_ns = min(self._offset_ns, now_ns - self._device_ns)
        return self._device_ns + self._offset_ns - self._least_delay_ns

    def _advance(self, device_us: int, now_ns: int) -> None:
        """Unwrap the device time, and let the offset drift; start anew after a restart."""
        device_step = (device_us - self._device_us) % DEVICE_TIME_MODULUS * 1000
        host_step = now_ns - self._host_ns
        if abs(device_step - host_step) > RESET_GAP_NS:
            self.resets += 1
            self._restart(now_ns)
            return
        self._device_ns += device_step
        self._offset_ns += int(host_step * DRIFT)

    def _restart(self, now_ns: int) -> None:
        self._device_ns = 0
        self._offset_ns = now_ns
