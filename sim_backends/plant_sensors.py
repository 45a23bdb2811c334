"""Sensor frames straight from a plant: the errors and delays of the sensors, without the bytes."""

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from hil.interface import CORNERS, SIDES, Floats, SensorFrame
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN
from sim_backends.latency import board_age_ns
from sim_backends.plant import Plant
from sim_backends.sensor_models import CellErrors, ImuErrors, ImuSample, dead_cells
from sim_backends.servo_physics import ServoPhysics

VELOCITY_UNIT = 0.229 * 2 * np.pi / 60
"""[rad/s] of one Present Velocity count (X-series e-manual)."""
VOLTAGE_UNIT = 0.1
"""[V] of one Present Input Voltage count."""

SampleT = TypeVar("SampleT")


class DelayedSamples(Generic[SampleT]):
    """Samples taken on the physics grid, given out when they are old enough."""

    def __init__(self, plant: Plant, delay_ns: int, take: Callable[[], SampleT]) -> None:
        grid_ns = 1_000_000_000 / (plant.rate_hz * plant.substeps)
        self._plant = plant
        self._delay = round(delay_ns / grid_ns)
        self.phase = -self._delay % plant.substeps
        """Substep of a tick at whose end a sample is the one that a later tick will want."""
        self._take = take
        self._samples = deque([(plant.substep_index, take())])

    def take(self) -> None:
        """Take a sample now."""
        self._samples.append((self._plant.substep_index, self._take()))

    def latest(self) -> tuple[int, SampleT]:
        """Grid time [ns] and value of the newest sample that is old enough."""
        newest = self._plant.substep_index - self._delay
        while len(self._samples) > 1 and self._samples[1][0] <= newest:
            self._samples.popleft()
        index, sample = self._samples[0]
        return self._plant.grid_time_ns(index), sample


class PlantSensors:
    """Fills sensor frames from a plant.

    A servo robot's joints read as its registers would: counts of the encoder, 0.229 rev/min,
    0.1 V, 1 °C. A torque robot's joints are exact. Cells and IMU err as `description.noise`
    says, and are as old as their boards' wires make them.
    """

    def __init__(self, plant: Plant, seed: int) -> None:
        description = plant.description
        # Another stream than that of the plant's own draws from the same seed.
        random = np.random.default_rng((seed, 1))
        self._plant = plant
        dead = {
            index * len(CORNERS) + corner
            for index, side in enumerate(SIDES)
            for corner in dead_cells(description, side)
        }
        self._cells = CellErrors(description.noise, random, len(SIDES) * len(CORNERS), dead)
        self._zero: list[float] = self._cells.zero.tolist()
        self._imu_errors = ImuErrors(description.noise, random, plant.hidden.pitch_bias)
        foot_board = description.feet["left"].board
        delay = board_age_ns(description, description.boards[foot_board]) if foot_board else 0
        self._feet = DelayedSamples(plant, delay, self._sample_feet)
        self._imu: DelayedSamples[ImuSample] | None = None
        if description.imu is not None:
            delay = board_age_ns(description, description.boards[description.imu.board])
            self._imu = DelayedSamples(plant, delay, self._sample_imu)
        motors = plant.motors
        if motors is not None:
            self._torque_unit = motors.direction * motors.torque_constant
        self._angle_unit = np.array([j.direction for j in description.joints]) / COUNTS_PER_RADIAN

    def after_substep(self) -> None:
        """Sample what a later frame will hold."""
        phase = self._plant.substep_index % self._plant.substeps
        if phase == self._feet.phase:
            self._feet.take()
        if self._imu is not None and phase == self._imu.phase:
            self._imu.take()

    def _sample_feet(self) -> list[float]:
        forces = self._cells.measure(self._plant.corner_forces())
        return [force + zero for force, zero in zip(forces, self._zero, strict=True)]

    def _sample_imu(self) -> ImuSample:
        plant = self._plant
        return self._imu_errors.measure(
            plant.orientation, plant.angular_velocity, plant.specific_force()
        )

    def fill(self, frame: SensorFrame, now_ns: int, torque: Floats) -> None:
        """Write the frame of this moment; `torque` [N·m] is what a torque robot applies."""
        frame.time_ns = now_ns
        plant = self._plant
        if plant.servos is not None:
            self._fill_servo_joints(frame, plant.servos)
        else:
            frame.joint_position[:] = plant.joint_position
            frame.joint_velocity[:] = plant.joint_velocity
            frame.joint_torque[:] = torque
        frame.joint_age_ns.fill(now_ns - plant.time_ns)
        frame.joint_valid.fill(True)
        taken_ns, force = self._feet.latest()
        frame.foot_force.ravel()[:] = force
        frame.foot_age_ns.fill(now_ns - taken_ns)
        frame.foot_valid.fill(True)
        if self._imu is not None:
            self._fill_imu(frame, *self._imu.latest())

    def _fill_imu(self, frame: SensorFrame, taken_ns: int, sample: ImuSample) -> None:
        frame.imu_orientation[:] = sample[0]
        frame.imu_angular_velocity[:] = sample[1]
        frame.imu_linear_acceleration[:] = sample[2]
        frame.imu_age_ns = frame.time_ns - taken_ns
        frame.imu_valid = True

    def _fill_servo_joints(self, frame: SensorFrame, servos: ServoPhysics) -> None:
        position, velocity = frame.joint_position, frame.joint_velocity
        np.subtract(servos.counts, CENTRE_COUNTS, position)
        np.multiply(position, self._angle_unit, position)
        # Rounding is the same in both directions, so the servo's own sign does not matter.
        np.divide(self._plant.joint_velocity, VELOCITY_UNIT, velocity)
        np.rint(velocity, velocity)
        np.multiply(velocity, VELOCITY_UNIT, velocity)
        np.multiply(servos.sensed_current, self._torque_unit, frame.joint_torque)
        frame.joint_error[:] = servos.protection.errors
        frame.joint_temperature[:] = servos.degrees()
        frame.joint_voltage.fill(round(servos.measured_voltage / VOLTAGE_UNIT) * VOLTAGE_UNIT)
