"""Reads a sensor board without ever waiting for it."""

from drivers.boards.device_clock import DeviceClock
from drivers.boards.frames import Frame, FrameReader
from drivers.dynamixel.port import Port
from hil.interface import NEVER_NS

STALE_PERIODS = 3
"""Missing sample periods after which a board's values count as invalid."""
STUCK_AFTER = 5
"""Ticks with equal frames after which a noisy board counts as stuck (assumed: four channels of 24
bits, or ten of 16, are not all equal twice in a row)."""
_VALUES = 2
"""First field of a frame behind its sequence number and time."""


class BoardReader:
    """The latest frame of one board, and how old it is.

    A tick calls `poll`, which takes whatever has arrived. Values older than three sample periods
    and a tick are invalid: the board fell silent, whatever it said last. So did one whose values
    stand still to the last bit: a converter's noise moves them, and their age counts from when
    they were first seen.
    """

    def __init__(
        self, port: Port, least_delay_ns: int, period_ns: int, tick_ns: int, noisy: bool = True
    ) -> None:
        """`least_delay_ns`: from sampling to the host, of the fastest frame there can be. Without
        noise (`noisy`), which only a simulated sensor can be, values may stand still."""
        self.port = port
        self.latest: Frame | None = None
        self._frames = FrameReader()
        self._clock = DeviceClock(least_delay_ns)
        self._sampled_ns = 0
        self._noisy = noisy
        self._equal = 0
        self._stale_ns = STALE_PERIODS * period_ns + tick_ns

    @property
    def crc_errors(self) -> int:
        """Frames with a wrong CRC."""
        return self._frames.crc_errors

    @property
    def lost_frames(self) -> int:
        """Gaps in the sequence numbers."""
        return self._frames.lost_frames

    @property
    def resets(self) -> int:
        """How often the board restarted."""
        return self._clock.resets

    def poll(self, now_ns: int) -> bool:
        """Take what has arrived; whether there was a new frame."""
        data = self.port.read_available()
        if not data:
            return False
        frames = self._frames.feed(data)
        if frames:
            # The newest frame is the one with the least delay: it alone tells about the clock.
            before, self.latest = self.latest, frames[-1]
            sampled_ns = self._clock.to_host_ns(self.latest.device_time_us, now_ns)
            if not self._stands_still(before, self.latest):
                self._sampled_ns = sampled_ns
        return bool(frames)

    def _stands_still(self, before: Frame | None, latest: Frame) -> bool:
        """Whether the board repeats itself, status and values alike."""
        if before is None or before[_VALUES:] != latest[_VALUES:]:
            self._equal = 0
            return False
        self._equal += 1
        return self._noisy and self._equal >= STUCK_AFTER

    def age_ns(self, now_ns: int) -> int:
        """Time since the latest frame was sampled [ns]; NEVER_NS before the first."""
        return NEVER_NS if self.latest is None else max(0, now_ns - self._sampled_ns)

    def is_fresh(self, now_ns: int) -> bool:
        """Whether the latest frame is young enough to be believed."""
        return self.age_ns(now_ns) <= self._stale_ns
