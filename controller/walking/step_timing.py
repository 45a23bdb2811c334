"""Step-time adaptation: the phase runs so that touch-down meets the lateral motion."""

from controller.walking.pendulum import Pendulum
from controller.walking.servo_config import TimingConfig


def remaining_time(
    config: TimingConfig,
    pendulum: Pendulum,
    capture_point: float,
    pressure: float,
    goal: float,
    outside: float,
    elapsed: float,
    nominal: float,
) -> float:
    """Time until touch-down [s].

    The lateral capture point should be at `goal` then, so t* = ln((ξ_goal − p)/(ξ − p))/ω. The
    difference to `nominal`, the time that the phase leaves, counts beyond a dead band, times a
    gain, and the whole step stays within its limits. `outside` is how far ξ is beyond the ankle on
    the side away from the swing foot [m]: beyond the configured distance only landing at once
    helps. `elapsed` is the time since the step began [s].
    """
    shortest = config.min_time - elapsed
    if outside > config.outside:
        return shortest
    wanted = pendulum.time_to(capture_point, pressure, goal)
    if wanted is None:
        return nominal
    error = wanted - nominal
    if abs(error) <= config.dead_band:
        return nominal
    error -= config.dead_band if error > 0.0 else -config.dead_band
    longest = config.max_stretch * pendulum.period - elapsed
    return max(min(nominal + config.gain * error, longest), shortest)
