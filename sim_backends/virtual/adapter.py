"""A USB serial adapter: when bytes of the host reach the wire, and those of the wire the host."""

from collections.abc import Iterable

import numpy as np

from hil.description import Bus, Timing
from hil.twin import Noise
from sim_backends.latency import BITS_PER_BYTE, USB_CHUNK
from sim_backends.virtual.host_port import HostPort


class UsbAdapter:
    """Times one adapter. All figures are modelled, from the robot file.

    Each transfer takes `usb_transfer_us` and up to `usb_jitter_us`. Received bytes wait until a
    packet of 62 is full (64 bytes with FTDI's two status bytes) or the latency timer, which every
    packet restarts, has expired (FTDI AN232B-04).
    """

    def __init__(
        self, bus: Bus, timing: Timing, noise: Noise, random: np.random.Generator, port: HostPort
    ) -> None:
        self._transfer_ns = 1000 * timing.usb_transfer_us
        self._jitter_ns = 1000 * noise.usb_jitter_us
        self._latency_ns = 1_000_000 * bus.latency_timer_ms
        self._random = random
        self._port = port
        self._last_packet_ns = 0
        self._last_delivery_ns = 0

    def transfer_ns(self) -> int:
        """Duration of one USB transfer [ns]."""
        return self._transfer_ns + int(self._random.random() * self._jitter_ns)

    def forward(self, segments: Iterable[tuple[int, bytes]], baud: int) -> None:
        """Bytes come from the wire, in segments (start [ns], bytes) without gaps inside.

        The timer is looked at between segments and at the end, not inside one.
        """
        byte_ns = BITS_PER_BYTE * 1_000_000_000 / baud
        waiting, end_ns = b"", 0
        for start_ns, data in segments:
            if waiting and (expiry_ns := self._expiry_ns(end_ns)) < start_ns:
                self._deliver(expiry_ns, waiting)
                waiting = b""
            end_ns = start_ns + int(len(data) * byte_ns)
            waiting += data
            while len(waiting) >= USB_CHUNK:
                chunk, waiting = waiting[:USB_CHUNK], waiting[USB_CHUNK:]
                self._deliver(end_ns - int(len(waiting) * byte_ns), chunk)
        if waiting:
            self._deliver(self._expiry_ns(end_ns), waiting)

    def _expiry_ns(self, time_ns: int) -> int:
        """First time not before `time_ns` at which the timer sends what there is."""
        periods = -(-(time_ns - self._last_packet_ns) // self._latency_ns)
        return self._last_packet_ns + periods * self._latency_ns

    def _deliver(self, sent_ns: int, data: bytes) -> None:
        self._last_packet_ns = sent_ns
        arrival_ns = max(sent_ns + self.transfer_ns(), self._last_delivery_ns)
        self._last_delivery_ns = arrival_ns
        self._port.deliver_at(arrival_ns, data)
