"""Foot and IMU boards: sampling on the physics grid, raw counts, frames on a serial line."""

import math
from collections.abc import Callable

import numpy as np

from drivers.boards.frames import (
    ACCELERATION_UNIT,
    GYRO_UNIT,
    ORIENTATION_UNIT,
    ImuStatus,
    encode_foot_frame,
    encode_imu_frame,
)
from hil.description import Board, RobotDescription
from sim_backends.latency import wire_time_ns
from sim_backends.plant import Plant
from sim_backends.sensor_models import CellErrors, ImuErrors, ImuSample
from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.host_port import HostPort
from sim_backends.virtual.wire_faults import WireFaults

CELL_ZERO = 1e5
"""Standard deviation of a cell's counts without load (assumed)."""
CELL_GAIN = 2000.0
"""Typical counts of one newton (assumed)."""
CLOCK_ERROR = 50e-6
"""Largest error of a board's crystal (assumed)."""
_ALL_CELLS = 0xF
_INT16 = 32767
_GYRO_UNIT = float(GYRO_UNIT)  # A numpy scalar would make slow arithmetic.

FrameMaker = Callable[[int, int], bytes]
"""Samples the plant: from sequence number and device time [µs] to a frame."""


class SensorBoard:
    """One board: samples on every k-th grid point, k so that the rate is nearest to its own.

    Its clock has an offset and a drift of its own. A frame leaves `hold_ns` plus jitter after the
    sample, and is in the host after its bytes at the board's baud and one USB transfer.
    """

    def __init__(
        self,
        description: RobotDescription,
        board: Board,
        clock: VirtualClock,
        random: np.random.Generator,
        port: HostPort,
        make_frame: FrameMaker,
        hold_ns: int,
    ) -> None:
        plant = clock.plant
        grid_hz = plant.rate_hz * plant.substeps
        self._stride = max(1, round(grid_hz / board.rate_hz))
        self._plant, self._clock, self._random, self._port = plant, clock, random, port
        self.make_frame = make_frame
        self.rewrite: Callable[[bytes], bytes] | None = None
        """Faults of the board: from its frame to what it sends, empty for nothing."""
        self._faults: WireFaults | None = None
        self._sequence = int(random.integers(1 << 16))
        self._offset_us = int(random.integers(1 << 32))
        self._microseconds = 1e-3 * (1 + random.uniform(-CLOCK_ERROR, CLOCK_ERROR))
        self._baud = board.baud
        self._hold_ns = hold_ns + 1000 * description.timing.usb_transfer_us
        self._jitter_ns = 1000 * (
            description.noise.board_jitter_us + description.noise.usb_jitter_us
        )
        self._last_arrival_ns = 0
        self._frame_size = self._wire_ns = 0
        self._index = plant.substep_index + int(random.integers(self._stride))
        self._sample_ns = plant.grid_time_ns(self._index)
        clock.schedule(self._sample_ns, self._sample)

    def host_wrote(self, data: bytes, baud: int) -> None:
        """Boards only talk."""

    def wire(self) -> WireFaults:
        """Faults of the line to the host; there is a list of them from the first call on."""
        if self._faults is None:
            self._faults = WireFaults()
        return self._faults

    def shift_clock(self, microseconds: int) -> None:
        """Have the board's clock jump."""
        self._offset_us += microseconds

    def _sample(self) -> None:
        now_ns = self._sample_ns
        device_us = int(now_ns * self._microseconds) + self._offset_us
        frame = self.make_frame(self._sequence, device_us)
        if self.rewrite is not None:
            frame = self.rewrite(frame)
        self._sequence += 1
        size = len(frame)
        if size != self._frame_size:
            self._frame_size, self._wire_ns = size, wire_time_ns(size, self._baud)
        jitter_ns = int(self._random.random() * self._jitter_ns)
        arrival_ns = max(now_ns + self._hold_ns + self._wire_ns + jitter_ns, self._last_arrival_ns)
        self._last_arrival_ns = arrival_ns
        if self._faults is None:
            self._port.deliver_at(arrival_ns, frame)
        else:
            for late_ns, left in self._faults.to_host([(arrival_ns, frame)], self._baud):
                self._last_arrival_ns = late_ns
                self._port.deliver_at(late_ns, left)
        self._index += self._stride
        self._sample_ns = self._plant.grid_time_ns(self._index)
        self._clock.schedule(self._sample_ns, self._sample)


class LoadCells:
    """Four cells of one foot: counts = zero + force/scale, zero and scale drawn once a robot.

    Signs and sizes of the scales vary as those of real bridges do, so nothing works uncalibrated.
    """

    def __init__(
        self, plant: Plant, foot: int, errors: CellErrors, random: np.random.Generator
    ) -> None:
        """`foot`: 0 left, 1 right."""
        self._plant = plant
        self._corners = slice(4 * foot, 4 * foot + 4)
        self._errors = errors
        gain = CELL_GAIN * random.uniform(0.7, 1.3, 4) * random.choice((-1.0, 1.0), 4)
        self._gain = gain
        self._zero = np.rint(random.normal(0.0, CELL_ZERO, 4))
        self._cells: list[tuple[float, float]] = np.transpose((self._zero, gain)).tolist()
        self.pressed: list[float] | None = None
        """What a hand puts on the cells beside the floor [N], (4,)."""
        self.order: list[int] | None = None
        """Which cell is wired to each channel, where that is not as it should be."""

    def frame(self, sequence: int, device_us: int) -> bytes:
        """A frame of the loads now."""
        true = self._plant.corner_forces()[self._corners]
        if self.pressed is not None:
            true = [floor + hand for floor, hand in zip(true, self.pressed, strict=True)]
        cells = zip(self._cells, self._errors.measure(true), strict=True)
        counts = [round(zero + gain * force) for (zero, gain), force in cells]
        if self.order is not None:
            counts = [counts[cell] for cell in self.order]
        return encode_foot_frame(sequence, device_us, _ALL_CELLS, counts)

    def calibration(self) -> dict[str, list[float]]:
        """What calibrating found: exact scales, and zeros off by `noise.corner_zero`."""
        zero = self._zero - self._gain * self._errors.zero
        return {"zero": zero.tolist(), "scale": (1.0 / self._gain).tolist()}


class InertialUnit:
    """The IMU in raw registers: in base axes, or turned against them."""

    def __init__(self, plant: Plant, errors: ImuErrors) -> None:
        self._plant = plant
        self._errors = errors
        self.turn: Callable[[ImuSample], ImuSample] | None = None
        """From base axes to those of a unit that is mounted otherwise."""

    def frame(self, sequence: int, device_us: int) -> bytes:
        """A frame of the motion now."""
        plant = self._plant
        sample = self._errors.measure(
            plant.orientation, plant.angular_velocity, plant.specific_force()
        )
        orientation, gyro, force = sample if self.turn is None else self.turn(sample)
        return encode_imu_frame(
            sequence,
            device_us,
            ImuStatus.ALL,
            _raw(orientation, ORIENTATION_UNIT),
            _raw(gyro, _GYRO_UNIT),
            _raw(force, ACCELERATION_UNIT),
        )


def _raw(values: list[float], unit: float) -> list[int]:
    """Register counts, saturated to 16 bits."""
    counts = [math.floor(v / unit + 0.5) for v in values]
    if max(counts) > _INT16 or min(counts) < -_INT16:
        return [max(-_INT16, min(_INT16, count)) for count in counts]
    return counts
