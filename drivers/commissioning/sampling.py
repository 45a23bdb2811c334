"""Watching a limp robot for a moment: raw joint angles, raw cells, the IMU in its own axes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

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
from drivers.commissioning.line import ServoLine
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.settings import RegisterImage, read_image
from drivers.dynamixel.audit import ExpectedServo
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.group_access import GroupAccess
from hil.bringup.moment import Cells, Inertia, Moment
from hil.interface import Floats
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN

LOOK_NS = 20_000_000
"""Between two looks at the joints [ns]."""
ASKED = 5
"""How often a servo is asked for its registers before it counts as absent."""
OLD_NS = 60_000_000
"""How long what an adapter still holds may take to come [ns] (assumed)."""
FEW, WAITS = 100, 4
"""Frames of each board that a mean wants, and how many times as long one waits for them."""


@dataclass(frozen=True, slots=True)
class _Bus:
    name: str
    line: ServoLine
    joints: dict[int, str]
    """By id."""


class RobotSampler:
    """Reads positions and frames, and nothing is ever written.

    Joints that do not answer when it begins are absent.
    """

    def __init__(self, bench: RobotBench) -> None:
        """Ask all servos once. Raises BackendError for a port that is lost."""
        self._bench = bench
        self._direction = {j.name: j.direction for j in bench.description.joints}
        self.images: dict[str, RegisterImage] = {}
        """Registers of the joints that answer."""
        self._buses = []
        for name, line in bench.open_buses():
            present = {}
            for servo in bench.expected(name):
                image = _image(line, servo)
                if image is not None:
                    self.images[servo.joint] = image
                    present[servo.id] = servo.joint
            self._buses.append(_Bus(name, line, present))
        self._sides = {foot.board: side for side, foot in bench.description.feet.items()}

    def not_limp(self) -> Iterator[tuple[str, str]]:
        """Joints that must not be calibrated as they are, and why."""
        for joint, image in self.images.items():
            _, servo = self._bench.find(joint)
            if image[Register.MODEL_NUMBER] != servo.model.number:
                yield joint, f"is not the robot file's {servo.model.name}: stride check"
            elif image[Register.TORQUE_ENABLE]:
                yield joint, "torque is on: stride relax first"
            elif image[Register.HOMING_OFFSET]:
                homing = image[Register.HOMING_OFFSET]
                why = "offsets live in the calibration file (stride setup)"
                yield joint, f"Homing Offset is {homing}, must be 0: {why}"

    def servo_facts(self) -> dict[str, str]:
        """Model, id and firmware of every joint that answers."""
        facts = {}
        for joint, image in self.images.items():
            bus, servo = self._bench.find(joint)
            firmware = image[Register.FIRMWARE_VERSION]
            facts[joint] = f"{servo.model.name}, {bus} id {servo.id}, firmware {firmware}"
        return facts

    def angles(self) -> dict[str, float]:
        """Joint angles without their offsets [rad], of the joints that answer now."""
        found = {}
        for bus in self._buses:
            group = GroupAccess(bus.line.port, bus.line.timing, self._bench.clock)
            for servo_id, counts in group.read(Register.PRESENT_POSITION, list(bus.joints)).items():
                joint = bus.joints[servo_id]
                turned = (counts - CENTRE_COUNTS) / COUNTS_PER_RADIAN
                found[joint] = self._direction[joint] * turned
        return found

    def watch(self, seconds: float, *, joints: bool = True) -> Moment:
        """Everything over a while, or all but the joints. Raises BackendError."""
        clock, boards = self._bench.clock, self._bench.boards
        looks: list[dict[str, float]] = []
        frames: dict[str, list[Frame]] = {name: [] for name in boards}
        readers = {name: FrameReader() for name in boards}
        self._drop_old_frames()
        end_ns = clock.now_ns() + round(seconds * 1e9)
        last_ns = end_ns + round(WAITS * seconds * 1e9)
        while (now_ns := clock.now_ns()) < end_ns or (
            now_ns < last_ns and any(len(one) < FEW for one in frames.values())
        ):
            looks.append(self.angles() if joints else {})
            for name, port in boards.items():
                frames[name] += readers[name].feed(port.read_available())
            clock.sleep_until_ns(now_ns + LOOK_NS)
        heard = {joint for look in looks for joint in look}
        rows = {joint: [look[joint] for look in looks if joint in look] for joint in heard}
        return Moment(
            {joint: float(np.mean(row)) for joint, row in rows.items()},
            {joint: max(row) - min(row) for joint, row in rows.items()},
            self._feet(frames),
            self._imu(frames),
        )

    def let_boards_talk(self) -> None:
        """Take what boards have sent, so that it does not pile up while nobody listens."""
        for port in self._bench.boards.values():
            port.read_available()

    def _drop_old_frames(self) -> None:
        """What waited in drivers and adapters."""
        clock, boards = self._bench.clock, self._bench.boards
        end_ns = clock.now_ns() + OLD_NS
        while boards and clock.now_ns() < end_ns:
            self.let_boards_talk()
            clock.sleep_until_ns(clock.now_ns() + LOOK_NS)

    def _feet(self, frames: dict[str, list[Frame]]) -> dict[str, Cells]:
        feet: dict[str, Cells] = {}
        for name, side in self._sides.items():
            found = [one for one in frames.get(name or "", ()) if isinstance(one, FootFrame)]
            if found:
                counts = np.array([frame.counts for frame in found], dtype=float)
                status = np.bitwise_and.reduce([frame.status & ALL_CELLS for frame in found])
                valid = tuple(bool(status >> cell & 1) for cell in range(4))
                feet[side] = Cells(counts.mean(axis=0), counts.std(axis=0), valid)
        return feet

    def _imu(self, frames: dict[str, list[Frame]]) -> Inertia | None:
        imu = self._bench.description.imu
        found = [
            frame for frame in frames.get(imu.board if imu else "", ())
            if isinstance(frame, ImuFrame) and frame.status & ImuStatus.ALL == ImuStatus.ALL
        ]  # fmt: skip
        if not found:
            return None
        gyro = GYRO_UNIT * np.array([frame.gyro for frame in found], dtype=float)
        force = ACCELERATION_UNIT * np.array([one.acceleration for one in found], dtype=float)
        orientation: Floats = ORIENTATION_UNIT * np.array(found[-1].orientation, dtype=float)
        return Inertia(
            force.mean(axis=0), gyro.mean(axis=0), orientation, float(gyro.std(axis=0).max())
        )


def _image(line: ServoLine, servo: ExpectedServo) -> RegisterImage | None:
    """Registers of a servo; None for one that is silent again and again."""
    for _ in range(ASKED):
        image = read_image(line, servo.id, servo.model)
        if image is not None:
            return image
    return None
