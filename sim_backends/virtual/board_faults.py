"""Faults of one emulated sensor board: what becomes of its frames."""

from collections.abc import Callable

from drivers.boards.frames import (
    ALL_CELLS,
    FootFrame,
    Frame,
    FrameReader,
    ImuFrame,
    encode_foot_frame,
    encode_imu_frame,
)
from hil.fault_kinds import FEET
from sim_backends.virtual.boards import SensorBoard
from sim_backends.virtual.servo_faults import End, nothing

FULL_SCALE = (1 << 23) - 1
"""Counts of a 24-bit converter whose input is at the rail."""

Change = Callable[[Frame], Frame | None]
"""What becomes of a frame; None when it is not sent."""


class BoardFaults:
    """Begins the faults of one board. A frame goes through all that are active, in turn."""

    def __init__(self, board: SensorBoard, other_foot: SensorBoard | None) -> None:
        """`other_foot`: the board that this one may be exchanged with."""
        self._board, self._other = board, other_foot
        self._changes: list[Change] = []

    def begin(self, kind: str, values: tuple[float, ...]) -> End:
        """Begin a fault of `hil.fault_kinds`; returns what ends it."""
        if kind == "clock_jump":
            self._board.shift_clock(int(values[0] * 1e6))
            return nothing
        if kind == "swapped" and values[0] == FEET:
            return self._exchange_feet()
        if kind == "stale":
            return self._change(lambda _: None)
        make: dict[str, Callable[..., Change]] = {
            "stuck": _stuck, "slow": _slow, "swapped": _swapped, "open_cell": _open_cell,
            "saturated": _saturated,
        }  # fmt: skip
        return self._change(make[kind](*values))

    def _change(self, change: Change) -> End:
        self._changes.append(change)
        self._board.rewrite = self._rewrite

        def end() -> None:
            self._changes.remove(change)
            if not self._changes:
                self._board.rewrite = None

        return end

    def _rewrite(self, data: bytes) -> bytes:
        """The frame after all faults; empty when it is not sent."""
        frame: Frame | None = FrameReader().feed(data)[0]
        for change in self._changes:
            frame = None if frame is None else change(frame)
        if frame is None:
            return b""
        if isinstance(frame, FootFrame):
            return encode_foot_frame(*frame)
        return encode_imu_frame(*frame)

    def _exchange_feet(self) -> End:
        if self._other is None:
            return nothing
        pair = self._board, self._other

        def exchange() -> None:
            pair[0].make_frame, pair[1].make_frame = pair[1].make_frame, pair[0].make_frame

        exchange()
        return exchange


def _stuck() -> Change:
    first: list[Frame] = []

    def change(frame: Frame) -> Frame:
        if not first:
            first.append(frame)
        held = first[0]
        if isinstance(frame, FootFrame) and isinstance(held, FootFrame):
            return frame._replace(counts=held.counts)
        if isinstance(frame, ImuFrame) and isinstance(held, ImuFrame):
            return held._replace(sequence=frame.sequence, device_time_us=frame.device_time_us)
        return frame

    return change


def _slow(every: float) -> Change:
    """The frames that are sent have sequence numbers without gaps: the board samples slowly."""
    seen = sent = 0

    def change(frame: Frame) -> Frame | None:
        nonlocal seen, sent
        seen += 1
        if seen % int(every):
            return None
        sent += 1
        return frame._replace(sequence=frame.sequence - seen + sent)

    return change


def _swapped(_: float) -> Change:
    def change(frame: Frame) -> Frame:
        if not isinstance(frame, FootFrame):
            return frame
        front_left, front_right, rear_left, rear_right = frame.counts
        return frame._replace(counts=(front_right, front_left, rear_right, rear_left))

    return change


def _open_cell(cell: float) -> Change:
    return _railed(int(cell), valid=False)


def _saturated(cell: float) -> Change:
    return _railed(int(cell), valid=True)


def _railed(cell: int, *, valid: bool) -> Change:
    """One cell's counts at the rail."""
    status = ALL_CELLS if valid else ALL_CELLS & ~(1 << cell)

    def change(frame: Frame) -> Frame:
        if not isinstance(frame, FootFrame):
            return frame
        counts = list(frame.counts)
        counts[cell] = FULL_SCALE
        a, b, c, d = counts
        return frame._replace(counts=(a, b, c, d), status=frame.status & status)

    return change
