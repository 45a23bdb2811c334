"""Do the sensor boards send what they should, as fast as they should?"""

import numpy as np

from drivers.boards.calibration import ImuConverter
from drivers.boards.frames import (
    ALL_CELLS,
    CELL_RAIL,
    DEVICE_TIME_MODULUS,
    SEQUENCE_MODULUS,
    STANDARD_GRAVITY,
    FootFrame,
    Frame,
    FrameReader,
    ImuFrame,
    ImuStatus,
)
from drivers.calibration import RobotCalibration
from drivers.commissioning.robot_bench import RobotBench
from drivers.dynamixel.port import Port
from hil.bringup.facts import Inspection
from hil.interface import CORNERS, Clock

LISTEN_NS = 400_000_000
"""How long to listen to each board [ns]."""
RATE_TOLERANCE = 0.1
GRAVITY_TOLERANCE = 0.15
"""Of the accelerometer at rest, relative (assumed)."""
MOST_TILT = np.radians(60.0)
"""A robot that is to be armed hangs or stands [rad]."""


def inspect_boards(
    bench: RobotBench, calibration: RobotCalibration | None, inspection: Inspection
) -> None:
    """Listen to every open board."""
    for name, port in bench.boards.items():
        spec = bench.description.boards[name]
        frames, reader = listen(port, bench.clock)
        where = f"board {name}"
        if not inspection.expect(bool(frames), where, _silence(reader), "its plug, or its baud"):
            continue
        kind = "foot" if isinstance(frames[-1], FootFrame) else "imu"
        article = "an" if kind == "imu" else "a"
        what = f"its port {port.url} sends frames of {article} {kind} board"
        if not inspection.expect(kind == spec.kind, where, what, "ports are swapped"):
            continue
        rate_hz = frame_rate_hz(frames)
        inspection.expect(
            abs(rate_hz - spec.rate_hz) <= RATE_TOLERANCE * spec.rate_hz, where,
            f"sends {rate_hz:.0f} frames a second, the robot file says {spec.rate_hz}",
            "its firmware's rate",
        )  # fmt: skip
        wrong = reader.crc_errors
        inspection.expect(not wrong, where, f"{wrong} frames with a wrong checksum", "its cable")
        if isinstance(frames[-1], FootFrame):
            _look_at_cells(where, frames[-1], inspection)
        else:
            _look_at_imu(where, frames[-1], calibration, inspection)


def listen(port: Port, clock: Clock) -> tuple[list[Frame], FrameReader]:
    """What a board sends while one listens."""
    port.discard_input()
    reader = FrameReader()
    frames: list[Frame] = []
    deadline_ns = clock.now_ns() + LISTEN_NS
    while clock.now_ns() < deadline_ns:
        clock.wait_readable([port.stream], deadline_ns)
        frames += reader.feed(port.read_available())
    return frames, reader


def frame_rate_hz(frames: list[Frame]) -> float:
    """By the board's own clock; lost frames do not count against it."""
    first, last = frames[0], frames[-1]
    elapsed_us = (last.device_time_us - first.device_time_us) % DEVICE_TIME_MODULUS
    count = (last.sequence - first.sequence) % SEQUENCE_MODULUS
    return 1e6 * count / elapsed_us if elapsed_us else 0.0


def _silence(reader: FrameReader) -> str:
    noise = reader.skipped_bytes + reader.crc_errors
    return "sends bytes that are no frames" if noise else "sends nothing"


def _look_at_cells(where: str, frame: FootFrame, inspection: Inspection) -> None:
    for cell, corner in enumerate(CORNERS):
        valid = bool(frame.status & ALL_CELLS & 1 << cell)
        railed = abs(frame.counts[cell]) >= CELL_RAIL
        inspection.expect(
            valid and not railed, where,
            f"cell {corner} is {'at the end of its range' if railed else 'marked invalid'}",
            "its wires: an open or shorted cell",
        )  # fmt: skip


def _look_at_imu(
    where: str, frame: ImuFrame, calibration: RobotCalibration | None, inspection: Inspection
) -> None:
    missing = ImuStatus.ALL & ~ImuStatus(frame.status)
    names = ", ".join((part.name or "").lower() for part in missing)
    if not inspection.expect(not missing, where, f"{names} marked invalid", "wait, or restart it"):
        return
    if calibration is None:
        return
    orientation, gyro, force = np.zeros(4), np.zeros(3), np.zeros(3)
    ImuConverter(calibration.imu).convert(frame, orientation, gyro, force)
    size = float(np.linalg.norm(force))
    inspection.expect(
        abs(size - STANDARD_GRAVITY) <= GRAVITY_TOLERANCE * STANDARD_GRAVITY, where,
        f"measures {size:.1f} m/s² at rest instead of {STANDARD_GRAVITY:.1f}", "hold it still",
    )  # fmt: skip
    tilt = float(np.arccos(np.clip(force[2] / max(size, 1e-9), -1.0, 1.0)))
    inspection.expect(
        tilt <= MOST_TILT, where,
        f"says that the torso is tilted by {np.degrees(tilt):.0f}°",
        "hang the robot upright; if it is, the IMU's mounting in the calibration is wrong",
    )  # fmt: skip
