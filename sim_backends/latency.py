"""How long commands and samples take on a robot's wires: arithmetic from its description.

The MuJoCo backend has no bytes; it delays what it sends and what it reads by these figures, so
that it and the dry run agree. The virtual robot uses only the time of bytes on a wire: there the
bytes themselves take their time.
"""

from hil.description import Board, Bus, RobotDescription

BITS_PER_BYTE = 10
"""Start bit, eight data bits, stop bit."""
USB_CHUNK = 62
"""Data bytes of a full-speed FTDI packet; a full one is sent at once, a rest after the timer."""
READ_BLOCK = 16
"""Bytes read of every servo: Realtime Tick to Present Position (120 to 135)."""
WRITE_BLOCK = 4
"""Bytes written to every servo: Goal Position."""
_FRAME_BYTES = {"foot": 30, "imu": 34}
"""Bytes of a board's frame: 12 around the payload of 18 or 22."""


def wire_time_ns(size: int, baud: int) -> int:
    """Time of `size` bytes on the wire [ns]."""
    return size * BITS_PER_BYTE * 1_000_000_000 // baud


def read_time_ns(description: RobotDescription) -> int:
    """From the start of a tick until the host has the answers of all servos [ns].

    USB, request, the full chunks of a fast sync reply, the adapter's latency timer for its last
    part, USB. Protocol 2.0 sizes for n servos: 14 + n bytes and 8 + n·(4 + block) bytes.
    """
    slowest = 0
    for bus, n in _buses(description):
        reply = 8 + n * (4 + READ_BLOCK)
        full_chunks = reply - reply % USB_CHUNK
        wire = wire_time_ns(14 + n + full_chunks, bus.baud)
        slowest = max(slowest, wire + bus.latency_timer_ms * 1_000_000)
    return slowest + 2 * _usb_ns(description)


def command_latency_ns(description: RobotDescription) -> int:
    """From the start of a tick to the moment at which the slowest bus has its goals [ns].

    The read, the controller, USB, and a sync write of 14 + n·(1 + block) bytes.
    """
    slowest = 0
    for bus, n in _buses(description):
        size = 14 + n * (1 + WRITE_BLOCK)
        slowest = max(slowest, wire_time_ns(size, bus.baud))
    compute = 1000 * description.timing.compute_us
    return read_time_ns(description) + compute + _usb_ns(description) + slowest


def board_age_ns(description: RobotDescription, board: Board) -> int:
    """Age of a board's newest sample in the host, at the start of the tick that uses it [ns].

    The host takes what the boards sent when it has the answers of the servos. The mean over the
    phase between the board's rate and the ticks is half a board period.
    """
    wire = wire_time_ns(_FRAME_BYTES[board.kind], board.baud)
    wait = 500_000_000 // board.rate_hz + 500 * description.noise.board_jitter_us
    return max(
        0,
        held_ns(description, board)
        + wait
        + wire
        + _usb_ns(description)
        - read_time_ns(description),
    )


def held_ns(description: RobotDescription, board: Board) -> int:
    """How old a sample is when its board sends it [ns]."""
    return 1000 * (description.noise.imu_delay_us if board.kind == "imu" else board.delay_us)


def _buses(description: RobotDescription) -> list[tuple[Bus, int]]:
    """Every bus and its number of servos."""
    return [
        (bus, sum(joint.bus == name for joint in description.joints))
        for name, bus in description.buses.items()
    ]


def _usb_ns(description: RobotDescription) -> int:
    """Mean time of one transfer."""
    return 1000 * description.timing.usb_transfer_us + 500 * description.noise.usb_jitter_us
