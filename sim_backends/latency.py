"""How long commands and samples take on a robot's wires: arithmetic from its description.

The MuJoCo backend has no bytes; it delays what it sends and what it reads by these figures, so
that it and the dry run agree. The virtual robot does not use them: there the bytes themselves
take their time.
"""

from hil.description import Board, RobotDescription

BITS_PER_BYTE = 10
"""Start bit, eight data bits, stop bit."""
USB_CHUNK = 62
"""Data bytes of a full-speed FTDI packet; a full one is sent at once, a rest after the timer."""
READ_BLOCK = 21
"""Bytes read of every servo: Present Current to Present Temperature (126 to 146)."""
WRITE_BLOCK = 4
"""Bytes written to every servo: Goal Position."""
_FRAME_BYTES = {"foot": 30, "imu": 34}
"""Bytes of a board's frame: 12 around the payload of 18 or 22."""


def command_latency_ns(description: RobotDescription) -> int:
    """From the start of a tick to the moment at which the slowest bus has its goals [ns].

    USB, request, fast sync reply with the adapter's latency timer for its last part, USB, the
    controller, USB, sync write. Packet sizes: Protocol 2.0 (14 + n, 8 + n·(4 + block) and
    14 + n·(1 + block) bytes for n servos). Half of the USB jitter is counted for each transfer.
    """
    usb = 1000 * description.timing.usb_transfer_us + 500 * description.noise.usb_jitter_us
    slowest = 0
    for name, bus in description.buses.items():
        n = sum(joint.bus == name for joint in description.joints)
        byte_ns = BITS_PER_BYTE * 1_000_000_000 / bus.baud
        reply = 8 + n * (4 + READ_BLOCK)
        full_chunks = reply - reply % USB_CHUNK
        read = (14 + n + full_chunks) * byte_ns + bus.latency_timer_ms * 1_000_000
        write = (14 + n * (1 + WRITE_BLOCK)) * byte_ns
        slowest = max(slowest, int(read + write))
    return slowest + 3 * usb + 1000 * description.timing.compute_us


def board_latency_ns(description: RobotDescription, board: Board) -> int:
    """From a sample's acquisition to the moment at which the host can have its frame [ns].

    Mean over the phase between the board's own rate and the ticks, half a board period.
    """
    wire = BITS_PER_BYTE * _FRAME_BYTES[board.kind] * 1_000_000_000 // board.baud
    usb = 1000 * description.timing.usb_transfer_us + 500 * description.noise.usb_jitter_us
    wait = 500_000_000 // board.rate_hz + 500 * description.noise.board_jitter_us
    delay = 1000 * description.noise.imu_delay_us if board.kind == "imu" else 0
    return wire + usb + wait + delay
