"""An ADS131M04 that answers as its data sheet (SBAS890) says, written without the driver's code."""

from binascii import crc_hqx
from collections import deque

CHANNELS = 4
WORD = 3
FRAME = 6 * WORD

ID, STATUS, MODE, CLOCK, GAIN1 = range(5)
RESET_FLAG = 0x0400
RESYNC_FLAG = 0x4000


class FakeAdc:
    """Registers, the answer to the frame before, and a buffer of two conversions."""

    def __init__(self):
        self.channels = CHANNELS
        self.forgets = None
        """A register that does not keep what is written."""
        self.flip = {}
        """Byte to mask: bits of the coming frames that the wire turns over."""
        self.silent = False
        """Nobody drives DOUT: it reads as ones."""
        self.cleared_by_reading = RESYNC_FLAG
        self.resets = 0
        self.power_up()

    def power_up(self):
        """Registers, buffers and filter as after a reset."""
        self.registers = {ID: 0x2000 | self.channels << 8, STATUS: 0x0500, MODE: 0x0510}
        self.registers |= {CLOCK: 0x0F0E, GAIN1: 0, 5: 0, 6: 0x0600}
        self._conversions = deque(maxlen=2)
        self._last = [0] * CHANNELS
        self._answer = 0x0500
        self.new_channels = 0xF

    @property
    def data_rate(self):
        """Conversions a second at 8.192 MHz."""
        return 8_192_000 / 2 / (128 << (self.registers[CLOCK] >> 2 & 7))

    @property
    def gains(self):
        return [1 << (self.registers[GAIN1] >> 4 * channel & 7) for channel in range(CHANNELS)]

    def convert(self, counts):
        """A conversion is done: the older of two unread ones is lost."""
        self._conversions.append(list(counts))

    def begin(self):
        """What the ADC will send in the frame that begins now."""
        status = self._answer
        if status is None:
            flags = self.registers[STATUS] & ~0x000F
            status = flags | (self.new_channels if self._conversions else 0)
            self.registers[STATUS] &= ~self.cleared_by_reading
        counts = self._conversions.popleft() if self._conversions else self._last
        self._last = counts
        frame = status.to_bytes(2, "big") + b"\0"
        for count in counts:
            frame += count.to_bytes(WORD, "big", signed=True)
        frame += crc_hqx(frame, 0xFFFF).to_bytes(2, "big") + b"\0"
        if self.silent:
            return b"\xff" * FRAME
        return bytes(byte ^ self.flip.get(place, 0) for place, byte in enumerate(frame))

    def end(self, received):
        """The host's frame is complete: execute its command."""
        assert len(received) == FRAME, "the ADC wants whole frames while channels are on"
        command = int.from_bytes(received[0:2], "big")
        value = int.from_bytes(received[WORD : WORD + 2], "big")
        address = command >> 7 & 0x3F
        self._answer = None
        if command == 0x0011:
            self.resets += 1
            self.power_up()
            self._answer = 0xFF20 | self.channels
        elif command >> 13 == 0b101:
            self._answer = self.registers[address]
        elif command >> 13 == 0b011:
            if address != self.forgets:
                self.registers[address] = value
            if address == MODE:
                self.registers[STATUS] &= ~RESET_FLAG | value & RESET_FLAG
            self._answer = 0x4000 | address << 7
        else:
            assert command == 0, f"no command of this chip: {command:04x}"

    def exchange(self, received):
        """One full-duplex frame."""
        sent = self.begin()
        self.end(received)
        return sent
