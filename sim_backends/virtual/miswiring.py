"""A virtual robot that is not put together as its robot file says."""

from collections.abc import Callable, Iterable, MutableMapping
from typing import TypeVar

import mujoco
import numpy as np

from drivers.dynamixel.servo_models import find_servo_model
from hil.description import Joint, RobotDescription
from hil.interface import CORNERS
from hil.miswire import Miswire
from sim_backends.sensor_models import ImuSample
from sim_backends.virtual.robot import VirtualRobot

T = TypeVar("T")


def built_wrongly(description: RobotDescription, wrong: Iterable[Miswire]) -> RobotDescription:
    """The robot as it really is: exchanged ids, mirrored servos, other models, another pack."""
    joints = {joint.name: joint for joint in description.joints}
    supply = description.supply
    for one in wrong:
        first, *rest = one.values
        if one.kind == "swap" and first in joints:
            a, b = joints[first], joints[rest[0]]
            joints[first] = _changed(a, bus=b.bus, id=b.id)
            joints[rest[0]] = _changed(b, bus=a.bus, id=a.id)
        elif one.kind == "mirror":
            joints[first] = _changed(joints[first], direction=-joints[first].direction)
        elif one.kind == "model":
            joints[first] = _changed(joints[first], servo=find_servo_model(rest[0]).name)
        elif one.kind == "volts" and supply is not None:
            supply = supply.model_copy(update={"voltage": float(first)})
    return description.model_copy(
        update={
            "joints": tuple(joints[name] for name in description.joint_names),
            "supply": supply,
        }
    )


def _changed(joint: Joint, **values: object) -> Joint:
    return joint.model_copy(update=values)


def mount_wrongly(robot: VirtualRobot, wrong: Iterable[Miswire]) -> None:
    """What is wrong beside the servos' places: horns, IMU, wires of cells, firmware."""
    names = robot.description.joint_names
    for one in wrong:
        first, *rest = one.values
        if one.kind == "offset" and robot.world.servos is not None:
            robot.world.servos.put_on_horn(names.index(first), float(np.radians(float(rest[0]))))
        elif one.kind == "imu":
            robot.imu.turn = _turned([float(value) for value in one.values])
        elif one.kind == "cells":
            _exchange_cells(robot, first, rest)
        elif one.kind == "firmware":
            robot.inject(f"servo:{first}:old_firmware={rest[0]}")


def plug_wrongly(lines: MutableMapping[str, T], wrong: Iterable[Miswire]) -> None:
    """Exchange what is on two lines, by the names of buses and boards."""
    for one in wrong:
        if one.kind == "swap" and set(one.values) <= set(lines):
            a, b = one.values
            lines[a], lines[b] = lines[b], lines[a]


def _exchange_cells(robot: VirtualRobot, board: str, corners: list[str]) -> None:
    sides = {foot.board: side for side, foot in robot.description.feet.items()}
    cells = robot.cells[sides[board]]
    order = list(range(len(CORNERS))) if cells.order is None else cells.order
    a, b = (CORNERS.index(corner) for corner in corners)
    order[a], order[b] = order[b], order[a]
    cells.order = order


def _turned(degrees: list[float]) -> Callable[[ImuSample], ImuSample]:
    """From base axes into those of a sensor that is turned by roll, pitch and yaw [°]."""
    mounting = np.zeros(4)
    mujoco.mju_euler2Quat(mounting, np.radians(degrees), "XYZ")
    back = mounting * (1.0, -1.0, -1.0, -1.0)

    def seen(vector: list[float]) -> list[float]:
        result = np.zeros(3)
        mujoco.mju_rotVecQuat(result, np.array(vector), back)
        return list(result.tolist())

    def turn(sample: ImuSample) -> ImuSample:
        orientation, gyro, force = sample
        turned = np.zeros(4)
        mujoco.mju_mulQuat(turned, np.array(orientation), mounting)
        return turned.tolist(), seen(gyro), seen(force)

    return turn
