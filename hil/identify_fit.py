"""From the record of one moved joint to the constants of its servo, with uncertainties.

Two linear least squares, one after the other; no search, no starting values. `mujoco.sysid`
fits parameters of a MuJoCo model by shooting; it has no place for a servo's registers (goal
counts, P gain, duty, delay of the wire), which is where the information is.
"""

from dataclasses import dataclass

import numpy as np

from hil.identify_load import JointLoad
from hil.identify_mechanics import fit_divisor, fit_mechanics
from hil.identify_motor import MotorFit, fit_motor
from hil.identify_record import Estimated, JointRecord

DIVISORS = (128.0, 256.0)
"""P gain divisors that are known: the e-manual's, and what experiments on XL330 found."""
MOST_DIVISOR_SHARE = 0.15
"""Deviation of a divisor that decides between the known ones."""
LINK_SHARE = 0.1
"""Of the links' inertia that a model is wrong by, other joints giving way included (assumed)."""
ROTOR_SHARE = 0.03
"""Of the rotor's inertia, and"""
DELAY_SHARE = 0.1
"""of a period, that trapezoids over whole ticks are wrong by (found on virtual servos)."""
VOLTAGE_DEVIATION = 0.03
"""Of the mean of readings in steps of 0.1 V [V]."""
FITTED = (
    "torque_constant", "resistance", "armature", "friction", "viscous", "delay", "backlash"
)  # fmt: skip
"""Constants of a `ServoFit` that have a deviation, but for the divisor's."""


@dataclass(frozen=True, slots=True)
class ServoFit:
    """What a record says of a servo."""

    torque_constant: Estimated
    """[N·m/A]"""
    resistance: Estimated
    """[Ω]"""
    gain_divisor: float
    """One of `DIVISORS`."""
    free_divisor: Estimated
    """What the load's known gravity and inertia make of the divisor, before one is chosen."""
    armature: Estimated
    """[kg·m²]"""
    friction: Estimated
    """[N·m]"""
    viscous: Estimated
    """[N·m·s/rad]"""
    delay: Estimated
    """From a sample to the effect of the goal made of it [s]."""
    backlash: Estimated
    """Full gap [rad]."""
    charge_residual: float
    """Root mean square of the electrical fit [A·s]."""
    torque_residual: float
    """Root mean square of the mechanical fit [N·m]."""

    def as_dict(self) -> dict[str, object]:
        """Values and deviations as a calibration file has them; what is unknown counts as 0."""
        found = {name: getattr(self, name) for name in FITTED}
        return {
            **{name: max(0.0, one.value) for name, one in found.items()},
            "gain_divisor": self.gain_divisor,
            "deviation": {
                name: one.deviation for name, one in found.items() if np.isfinite(one.deviation)
            },
            "residual": self.torque_residual,
        }


def fit_servo(record: JointRecord, load: JointLoad, resistance: float) -> ServoFit:
    """Constants of the servo that made a record.

    `resistance`: the data sheet's [Ω], which chooses the divisor where the load is too light to.

    1. Electrical: i = (V·u − k·ω_r)/R with duty u = P·c·e/(885·D). The rotor's speed ω_r is not
       measured, but its angle is the joint's plus half the gap, on the side to which the torque
       on the links presses. Integrated, ∫i = a·∫V·P·c·e/885 − b·(q ± gap/2), which gives
       a = 1/(D·R), b = k/R and the gap.
    2. Momentum, over windows of a few ticks: J_r·Δω_r + J·Δω + ∫g + f·∫sgn ω_r + c·∫ω_r = k·∫i
       with the links' inertia J and gravity g of the robot's model. A goal that jumps d after a
       sample adds ΔI·(T/2 − d) to the trapezoidal ∫i, which gives the delay.
    """
    motor = fit_motor(record, load)
    free = fit_divisor(record, load, motor, resistance)
    divisor = _choose_divisor(free, motor, resistance)
    r = 1.0 / (motor.a.value * divisor)
    k = motor.b.value * r
    share_v = VOLTAGE_DEVIATION / float(np.median(record.voltage))
    share_r = float(np.hypot(motor.a.share, share_v))
    share_k = float(np.hypot(share_r, motor.b.share))
    values, deviations, residual = fit_mechanics(record, load, motor, k)
    armature, friction, viscous, early = values
    # A wrong k scales every torque; that of back-EMF is what viscous friction is told apart from.
    scaled = np.array([armature, friction, motor.b.value * k])
    deviations[:3] = np.hypot(deviations[:3], share_k * scaled)
    links = float(load.inertia(record.position).mean())
    deviations[0] = np.hypot(deviations[0], np.hypot(LINK_SHARE * links, ROTOR_SHARE * armature))
    deviations[3] = np.hypot(deviations[3], DELAY_SHARE * record.period_s)
    return ServoFit(
        Estimated(k, share_k * k),
        Estimated(r, share_r * r),
        divisor,
        free,
        Estimated(armature, float(deviations[0])),
        Estimated(friction, float(deviations[1])),
        Estimated(viscous, float(deviations[2])),
        Estimated((motor.lag - 0.5) * record.period_s - early, float(deviations[3])),
        motor.gap,
        motor.residual,
        residual,
    )


def _choose_divisor(free: Estimated, motor: MotorFit, resistance: float) -> float:
    """The known divisor nearest to what the load says, else to what the data sheet says."""
    sure = free.deviation < MOST_DIVISOR_SHARE * free.value
    guess = free.value if sure else 1.0 / (motor.a.value * resistance)
    return min(DIVISORS, key=lambda divisor: abs(np.log(divisor / guess)))
