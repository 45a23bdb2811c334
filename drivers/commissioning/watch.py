"""A robot's state, read and never written: torque stays as it is."""

import numpy as np

from drivers.boards.calibration import FootConverter, ImuConverter
from drivers.boards.frames import (
    ACCELERATION_UNIT,
    ALL_CELLS,
    GYRO_UNIT,
    ORIENTATION_UNIT,
    FootFrame,
    Frame,
    FrameReader,
    ImuFrame,
    ImuStatus,
)
from drivers.calibration import RobotCalibration
from drivers.commissioning.inspection import joint_angle
from drivers.commissioning.line import ServoLine
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.settings import FIRST, LAST, RegisterImage, errors_by_name
from drivers.dynamixel.audit import ExpectedServo
from drivers.dynamixel.control_table import VELOCITY_UNIT, VOLTAGE_UNIT, Register
from hil.bringup.facts import BoardReading, JointReading, RobotReading
from hil.description import Joint
from hil.interface import CORNERS

ABSENT_NS = 1_000_000_000
"""How often a servo that does not answer is asked again [ns]: each try costs 30 ms."""
_NS_PER_MS = 1e-6


class Watch:
    """Reads every open bus and board, and keeps when each was heard last."""

    def __init__(self, bench: RobotBench, calibration: RobotCalibration | None) -> None:
        self._bench = bench
        self._calibration = calibration
        self._servos = [
            (bus, servo) for bus in bench.description.buses for servo in bench.expected(bus)
        ]
        self._joints = {joint.name: joint for joint in bench.description.joints}
        self._images: dict[str, tuple[int, RegisterImage]] = {}
        self._ask_again_ns: dict[str, int] = {}
        self._frames: dict[str, tuple[int, Frame]] = {}
        self._readers = {name: FrameReader() for name in bench.boards}

    def read(self) -> RobotReading:
        """Ask everybody once. Raises BackendError for a port that is lost."""
        for bus, servo in self._servos:
            if bus in self._bench.lines:
                self._ask(self._bench.lines[bus], servo)
        now_ns = self._bench.clock.now_ns()
        for name, port in self._bench.boards.items():
            frames = self._readers[name].feed(port.read_available())
            if frames:
                self._frames[name] = now_ns, frames[-1]
        return RobotReading(
            tuple(self._joint(bus, servo, now_ns) for bus, servo in self._servos),
            tuple(self._board(name, now_ns) for name in self._bench.description.boards),
        )

    def _ask(self, line: ServoLine, servo: ExpectedServo) -> None:
        clock, joint = self._bench.clock, servo.joint
        if clock.now_ns() < self._ask_again_ns.get(joint, 0):
            return
        block, _ = line.hear_block(servo.id, FIRST, LAST)
        if block is None:
            self._ask_again_ns[joint] = clock.now_ns() + ABSENT_NS
        else:
            self._images[joint] = clock.now_ns(), RegisterImage(servo.model, block)

    def _joint(self, bus: str, servo: ExpectedServo, now_ns: int) -> JointReading:
        if servo.joint not in self._images:
            return JointReading(servo.joint, bus, servo.id, None)
        heard_ns, image = self._images[servo.joint]
        return JointReading(
            joint=servo.joint,
            bus=bus,
            id=servo.id,
            position_deg=float(np.degrees(self._angle(self._joints[servo.joint], image))),
            velocity_dps=float(np.degrees(VELOCITY_UNIT * image[Register.PRESENT_VELOCITY]))
            * self._joints[servo.joint].direction,
            temperature_c=image[Register.PRESENT_TEMPERATURE],
            voltage_v=round(VOLTAGE_UNIT * image[Register.PRESENT_INPUT_VOLTAGE], 1),
            torque_on=bool(image[Register.TORQUE_ENABLE]),
            error=errors_by_name(image[Register.HARDWARE_ERROR_STATUS]),
            age_ms=_NS_PER_MS * (now_ns - heard_ns),
        )

    def _angle(self, joint: Joint, image: RegisterImage) -> float:
        offsets = self._calibration.joint_offsets if self._calibration else {}
        return joint_angle(image, joint.direction, offsets.get(joint.name, 0.0))

    def _board(self, name: str, now_ns: int) -> BoardReading:
        kind = self._bench.description.boards[name].kind
        if name not in self._frames:
            return BoardReading(name, kind, {})
        heard_ns, frame = self._frames[name]
        age_ms = _NS_PER_MS * (now_ns - heard_ns)
        if isinstance(frame, ImuFrame):
            return self._imu(name, frame, age_ms)
        return self._foot(name, frame, age_ms)

    def _foot(self, name: str, frame: FootFrame, age_ms: float) -> BoardReading:
        feet = self._bench.description.feet
        side = next((side for side, foot in feet.items() if foot.board == name), None)
        own = self._calibration.feet.get(side) if self._calibration and side else None
        values, unit = np.array(frame.counts, dtype=float), "counts"
        if own is not None:
            force = np.zeros(4)
            whole = frame._replace(status=ALL_CELLS)
            FootConverter(own).convert(whole, force)
            values, unit = force, "N"
        bad = tuple(name for i, name in enumerate(CORNERS) if not frame.status >> i & 1)
        return BoardReading(
            name, "foot", dict(zip(CORNERS, values.tolist(), strict=True)), unit, bad, age_ms
        )

    def _imu(self, name: str, frame: ImuFrame, age_ms: float) -> BoardReading:
        q = ORIENTATION_UNIT * np.array(frame.orientation)
        gyro = GYRO_UNIT * np.array(frame.gyro)
        force = ACCELERATION_UNIT * np.array(frame.acceleration)
        if self._calibration is not None:
            ImuConverter(self._calibration.imu).convert(frame, q, gyro, force)
        w, x, y, z = q
        angles = (
            np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
            np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0)),
            np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
        )
        names = ("roll_deg", "pitch_deg", "yaw_deg")
        values = dict(zip(names, np.degrees(angles).tolist(), strict=True))
        values |= dict(zip(("x_dps", "y_dps", "z_dps"), np.degrees(gyro).tolist(), strict=True))
        values |= dict(zip(("x_mps2", "y_mps2", "z_mps2"), force.tolist(), strict=True))
        missing = ImuStatus.ALL & ~ImuStatus(frame.status)
        bad = tuple((part.name or "").lower() for part in missing)
        return BoardReading(name, "imu", values, "", bad, age_ms)
