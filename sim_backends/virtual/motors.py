"""The motors of a virtual robot: constants of its servo models, and readings as registers."""

import math
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
        stall = physics.supply.voltage / physics.motors.resistance
        self._current_unit = [
            float(amps) / 1000 if model.current_unit is None else model.current_unit
            for model, amps in zip(models, stall, strict=True)
        ]
        self._index = -1
        self._readings: list[Reading] = []

    def reading(self, motor: int) -> Reading:
        """Reading of one motor at the last grid point."""
        index = self._plant.substep_index
        if index != self._index:
            self._index = index
            self._readings = self._read()
        return self._readings[motor]

    def _read(self) -> list[Reading]:
        physics = self.physics
        voltage = round(physics.measured_voltage / VOLTAGE_UNIT)
        counts, speeds, duties, _ = physics.measured
        return [
            Reading(
                round(duty * PWM_FULL), round(current / unit), round(speed / VELOCITY_UNIT),
                int(count), voltage, degrees,
            )
            for count, speed, duty, current, unit, degrees in zip(
                counts, speeds, duties, physics.sensed_current.tolist(), self._current_unit,
                physics.degrees(), strict=True,
            )
        ]  # fmt: skip


class Motor:
    """One motor of the bank, as its servo's electronics has it: everything in register units.

    Goals and settings act from the next grid point. Nothing of the register file is kept here but
    what the loops, the protection and the bridge need; a reboot clears none of the settings.
    """

    def __init__(self, bank: MotorBank, index: int) -> None:
        self._bank = bank
        self._index = index
        self._firmware = bank.physics.firmware[index]

    def reading(self) -> Reading:
        """What the servo measures now."""
        return self._bank.reading(self._index)

    def trajectory(self) -> tuple[int, int]:
        """Velocity Trajectory [0.229 rev/min] and Position Trajectory [counts]."""
        return self._firmware.trajectory()

    def enable(self, on: bool) -> None:
        """Bridge on or open; after a shutdown it stays open until `reboot`."""
        self._bank.physics.set_enabled(self._index, on)

    def set_mode(self, mode: int) -> None:
        """Operating Mode: 0, 1, 3, 4, 5 or 16."""
        self._firmware.mode = mode
        self._firmware.restart(self._bank.physics.measured.counts[self._index])
        self._bank.physics.refresh()

    def set_goal(self, counts: int) -> None:
        """Position goal [counts]."""
        self._bank.physics.goal[self._index] = counts

    def set_goal_current(self, counts: int) -> None:
        """Goal Current: the goal in mode 0, the limit in mode 5."""
        self._firmware.goal_current = counts

    def set_goal_velocity(self, velocity: int) -> None:
        """Goal Velocity [0.229 rev/min], for mode 1."""
        self._firmware.goal_velocity = velocity

    def set_goal_pwm(self, pwm: int) -> None:
        """Goal PWM: the goal in mode 16, else the limit."""
        self._firmware.goal_pwm = pwm
        self._bank.physics.refresh()

    def set_gains(
        self, p: int, i: int, d: int, feed_forward_1: int = 0, feed_forward_2: int = 0
    ) -> None:
        """Position P, I, D gain and feed-forward gains of velocity (1st) and acceleration (2nd)."""
        firmware = self._firmware
        firmware.p_gain, firmware.i_gain, firmware.d_gain = p, i, d
        firmware.feed_forward_1, firmware.feed_forward_2 = feed_forward_1, feed_forward_2
        self._bank.physics.refresh()

    def set_velocity_gains(self, p: int, i: int) -> None:
        """Velocity P and I gain, for mode 1."""
        self._firmware.velocity_p_gain, self._firmware.velocity_i_gain = p, i

    def set_limits(self, pwm_limit: int, current_limit: int | None) -> None:
        """PWM Limit and Current Limit; None for a model without current control."""
        self._firmware.pwm_limit = pwm_limit
        self._firmware.current_limit = math.inf if current_limit is None else current_limit
        self._bank.physics.refresh()

    def set_pwm_slope(self, slope: int | None) -> None:
        """PWM Slope; None for a model without it."""
        self._firmware.pwm_slope = slope
        self._bank.physics.refresh()

    def set_profile(self, velocity: int, acceleration: int, time_based: bool = False) -> None:
        """Profile Velocity and Profile Acceleration, and whether drive mode makes them times."""
        self._firmware.profile.configure(velocity, acceleration, time_based)
        self._bank.physics.refresh()

    def set_protection(
        self, temperature_limit: int, min_voltage: int, max_voltage: int, shutdown: int
    ) -> None:
        """Temperature Limit [°C], voltage limits [0.1 V] and Shutdown mask."""
        protection, index = self._bank.physics.protection, self._index
        protection.temperature_limit[index] = temperature_limit
        # A reading is rounded to 0.1 V before it is compared.
        protection.lowest_voltage[index] = (min_voltage - 0.5) * VOLTAGE_UNIT
        protection.highest_voltage[index] = (max_voltage + 0.5) * VOLTAGE_UNIT
        protection.shutdown[index] = shutdown

    def hardware_error(self) -> int:
        """Hardware Error Status: latched bits; one in the Shutdown mask has opened the bridge."""
        errors: int = self._bank.physics.protection.errors.item(self._index)
        return errors

    def reboot(self) -> None:
        """Torque off and errors forgotten; then set everything again."""
        self._bank.physics.reboot(self._index)


PRESENT = struct.Struct("<HBBhhiiiiHB")
"""Realtime Tick (120) to Present Temperature (146), in the order of the control table."""
