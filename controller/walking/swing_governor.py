"""Keeps the pitch joints of the swing leg within what their servos can do."""

from collections.abc import Sequence

from pydantic import Field, PositiveFloat

from hil.interface import Floats
from hil.validation import Config

HIP_PITCH, KNEE, ANKLE_PITCH = 2, 3, 4
"""Places in a leg's joint order."""


class GovernorConfig(Config):
    """How targets are followed, and with which share of a servo's torque."""

    share: float = Field(gt=0, le=1)
    """Share of the stall torque that a target's acceleration and speed may take."""
    time: PositiveFloat
    """Time constant with which the governed target follows the wanted one [s]."""
    level: float = Field(ge=0, le=1)
    """Share of what hip and knee lag that the ankle takes up to keep the foot level."""


class SwingGovernor:
    """Targets (q, v) that follow the wanted (q*, v*, a*) with the torque there is.

        a = a* + 2(v* − v)/τ + (q* − q)/τ²,   clipped to   |I·a + k_d·v| ≤ s·τ₀

    I is the inertia at the joint, k_d the motor's own damping, τ₀ its stall torque: a wanted motion
    beyond that would saturate the servo, which then lags in its own way, and the foot drags its
    toe. Starting from the measured joint at lift-off there is no jump. What hip and knee lag goes,
    by its share `level`, to the ankle, so that the foot stays nearly level on its way; a share of 1
    asks the ankle for more than it can do at high speeds, and the heel lands early.
    """

    def __init__(
        self,
        config: GovernorConfig,
        inertia: Sequence[float],
        damping: Sequence[float],
        stall: Sequence[float],
    ) -> None:
        """Inertia [kg·m²], damping [N·m·s/rad] and stall torque [N·m] of a leg's six joints."""
        self._config = config
        self._limits = [
            (i, d, config.share * s) for i, d, s in zip(inertia, damping, stall, strict=True)
        ]
        self._more = dict.fromkeys((HIP_PITCH, KNEE, ANKLE_PITCH), 0.0)
        self._state: dict[int, tuple[float, float]] = {}

    def begin(self, position: Floats, velocity: Floats, lead: float, more_inertia: Floats) -> None:
        """A leg lifts off: measured joints, (6,) [rad], [rad/s]; targets are `lead` s ahead.

        `more_inertia` of this leg's pitch joints is added to the model's, (3,) [kg·m²].
        """
        self._more = dict(zip((HIP_PITCH, KNEE, ANKLE_PITCH), more_inertia.tolist(), strict=True))
        angles, speeds = position.tolist(), velocity.tolist()
        self._state = {
            joint: (angles[joint] + lead * speeds[joint], speeds[joint])
            for joint in (HIP_PITCH, KNEE, ANKLE_PITCH)
        }

    def update(self, dt: float, position: Floats, velocity: Floats, acceleration: Floats) -> None:
        """Replace wanted targets of the leg, (6,) each, by governed ones, one tick later."""
        lag_q = lag_v = lag_a = 0.0
        for joint in (HIP_PITCH, KNEE):
            wanted = float(position[joint]), float(velocity[joint]), float(acceleration[joint])
            q, v, a = self._follow(joint, dt, *wanted)
            lag_q, lag_v, lag_a = (
                lag_q + wanted[0] - q,
                lag_v + wanted[1] - v,
                lag_a + wanted[2] - a,
            )
            position[joint], velocity[joint], acceleration[joint] = q, v, a
        share = self._config.level
        q, v, a = self._follow(
            ANKLE_PITCH,
            dt,
            float(position[ANKLE_PITCH]) + share * lag_q,
            float(velocity[ANKLE_PITCH]) + share * lag_v,
            float(acceleration[ANKLE_PITCH]) + share * lag_a,
        )
        position[ANKLE_PITCH], velocity[ANKLE_PITCH], acceleration[ANKLE_PITCH] = q, v, a

    def _follow(
        self, joint: int, dt: float, angle: float, speed: float, acceleration: float
    ) -> tuple[float, float, float]:
        """One joint's governed angle, speed and acceleration, one tick later."""
        q, v = self._state[joint]
        inertia, damping, torque = self._limits[joint]
        inertia += self._more[joint]
        time = self._config.time
        a = acceleration + 2.0 * (speed - v) / time + (angle - q) / (time * time)
        a = max((-torque - damping * v) / inertia, min(a, (torque - damping * v) / inertia))
        following = v + a * dt
        q += 0.5 * (v + following) * dt
        self._state[joint] = (q, following)
        return q, following, a
