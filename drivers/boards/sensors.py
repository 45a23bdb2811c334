"""The boards of a robot in one tick: from their ports into a SensorFrame."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from drivers.boards.calibration import FootConverter, ImuConverter
from drivers.boards.frames import ALL_CELLS, CELL_RAIL, FootFrame, ImuFrame, ImuStatus
from drivers.boards.gyro_rest import LISTEN_NS, bias_at_rest
from drivers.boards.reader import BoardReader
from hil.interface import SIDES, Clock, SensorFrame

Side = Literal["left", "right"]

_CELL_VALID = tuple(tuple(bool(status >> cell & 1) for cell in range(4)) for status in range(16))
_NO_CELL = (False,) * 4
_IMU_ALL = int(ImuStatus.ALL)


@dataclass(frozen=True, slots=True)
class FootSensor:
    """One foot's board and its calibration."""

    reader: BoardReader
    converter: FootConverter

    def read(self, side: int, now_ns: int, frame: SensorFrame) -> None:
        """Put the foot's forces, age and validity into a frame."""
        reader = self.reader
        arrived = reader.poll(now_ns)
        latest = reader.latest
        frame.foot_age_ns[side] = reader.age_ns(frame.time_ns)
        if not isinstance(latest, FootFrame):
            return
        if arrived:
            latest = reader.latest = _without_railed(latest)
            self.converter.convert(latest, frame.foot_force[side])
        fresh = reader.is_fresh(now_ns)
        frame.foot_valid[side] = _CELL_VALID[latest.status & ALL_CELLS] if fresh else _NO_CELL


def _without_railed(frame: FootFrame) -> FootFrame:
    """The frame without the cells whose converter is at its end, whatever its board says."""
    counts = frame.counts
    if max(counts) < CELL_RAIL and min(counts) > -CELL_RAIL:
        return frame
    railed = sum(1 << cell for cell in range(4) if abs(counts[cell]) >= CELL_RAIL)
    return frame._replace(status=frame.status & ~railed)


@dataclass(frozen=True, slots=True)
class ImuSensor:
    """The IMU's board and its mounting."""

    reader: BoardReader
    converter: ImuConverter

    def read(self, now_ns: int, frame: SensorFrame) -> None:
        """Put the IMU's values, age and validity into a frame."""
        reader = self.reader
        arrived = reader.poll(now_ns)
        latest = reader.latest
        frame.imu_age_ns = reader.age_ns(frame.time_ns)
        if not isinstance(latest, ImuFrame):
            return
        if arrived:
            self.converter.convert(
                latest,
                frame.imu_orientation,
                frame.imu_angular_velocity,
                frame.imu_linear_acceleration,
            )
        frame.imu_valid = latest.status & _IMU_ALL == _IMU_ALL and reader.is_fresh(now_ns)

    def renew_bias(self, clock: Clock) -> bool:
        """Listen to a robot at rest for its gyro's bias; False where it was not at rest."""
        end_ns = clock.now_ns() + LISTEN_NS
        frames: list[ImuFrame] = []
        while (now_ns := clock.now_ns()) < end_ns:
            if self.reader.poll(now_ns) and isinstance(self.reader.latest, ImuFrame):
                frames.append(self.reader.latest)
            clock.wait_readable([self.reader.port.stream], end_ns)
        bias = bias_at_rest(frames)
        if bias is not None:
            self.converter.set_gyro_bias(bias)
        return bias is not None


class BoardSensors:
    """All boards of a robot."""

    def __init__(self, feet: Mapping[Side, FootSensor], imu: ImuSensor | None) -> None:
        self._feet = [(SIDES.index(side), foot) for side, foot in feet.items()]
        self._imu = imu

    @property
    def readers(self) -> list[BoardReader]:
        """The readers of all boards."""
        readers = [foot.reader for _, foot in self._feet]
        return readers if self._imu is None else [*readers, self._imu.reader]

    def renew_bias(self, clock: Clock) -> bool:
        """Listen for a second to the gyro of a robot whose torque is off; False if it moved."""
        return self._imu is None or self._imu.renew_bias(clock)

    def read(self, now_ns: int, frame: SensorFrame) -> None:
        """Take what the boards have sent; never waits."""
        for side, foot in self._feet:
            foot.read(side, now_ns, frame)
        if self._imu is not None:
            self._imu.read(now_ns, frame)
