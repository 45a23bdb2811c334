"""One step of a servo robot: where it stands on the pendulum, when and where it lands."""

import math

import numpy as np

from controller.robot_model import RobotModel
from controller.walking.alteration import Alteration
from controller.walking.gait import Gait
from controller.walking.pendulum import Pendulum
from controller.walking.servo_config import ServoWalkingConfig
from controller.walking.step_average import StepAverage
from controller.walking.step_timing import remaining_time
from hil.interface import Estimate, Floats, Reference

MAX_PHASE_SPEEDUP = 2.5
"""Bound on how much faster than nominal the phase may run when landing is urgent."""
LOADED = 0.3
"""Share of body weight on the stance foot from which its measured cop is used."""


class ServoStep:
    """Gait state, pendulum state, landing point and centre of pressure of the current step.

    All laws in the heading frame, sagittal (x) and lateral (y):
    landing = k·ξ_T − b (ξ_T the capture point predicted at touch-down, b its steady start), and
    p = k_z·(ξ − b·e^(ωφT)) within the limits of the sole.
    """

    def __init__(
        self,
        config: ServoWalkingConfig,
        model: RobotModel,
        ankle_height: float,
        rate_hz: int,
        ankle_limit: bool,
    ) -> None:
        self._config = config
        self._model = model
        self._dt = 1.0 / rate_hz
        self._lead = config.latency + self._dt / 2
        self._ankle_height = ankle_height
        self.gait = Gait(config.gait, model.weight)
        self._alteration = Alteration(config.alteration)
        self._mean_speed = StepAverage()
        self._pendulum = Pendulum(1.0, config.gait.period)
        self._sole = _sole_extent(model)
        share = (config.balance.limit_x, config.balance.limit_y) if ankle_limit else (1.0, 1.0)
        self._pressure_limit = (share[0] * self._sole[0], share[1] * self._sole[1])
        self._speed = 0.0
        self._lateral = 0.0
        self._width = config.placement.step_width
        self.heading = 0.0
        """Tracked heading [rad]."""
        self.phase_rate = 1.0 / config.gait.period
        """dφ/dt [1/s]."""
        self.ankle: Floats = np.zeros(3)
        """Stance ankle in the world [m]."""
        self.lift_off: Floats = np.zeros(2)
        """Where the swing ankle left the ground, from the stance ankle, world axes [m]."""
        self.landing: Floats = np.zeros(2)
        """Where it will land, from the stance ankle, world axes [m]."""
        self._lift_off_yaw = 0.0
        self._begun = False
        self._place = (0.0, 0.0)
        self._velocity = (0.0, 0.0)
        self._capture = (0.0, 0.0)
        self._pressure = (0.0, 0.0)
        self._force_point = (0.0, 0.0)

    def update(self, estimate: Estimate, reference: Reference) -> None:
        """Bring the step to the estimate's time."""
        self._follow(reference)
        if not self._begun:
            self._begin_step()
            self._begun = True
        gait = self.gait
        load = float(estimate.foot_force[gait.swing].sum())
        rate = self.phase_rate * self._config.gait.period
        if gait.advance(self._dt, load, rate):
            self._alteration.end_step(self._mean_speed.finish(), self._speed)
            self._begin_step()
        loaded = estimate.foot_force[gait.stance] > gait.config.flat_corner_load * gait.weight
        gait.update_foot_flat(int(np.count_nonzero(loaded)))
        self._observe(estimate)
        self._mean_speed.add(self._velocity[0])
        self._set_pressure()
        self._set_force_point(estimate)
        remaining = self._set_timing()
        if gait.phase < self._config.placement.freeze_phase:
            self._set_landing(remaining)

    def ground_reaction(self) -> tuple[Floats, Floats]:
        """Points on the soles [m] and ground reactions [N] wanted of the feet, shape (2, 3).

        F = W·((x − p)/h, (y − p_y)/h, 1) at p. A new stance foot takes it over linearly.
        """
        model, gait = self._model, self.gait
        points = model.ankle_positions.copy()
        points[:, 2] -= self._ankle_height
        points[gait.stance, :2] += self._to_world(*self._force_point)
        height = self._model.com[2]
        push = self._to_world(
            (self._place[0] - self._force_point[0]) / height,
            (self._place[1] - self._force_point[1]) / height,
        )
        share = min(gait.time_in_step / self._config.balance.load_transfer_time, 1.0)
        if gait.steps == 0:
            share = 1.0
        force = gait.weight * np.array([push[0], push[1], 1.0])
        forces = np.empty((2, 3))
        forces[gait.stance] = share * force
        forces[gait.swing] = (1.0 - share) * force
        return points, forces

    def swing_yaw(self) -> float:
        """Heading of the swing foot: it turns into the torso's during the swing [rad]."""
        share = min(self.gait.phase / self._config.swing.landing_phase, 1.0)
        return self._lift_off_yaw + share * (self.heading - self._lift_off_yaw)

    def _follow(self, reference: Reference) -> None:
        config, dt = self._config, self._dt
        self._speed = _approach(self._speed, reference.speed, config.acceleration * dt)
        self._lateral = _approach(self._lateral, reference.lateral, config.acceleration * dt)
        self.heading = _approach(self.heading, reference.heading, config.turn_rate * dt)
        width = reference.step_width
        self._width = width if width == width else config.placement.step_width

    def _begin_step(self) -> None:
        ankles, swing = self._model.ankle_positions, self.gait.swing
        self.lift_off[:] = ankles[swing, :2] - ankles[self.gait.stance, :2]
        self.landing[:] = self.lift_off
        rotation = self._model.foot_rotations[swing]
        self._lift_off_yaw = math.atan2(rotation[1, 0], rotation[0, 0])

    def _observe(self, estimate: Estimate) -> None:
        """Pendulum state when the command will act."""
        model = self._model
        self.ankle[:] = model.ankle_positions[self.gait.stance]
        self._pendulum.omega = math.sqrt(model.gravity / model.com[2])
        velocity = estimate.com_velocity
        place = estimate.com - self.ankle + self._lead * velocity
        self._velocity = self._to_heading(velocity)
        x, y = self._to_heading(place)
        self._place = (x + self._alteration.value, y)
        omega = self._pendulum.omega
        self._capture = (
            self._place[0] + self._velocity[0] / omega,
            self._place[1] + self._velocity[1] / omega,
        )

    def _steady_start(self, swing_side: int) -> tuple[float, float]:
        pendulum = self._pendulum
        return (
            pendulum.steady_start(self._speed, 0.0),
            pendulum.steady_start(self._lateral, swing_side * self._width),
        )

    def _set_pressure(self) -> None:
        config, pendulum = self._config.balance, self._pendulum
        start = self._steady_start(-self.gait.stance_sign)
        growth = math.exp(pendulum.omega * self.gait.phase * pendulum.period)
        limit = self._pressure_limit
        self._pressure = (
            _clip(config.gain_x * (self._capture[0] - start[0] * growth), limit[0]),
            _clip(config.gain_y * (self._capture[1] - start[1] * growth), limit[1]),
        )

    def _set_force_point(self, estimate: Estimate) -> None:
        """Where the feed-forward force acts: p, moved against the error of the measured cop."""
        force = estimate.foot_force[self.gait.stance]
        load = float(force.sum())
        self._force_point = self._pressure
        config = self._config.balance
        if load < LOADED * self.gait.weight or self.gait.time_in_step < config.settle_time:
            return
        corners = self._model.corner_positions[self.gait.stance, :, :2]
        measured = self._to_heading(force @ corners / load - self.ankle[:2])
        p, limit = self._pressure, self._sole
        self._force_point = (
            _clip(p[0] + config.feedback * (p[0] - measured[0]), limit[0]),
            _clip(p[1] + config.feedback * (p[1] - measured[1]), limit[1]),
        )

    def _set_timing(self) -> float:
        """Set the phase rate; returns the remaining time of the step [s]."""
        gait, pendulum = self.gait, self._pendulum
        left = max(1.0 - gait.phase, 0.0)
        nominal = left * pendulum.period
        self.phase_rate = 1.0 / pendulum.period
        if left == 0.0:
            return 0.0
        side = gait.stance_sign
        goal = self._steady_start(-side)[1] * pendulum.growth
        time = remaining_time(
            self._config.timing, pendulum, self._capture[1], self._pressure[1], goal,
            side * self._capture[1], gait.time_in_step, nominal,
        )
        fastest = nominal / MAX_PHASE_SPEEDUP
        time = max(time, fastest)
        self.phase_rate = left / time
        return time

    def _set_landing(self, remaining: float) -> None:
        config, pendulum = self._config.placement, self._pendulum
        time = remaining + config.touch_down_delay
        side = self.gait.stance_sign
        start = self._steady_start(side)
        ahead = [
            pendulum.predict(xi, p, time)
            for xi, p in zip(self._capture, self._pressure, strict=True)
        ]
        x = config.gain_x * ahead[0] - start[0]
        y = config.gain_y * ahead[1] - start[1]
        x = _clip(x, config.max_length)
        y = -side * min(max(-side * y, config.min_width), config.max_width)
        self.landing[:] = self._to_world(x, y)

    def _to_world(self, x: float, y: float) -> tuple[float, float]:
        c, s = math.cos(self.heading), math.sin(self.heading)
        return c * x - s * y, s * x + c * y

    def _to_heading(self, vector: Floats) -> tuple[float, float]:
        c, s = math.cos(self.heading), math.sin(self.heading)
        x, y = float(vector[0]), float(vector[1])
        return c * x + s * y, c * y - s * x


def _approach(value: float, goal: float, step: float) -> float:
    return value + _clip(goal - value, step)


def _clip(value: float, limit: float) -> float:
    return max(-limit, min(value, limit))


def _sole_extent(model: RobotModel) -> tuple[float, float]:
    """Distance of the ankle from the nearer sole end and from the nearer sole side [m]."""
    corners = np.abs(model.corner_positions[0] - model.ankle_positions[0])
    return float(corners[:, 0].min()), float(corners[:, 1].min())
