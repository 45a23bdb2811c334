"""Motor constants learnt while walking, from what the servos measure anyway."""

import numpy as np

from hil.interface import Floats, SensorFrame
from hil.servo import COUNTS_PER_RADIAN, PWM_FULL, MotorParameters

BATCH = 75
"""Ticks that are looked at together: the tick itself only keeps its samples."""
FORGETTING_S = 10.0
"""Samples count for so long."""
MEAN = 15
"""Samples that are averaged first: the law is linear, and a rotor that rattles in its backlash
turns, on the mean, as the joint does."""
LEAST_SPEED = 0.8
"""Slower means are left out [rad/s]: there backlash and the grain of the measured velocity
(0.024 rad/s) are no longer small, and make k look too small."""
PRIOR_S, PRIOR_SPEED, PRIOR_CURRENT = 1.0, 1.0, 0.5
"""The data sheet counts as much as so many seconds at such a speed [rad/s] and current [A]."""
BOUNDS = (0.7, 1.35)
"""Learnt constants, as shares of the data sheet's or the calibration's."""
CHANGE = 0.01
"""Constants are handed on once one has changed by this share."""


class LearnedMotors:
    """Torque constant k and winding resistance R of every servo, by least squares.

    The drive puts the duty u = P·e/(D·885) of the supply V on a motor that turns with q̇:

        V·u = R·i + k·q̇

    with the position error e, current and velocity of one answer, and the goal that was written in
    the tick before. Both constants are sought for each joint over the last seconds, starting from
    the data sheet (a prior of so many samples), which spreads by a quarter from servo to servo:
    with k wrong, stiffness, feed-forward torque and velocity lead are wrong by as much. R follows
    the heat of the winding.
    """

    def __init__(self, motors: MotorParameters, rate_hz: int) -> None:
        """`motors` are those that measured torques were made with."""
        n = motors.direction.size
        self._nominal = motors
        self._scale = COUNTS_PER_RADIAN / (motors.gain_divisor * PWM_FULL)
        self._rows = 0
        self._voltage, self._gain, self._error, self._speed, self._torque = np.zeros((5, BATCH, n))
        self._known = np.zeros((BATCH, n), dtype=np.bool_)
        self._forget = 1.0 - BATCH / (FORGETTING_S * rate_hz)
        samples = PRIOR_S * rate_hz / MEAN
        # Sums of q̇², q̇·i, i², q̇·V·u, i·V·u; those of the prior stay apart.
        self._sums = np.zeros((5, n))
        self._prior = samples * np.array([PRIOR_SPEED**2, PRIOR_CURRENT**2])
        self.torque_constant = motors.torque_constant.copy()
        """[N·m/A], shape (n,)."""
        self.resistance = motors.resistance.copy()
        """[Ω], shape (n,)."""

    def take(self, frame: SensorFrame, sent: Floats, p_gain: Floats, voltage: float) -> bool:
        """Keep a tick's samples; whether the constants have changed by more than CHANGE.

        `sent`: goal of the tick before [rad], `p_gain`: its register value, both (n,).
        """
        row = self._rows
        self._error[row] = sent
        self._error[row] -= frame.joint_position
        self._gain[row] = p_gain
        self._speed[row] = frame.joint_velocity
        self._torque[row] = frame.joint_torque
        # A servo without torque shows no current at all, whatever its goal.
        np.not_equal(frame.joint_torque, 0.0, out=self._known[row])
        self._known[row] &= frame.joint_valid
        self._known[row] &= np.isfinite(sent)
        self._voltage[row] = voltage
        self._rows = row + 1
        if self._rows < BATCH:
            return False
        self._rows = 0
        return self._learn()

    def _learn(self) -> bool:
        motors = self._nominal
        error = np.where(self._known, self._error, 0.0)
        duty = np.clip(self._gain * self._scale * error, -1.0, 1.0)
        current = self._torque / motors.torque_constant
        driven, speed, current = (
            samples.reshape(-1, MEAN, duty.shape[1]).mean(axis=1)
            for samples in (self._voltage * duty, self._speed, current)
        )
        known = self._known.reshape(-1, MEAN, duty.shape[1]).all(axis=1)
        known &= np.abs(speed) > LEAST_SPEED
        driven, speed, current = driven * known, speed * known, current * known
        products = (speed**2, speed * current, current**2, speed * driven, current * driven)
        self._sums *= self._forget
        self._sums += [product.sum(axis=0) for product in products]
        a, b, c, d, e = self._sums
        a, c = a + self._prior[0], c + self._prior[1]
        d = d + self._prior[0] * motors.torque_constant
        e = e + self._prior[1] * motors.resistance
        determinant = a * c - b * b
        found = (c * d - b * e) / determinant, (a * e - b * d) / determinant
        changed = False
        for kept, new, nominal in zip(
            (self.torque_constant, self.resistance),
            found,
            (motors.torque_constant, motors.resistance),
            strict=True,
        ):
            new = np.clip(new, BOUNDS[0] * nominal, BOUNDS[1] * nominal)
            if np.abs(new - kept).max() > CHANGE * nominal.min():
                changed = True
                kept[:] = new
        return changed
