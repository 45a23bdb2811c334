"""IMU: bias of its gyro, and how it sits on the torso; the torso is held level and tilted."""

from dataclasses import dataclass

import numpy as np

from hil.bringup.calibrating import Calibrating
from hil.bringup.deed import Deed
from hil.bringup.imu_mounting import LEAST_TILT, Mounting, MountingError, mounting_from_tilts
from hil.bringup.joint_signs import middle_pose
from hil.bringup.moment import Inertia
from hil.errors import InputError
from hil.interface import GRAVITY, Floats

LISTEN_S = 2.0
"""How long one listens to a level torso: noise of 0.02 rad/s becomes a bias within 0.001 rad/s."""
ASKED_RAD = np.radians(25.0)
MOST_BIAS = np.radians(5.0)
"""More is a gyro out of its data sheet, or a robot that turns slowly [rad/s] (assumed)."""
GRAVITY_TOLERANCE = 0.15
"""Of the accelerometer, relative; as in `stride check`."""
OWN_TILT = np.radians(10.0)
"""Between the vertical of the sensor's orientation and that of its accelerometer (assumed)."""
UPSIDE_DOWN = -0.7
"""Share of the vertical along the sensor's own z from which it is upside down."""


@dataclass(frozen=True, slots=True)
class ImuRequest:
    """What is to be done."""

    square: bool = True
    """The board is mounted square to the torso, as boards are."""
    upside_down: bool = False
    """The board is mounted upside down."""


def calibrate_imu(work: Calibrating, request: ImuRequest) -> tuple[Mounting, Floats]:
    """Ask, look, and write the file; the gyro's bias in sensor axes [rad/s] is returned too.

    Raises RefusedError, and nothing is written then.
    """
    if work.description.imu is None:
        raise InputError(f"{work.description.name} has no IMU")
    level = _level(work, request)
    tilts = {}
    for name, what, deed in (
        ("forward", "its face goes down", Deed(tilt=(0.0, ASKED_RAD))),
        ("left", "its left side goes down", Deed(tilt=(-ASKED_RAD, 0.0))),
    ):
        work.dialogue.say(
            f"Tilt the torso {name} by about {np.degrees(ASKED_RAD):.0f}°, {what}, and hold it",
            deed,
        )
        tilts[name] = _await_tilt(work, level.force)
        work.wait("Upright again", Deed(tilt=(0.0, 0.0)))
    try:
        mounting = mounting_from_tilts(
            level.force, tilts["forward"], tilts["left"], square=request.square
        )
    except MountingError as error:
        work.inspection.expect(False, "imu", str(error), "once more from the start")
        work.settle()
        raise
    yaw = "square" if request.square else "as tilted"
    work.file.keep_imu(
        np.round(mounting.quaternion, 7).tolist(), np.round(level.gyro, 6).tolist(),
        f"level and two tilts, yaw {yaw}", abs(mounting.skew) / 2,
    )  # fmt: skip
    return mounting, level.gyro


def _level(work: Calibrating, request: ImuRequest) -> Inertia:
    work.wait(
        "Hold the torso exactly upright (spirit level, jig or plumb line) and still",
        Deed(lifted=True, tilt=(0.0, 0.0), joints=middle_pose(work)),
    )
    imu = work.still(LISTEN_S).imu
    if imu is None:
        work.inspection.expect(False, "imu", "its board sends nothing valid", "stride check")
        work.settle()
        raise InputError("imu: its board sends nothing valid")
    size, bias = float(np.linalg.norm(imu.force)), float(np.abs(imu.gyro).max())
    work.inspection.expect(
        abs(size - GRAVITY) <= GRAVITY_TOLERANCE * GRAVITY, "imu",
        f"measures {size:.1f} m/s² at rest instead of {GRAVITY:.1f}", "hold it still; its range",
    )  # fmt: skip
    work.inspection.expect(
        bias <= MOST_BIAS, "imu",
        f"its gyro says {np.degrees(bias):.1f} °/s at rest", "hold it still, or let it warm up",
    )  # fmt: skip
    _compare_own(work, imu)
    share = float(imu.force[2]) / size
    work.inspection.expect(
        share > UPSIDE_DOWN or request.upside_down, "imu",
        "is upside down: at rest its z axis points to the ground",
        "turn the board, or the robot; --upside-down if the board is mounted so",
    )  # fmt: skip
    work.settle()
    return imu


def _compare_own(work: Calibrating, imu: Inertia) -> None:
    """The vertical of the sensor's own orientation, against that of its accelerometer."""
    w, x, y, z = imu.orientation / np.linalg.norm(imu.orientation)
    own = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    cosine = float(np.dot(own, imu.force) / np.linalg.norm(imu.force))
    apart = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
    work.inspection.expect(
        apart <= OWN_TILT, "imu",
        f"its orientation and its accelerometer differ by {np.degrees(apart):.0f}°",
        "restart it; its firmware's axes",
    )  # fmt: skip


def _await_tilt(work: Calibrating, level: Floats) -> Floats:
    """The force once the torso is tilted enough and held still."""
    up = level / np.linalg.norm(level)
    while True:
        imu = work.still().imu
        if imu is not None:
            cosine = float(np.dot(imu.force, up) / np.linalg.norm(imu.force))
            angle = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
            if angle > LEAST_TILT:
                work.dialogue.say(f"  {np.degrees(angle):.0f}°: good")
                return imu.force
        work.pause()
