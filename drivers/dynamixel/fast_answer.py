"""The answer to a fast group read: one packet that the servos write together.

A whole one is checked with one CRC and decoded as one numpy block. Only when something is wrong
is it taken apart servo by servo: every block's CRC runs over all bytes before it, so the blocks
before a break can be trusted.
"""

import numpy as np

from drivers.dynamixel.protocol import FastBlock, crc16, decode_fast_status
from drivers.dynamixel.read_plan import FAST_DTYPE, FAST_START, ReadPlan
from drivers.dynamixel.state_filler import StateFiller


class FastAnswer:
    """Takes the answer of one tick, or of the tick before if it comes late."""

    def __init__(self, filler: StateFiller) -> None:
        self.late = 0
        """Answers of an earlier tick."""
        self.damaged = 0
        """Whole answers with a wrong CRC."""
        self.heard_late: set[int] = set()
        """Places of the servos whose late answer was taken."""
        self._filler = filler
        self._buffer = b""
        self._plan: ReadPlan | None = None
        self._late_plan: ReadPlan | None = None
        self._sample_ns = self._late_sample_ns = 0

    def begin(self, plan: ReadPlan, sample_ns: int, left: bytes) -> None:
        """Expect the answer to a request whose servos sample at a time [ns]; `left` was received
        before."""
        last = self._plan
        # A fast answer of which nothing could be used may still come; else start afresh.
        if last is not None and not self._filler.heard:
            self._late_plan, self._late_sample_ns = last, self._sample_ns
            self._buffer = (self._buffer + left)[-last.reply_size :]
        else:
            self._late_plan = None
            self._buffer = b""
        self._plan, self._sample_ns = plan, sample_ns
        self.late = self.damaged = 0
        self.heard_late.clear()
        self._filler.begin(sample_ns)

    def take(self, data: bytes) -> bool:
        """Take received bytes; True when the answer is complete."""
        plan = self._plan
        if plan is None:
            return True
        self._buffer += data
        if self._late_plan is not None:
            self._take_late(self._late_plan)
        while len(self._buffer) >= plan.reply_size:
            start = self._buffer.find(plan.start)
            end = start + plan.reply_size
            if start < 0 or len(self._buffer) < end:
                return False
            if self._take_whole(plan, self._buffer[start:end]):
                return True
            self.late += 1
            self._buffer = self._buffer[end:]
        return False

    def finish(self) -> None:
        """Take the blocks of a damaged or incomplete answer that can be trusted."""
        plan = self._plan
        if plan is None or self._filler.heard or self._filler.repeated:
            return
        start = max(0, self._buffer.find(plan.start))
        raw = self._buffer[start:]
        blocks = self._take_each(plan, raw)
        if len(raw) >= plan.reply_size and len(blocks) < len(plan.ids):
            self.damaged = 1

    def _take_late(self, plan: ReadPlan) -> None:
        """Take the last tick's answer for what it is: older, and better than none."""
        start = self._buffer.find(plan.start)
        end = start + plan.reply_size
        if start < 0 or len(self._buffer) < end:
            return
        self._filler.begin(self._late_sample_ns)
        if self._take_whole(plan, self._buffer[start:end]) and self._filler.heard:
            self.late += 1
            self.heard_late.update(self._filler.heard)
            self._buffer = self._buffer[end:]
        self._late_plan = None
        self._filler.begin(self._sample_ns)

    def _take_whole(self, plan: ReadPlan, raw: bytes) -> bool:
        """Decode an answer that is as long as it should be; False if it is an earlier one.

        One that is damaged is left to `finish`.
        """
        if crc16(raw[:-2]) != raw[-2] | raw[-1] << 8:
            return True
        blocks = np.frombuffer(raw, FAST_DTYPE, len(plan.ids), FAST_START)
        marks = blocks["error_id"].tobytes()
        if marks[1::2] != plan.id_bytes:
            return False
        if marks != plan.unmarked or not self._filler.take_all(plan, blocks):
            self._take_each(plan, raw)
        return True

    def _take_each(self, plan: ReadPlan, raw: bytes) -> list[FastBlock]:
        """Take the blocks that can be trusted one by one; which they are."""
        blocks = decode_fast_status(raw, plan.lengths)
        for block, servo_id in zip(blocks, plan.ids, strict=False):
            if block.id == servo_id:
                self._filler.take(block)
        return blocks
