"""minibiped on the simulated plant with its real gain mapping, estimator and walker."""

import numpy as np

from controller.estimation.sensors import SensorEstimator
from controller.walking.servo_walker import ServoWalker
from drivers.calibration import RobotCalibration
from drivers.dynamixel.gain_mapping import GainMapping
from hil.clock import tick_time_ns
from hil.interface import JointCommand, Reference
from hil.robot_files import load_robot
from sim_backends.mujoco_backend import MujocoBackend
from sim_backends.plant import Plant

FALLEN = 0.15
"""Height of the hips below which the robot has fallen [m]."""


def minibiped(walking=(), overrides=(), imu=True):
    """The nominal robot, with changes of the walking section as ("section.key", value)."""
    description = load_robot("minibiped", ("plant.draws=null", *overrides))
    for path, value in walking:
        *sections, key = path.split(".")
        place = description.walking
        for section in sections:
            place = place[section]
        place[key] = value
    return description if imu else description.model_copy(update={"imu": None})


class ServoBench:
    def __init__(self, description, rate=300, seed=0, spoil=None):
        self.description, self.rate = description, rate
        calibration = RobotCalibration(
            robot="minibiped", provenance={"date": "2026-01-01", "method": "ideal"}
        )
        mapping = GainMapping(description, calibration)
        self.plant = Plant(description, rate, seed, mapping.motor_parameters())
        self.backend = MujocoBackend(description, self.plant, mapping, rate, seed)
        self.estimator = SensorEstimator(description, rate)
        self.walker = ServoWalker(description, rate)
        self.spoil = spoil
        """Changes a frame on its way to the estimator."""
        self.hold = JointCommand.zeros(len(description.joints))
        self.hold.position[:] = description.start_position
        self.hold.stiffness[:] = [joint.stiffness for joint in description.joints]
        self.hold.damping[:] = [joint.damping for joint in description.joints]
        self.tick = 0
        self.backend.open()
        self.backend.read()
        self.backend.arm()
        self.stand(0.3)
        self.plant.set_support(False)

    def run(self, reference=None):
        """One tick, walking with a reference or holding `hold`. Returns the estimate."""
        frame = self.backend.read()
        if self.spoil is not None:
            self.spoil(frame)
        estimate = self.estimator.update(frame)
        command = self.hold if reference is None else self.walker.step(estimate, reference)
        self.backend.write(command)
        self.tick += 1
        self.backend.clock.sleep_until_ns(tick_time_ns(0, self.tick, self.rate))
        return estimate

    def stand(self, seconds):
        """Hold the start pose."""
        for _ in range(round(seconds * self.rate)):
            self.run()

    def walk(self, seconds, reference, pushed=None):
        """Walk; returns com positions (ticks, 3), or None after a fall. `pushed` maps s to N."""
        track = []
        for tick in range(round(seconds * self.rate)):
            if pushed is not None:
                self.plant.set_push(np.asarray(pushed(tick / self.rate), dtype=float))
            self.run(reference)
            truth = self.plant.truth()
            track.append(truth.com.copy())
            if truth.base_position[2] < FALLEN:
                return None
        return np.array(track)


def walk(seconds, speed=0.15, rate=300, seed=0, walking=(), overrides=(), pushed=None, **asked):
    """Start up and walk; the bench and its track."""
    bench = ServoBench(minibiped(walking, overrides), rate, seed)
    bench.stand(0.5)
    return bench, bench.walk(seconds, Reference(speed=speed, **asked), pushed)


def mean_speed(track, rate, since):
    """Mean velocity of the com from a time on [m/s], shape (2,)."""
    start = round(since * rate)
    return (track[-1, :2] - track[start, :2]) * rate / (len(track) - 1 - start)
