"""The motors of a virtual robot: constants of its servo models, and readings as registers."""

import struct
from typing import NamedTuple

import numpy as np

from drivers.dynamixel.control_table import VELOCITY_UNIT, VOLTAGE_UNIT
from drivers.dynamixel.servo_models import ServoModel, find_servo_model
from hil.description import RobotDescription
from hil.errors import InputError
from hil.servo import PWM_FULL, MotorParameters
from sim_backends.plant import Plant
from sim_backends.servo_physics import ServoPhysics


def servo_models(description: RobotDescription) -> list[ServoModel]:
    """Model of every joint's servo. Raises InputError for a robot without servos."""
    names = [joint.servo for joint in description.joints if joint.servo is not None]
    if len(names) < len(description.joints):
        raise InputError(f"{description.file}: {description.name} has no servos to emulate")
    return [find_servo_model(name) for name in names]


def nominal_motors(description: RobotDescription) -> MotorParameters:
    """Motor constants of a servo robot as the data sheets of its servos have them."""
    models = servo_models(description)
    return MotorParameters(
        np.array([model.torque_constant for model in models]),
        np.array([model.resistance for model in models]),
        np.array([float(model.gain_divisor) for model in models]),
        np.array([joint.direction for joint in description.joints], dtype=np.int64),
    )


class Reading(NamedTuple):
    """What one servo measures, in register units."""

    pwm: int
    current: int
    velocity: int
    position: int
    """[counts], without homing offset and drive mode."""
    voltage: int
    temperature: int


class MotorBank:
    """All motors of a plant, read together once a grid point at most."""

    def __init__(self, plant: Plant, physics: ServoPhysics, models: list[ServoModel]) -> None:
        self.physics = physics
        self._plant = plant
        # A model without current measurement shows load in 0.1 % of stall instead.
        stall = physics.motors.stall_torque(physics.supply.voltage) / physics.motors.torque_constant
        self._current_unit = [
            float(amps) / 1000 if model.current_unit is None else model.current_unit
            for model, amps in zip(models, stall, strict=True)
        ]
        self._index = -1
        self._readings: list[Reading] = []

    def readings(self) -> list[Reading]:
        """Readings of all motors at the last grid point."""
        index = self._plant.substep_index
        if index != self._index:
            self._index = index
            self._readings = self._read()
        return self._readings

    def _read(self) -> list[Reading]:
        physics = self.physics
        voltage = round(physics.voltage / VOLTAGE_UNIT)
        return [
            Reading(
                round(duty * PWM_FULL), round(current / unit), round(speed / VELOCITY_UNIT),
                int(counts), voltage, degrees,
            )
            for counts, speed, duty, current, unit, degrees in zip(
                *physics.measured, self._current_unit, physics.degrees(), strict=True
            )
        ]  # fmt: skip


class Motor:
    """One motor of the bank, as its servo's electronics has it."""

    def __init__(self, bank: MotorBank, index: int) -> None:
        self._bank = bank
        self._index = index

    def reading(self) -> Reading:
        """What the servo measures now."""
        return self._bank.readings()[self._index]

    def enable(self, on: bool) -> None:
        """Bridge on or open."""
        self._bank.physics.set_enabled(self._index, on)

    def set_goal(self, counts: int) -> None:
        """Position goal [counts]; acts from the next grid point."""
        self._bank.physics.goal[self._index] = counts

    def set_gains(self, p_gain: int, d_gain: int, pwm_limit: int) -> None:
        """Gains and drive limit as register values; act from the next grid point."""
        self._bank.physics.set_gains(self._index, p_gain, d_gain, pwm_limit)


PRESENT = struct.Struct("<HBBhhiiiiHB")
"""Realtime Tick (120) to Present Temperature (146), in the order of the control table."""
