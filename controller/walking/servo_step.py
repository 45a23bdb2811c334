"""One step of a servo robot: the shared gait on the pendulum, when and where it lands."""

import math

from controller.robot_model import RobotModel
from controller.walking.alteration import Alteration
from controller.walking.balance import Balance
from controller.walking.capture_placement import landing_point
from controller.walking.command_ramp import CommandRamp
from controller.walking.gait import Gait
from controller.walking.heading import HeadingRamp
from controller.walking.heading_frame import HeadingFrame, Pair
from controller.walking.height_trim import HeightTrim
from controller.walking.landing_trim import LandingTrim
from controller.walking.pendulum_state import PendulumState
from controller.walking.place_trim import PlaceTrim
from controller.walking.rotations import heading_of
from controller.walking.servo_config import ServoWalkingConfig
from controller.walking.sole_trim import SoleTrim
from controller.walking.step_average import StepAverage
from controller.walking.step_timing import remaining_time
from hil.interface import Estimate, Reference

UNLOADED = 0.05
"""Load of the swing foot, as a fraction of body weight, below which the stance is a single one."""
MAX_SPEEDUP = 2.5
"""How much faster than nominal the phase may run when landing is urgent."""


class ServoStep:
    """Gait, commands, pendulum state, centre of pressure, timing and landing point, tick by tick.

    Attributes belong to the last `update`; pairs are world x and y.
    """

    def __init__(
        self, config: ServoWalkingConfig, model: RobotModel, rate_hz: int, ankle_limit: bool
    ) -> None:
        self._config = config
        self._model = model
        self._dt = 1.0 / rate_hz
        self.gait = Gait(config.gait, model.weight)
        self.heading_ramp = HeadingRamp(config.heading)
        self._command = CommandRamp(config.command)
        self._alterations = Alteration(config.alteration), Alteration(config.lateral_alteration)
        self._mean_speeds = StepAverage(), StepAverage()
        self.trim = PlaceTrim(config.place_trim)
        self.landing_trim = LandingTrim(config.landing_trim)
        self.sole_trim = SoleTrim(config.sole_trim)
        self.height_trim = HeightTrim(config.height_trim)
        self.frame = HeadingFrame()
        lead = config.latency + self._dt / 2
        self.state = PendulumState(model, config.gait.period, lead)
        self.balance = Balance(config.balance, model, ankle_limit)
        self._speed: Pair = (0.0, 0.0)
        self._width = config.placement.step_width
        self._lift_off_yaw = 0.0
        self._begun = False
        self._goal: Pair = (0.0, 0.0)
        """Where the swing ankle should stand, from the stance ankle, heading frame [m]."""
        self.phase_rate = 1.0 / config.gait.period
        """dφ/dt [1/s]."""
        self.ankle: list[float] = [0.0, 0.0, 0.0]
        """Stance ankle in the world [m]."""
        self.lift_off: Pair = (0.0, 0.0)
        """Where the swing ankle left the ground, from the stance ankle [m]."""
        self.landing: Pair = (0.0, 0.0)
        """Where it will land, from the stance ankle [m]."""

    @property
    def heading(self) -> float:
        """Tracked heading [rad]."""
        return self.heading_ramp.heading

    def update(self, estimate: Estimate, reference: Reference) -> None:
        """Bring the step to the estimate's time."""
        self._advance(estimate, reference)
        gait, state = self.gait, self.state
        corners: list[float] = estimate.foot_force[gait.stance].tolist()
        loaded = gait.config.flat_corner_load * gait.weight
        gait.update_foot_flat(sum(force > loaded for force in corners))
        self._observe()
        for mean, speed in zip(self._mean_speeds, state.velocity, strict=True):
            mean.add(speed)
        sway = -gait.stance_sign * self._width
        start = state.steady_start(self._speed, sway)
        self.balance.update(state, start, gait.phase)
        self.balance.compare(corners, gait, self.frame)
        self._watch_fall(sum(estimate.foot_force[gait.swing].tolist()))
        remaining = self._set_phase_rate(start[1] * state.pendulum.growth)
        if gait.phase < self._config.placement.freeze_phase:
            point = landing_point(
                self._config.placement,
                state,
                self.balance.pressure,
                state.steady_start(self._speed, -sway),
                remaining,
                gait.stance_sign,
            )
            x, to_x = self.trim.value[gait.stance], self.trim.value[gait.swing]
            self._goal = (point[0] + x - to_x, point[1])
            beside = self.landing_trim.value[gait.swing]
            self.landing = self.frame.to_world((self._goal[0], self._goal[1] - beside))

    def swing_yaw(self) -> float:
        """Heading of the swing foot: it turns into the torso's during the swing [rad]."""
        share = min(self.gait.phase / self._config.swing.landing_phase, 1.0)
        return self._lift_off_yaw + share * (self.heading - self._lift_off_yaw)

    def base_velocity(self, estimate: Estimate) -> tuple[float, float, float]:
        """With which the torso moves over the stance foot, world axes [m/s]."""
        u, v, w = estimate.base_linear_velocity.tolist()
        return u, v, w

    def _observe(self) -> None:
        """Where the stance ankle is, and how the body moves about it."""
        stance = self.gait.stance
        self.ankle = self._model.ankles[stance].tolist()
        self.state.observe(self.ankle, self.frame, self._offset(stance))

    def _advance(self, estimate: Estimate, reference: Reference) -> None:
        """Gait and commands one tick on."""
        gait, dt = self.gait, self._dt
        self._speed = self._command.update(dt, reference.speed, reference.lateral)
        width = reference.step_width
        self._width = self._config.placement.step_width if math.isnan(width) else width
        load = sum(estimate.foot_force[gait.swing].tolist())
        stance = gait.stance
        phase = gait.phase
        ended = gait.advance(dt, load, self.phase_rate * gait.config.period)
        if ended:
            foot, error = gait.stance, self._ahead(gait.stance)[1] - self._goal[1]
            self.landing_trim.land(foot, error, phase)
            self.trim.end_step(stance, dt)
            self.sole_trim.end_step(stance)
            self.height_trim.land(
                gait.stance, self._model.corner_positions, estimate.foot_force.tolist()
            )
            self._end_step()
        if ended or not self._begun:
            self._begin_step()
        self.frame.set(self.heading_ramp.update(dt, gait, reference.heading))

    def _offset(self, stance: int) -> Pair:
        """What the place of the com is corrected by on this stance foot [m]."""
        ahead = self._config.balance.ahead
        x = self._alterations[0].value - self.trim.value[stance] - ahead
        return x, self._alterations[1].value

    def _ahead(self, foot: int) -> Pair:
        """Ankle of a foot from that of the other one, heading frame [m]."""
        ankles = self._model.ankles
        x, y, _ = (ankles[foot] - ankles[1 - foot]).tolist()
        return self.frame.to_heading((x, y))

    def _watch_fall(self, swing_load: float) -> None:
        """Let the trim learn while one foot alone carries the body."""
        state, cop, trim = self.state, self.balance.measured, self.trim
        settled = self.gait.time_in_step > trim.config.settle_time
        if cop is None or not settled or swing_load > UNLOADED * self.gait.weight:
            return
        p = self.balance.pressure
        self.sole_trim.add((cop[0] - p[0], cop[1] - p[1]))
        place = state.seen[0] - self._config.balance.ahead
        trim.add(place, state.velocity[0], cop[0], state.pendulum.omega)

    def _end_step(self) -> None:
        """Adapt to the mean speeds: sagittal over the step, lateral over every stride."""
        self._alterations[0].end_step(self._mean_speeds[0].finish(), self._speed[0])
        if self.gait.stance == 0:
            self._alterations[1].end_step(self._mean_speeds[1].finish(), self._speed[1])

    def _begin_step(self) -> None:
        """Remember where the swing foot leaves."""
        self._begun = True
        model, gait = self._model, self.gait
        x, y, _ = (model.ankles[gait.swing] - model.ankles[gait.stance]).tolist()
        self.lift_off = self.landing = (x, y)
        self._lift_off_yaw = heading_of(model.feet[gait.swing])

    def _set_phase_rate(self, goal: float) -> float:
        """Let the phase end when the lateral capture point is at `goal` [m].

        Returns the remaining time of the step [s].
        """
        gait, state = self.gait, self.state
        period = gait.config.period
        left = 1.0 - gait.phase
        if left <= 0.0:
            self.phase_rate = 1.0 / period
            return 0.0
        nominal = left * period
        capture = state.capture[1]
        time = remaining_time(
            self._config.timing,
            state.pendulum,
            capture,
            self.balance.pressure[1],
            goal,
            gait.stance_sign * capture,
            gait.time_in_step,
            nominal,
        )
        time = max(time, nominal / MAX_SPEEDUP, min(self._travel_time(), nominal))
        self.phase_rate = left / time
        return time

    def _travel_time(self) -> float:
        """What the swing foot needs to its landing point, sagittal [s].

        A sideways fall may ask for a step so short that the leg does not get there: the foot
        lands behind its goal, the body is too fast on it, and the next step too long.
        """
        goal, _ = self.frame.to_heading(self.landing)
        return abs(goal - self._ahead(self.gait.swing)[0]) / self._config.timing.swing_speed
