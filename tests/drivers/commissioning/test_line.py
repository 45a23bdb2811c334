"""One port asked packet by packet: answers that come late belong to other questions."""

from drivers.commissioning.line import ServoLine
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import encode_status
from hil.clock import ManualClock


class LatePort:
    """Answers in turn with prepared bytes, whatever it is asked."""

    name, url, baud = "late", "late", 4_000_000

    def __init__(self, *answers):
        self.answers = list(answers)
        self.stream = self
        self.in_waiting = 1

    def discard_input(self):
        pass

    def write(self, data):
        pass

    def read_available(self):
        return self.answers.pop(0) if self.answers else b""


def test_a_late_answer_to_a_ping_is_not_taken_for_that_of_a_read():
    """A computer that was busy finds both in its buffer, the old one first."""
    ping = encode_status(4, 0, b"\xfc\x03\x30")
    block = encode_status(4, 0, bytes([1, 2, 3, 4]))
    line = ServoLine(LatePort(ping, block), ManualClock())
    data, _ = line.hear_block(4, Register.PRESENT_POSITION, Register.PRESENT_POSITION)
    assert data == bytes([1, 2, 3, 4])
