"""Where the swing foot lands: the inverted pendulum's state predicted to touch-down."""

from controller.walking.bounds import clip
from controller.walking.heading_frame import Pair
from controller.walking.pendulum_state import PendulumState
from controller.walking.servo_config import PlacementConfig


def landing_point(
    config: PlacementConfig,
    state: PendulumState,
    pressure: Pair,
    next_start: Pair,
    remaining: float,
    stance_sign: int,
) -> Pair:
    """Landing point of the ankle from the stance ankle, heading frame [m].

    k·ξ_T − b: ξ_T is the capture point predicted at touch-down, `remaining` seconds (and the
    delay with which contact is felt) from now, with the present p; b = `next_start` is where
    the steady walk begins its next step. `stance_sign` is +1 on the left foot. Clamped to the
    legs' reach and to feet that do not touch.
    """
    pendulum = state.pendulum
    time = remaining + config.touch_down_delay
    x = config.gain_x * pendulum.predict(state.capture[0], pressure[0], time) - next_start[0]
    y = config.gain_y * pendulum.predict(state.capture[1], pressure[1], time) - next_start[1]
    width = min(max(-stance_sign * y, config.min_width), config.max_width)
    return clip(x, config.max_length), -stance_sign * width
