"""Likely causes of a difference between two runs: what was measured in both, side by side."""

from dataclasses import dataclass

import numpy as np

from hil.after.signs import Signs
from hil.after.zero_cause import AXES, LegZero, leg_zero, sole_leans
from hil.interface import SIDES, Floats

SURE = 3.0
"""A difference counts from so many standard deviations on."""
COMMON_SHARE = 0.75
"""Joints that must differ alike for a cause to be the whole robot's."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """What is compared joint by joint."""

    cause: str
    label: str
    unit: str
    least: float
    """Least difference that counts: what two walks of one robot may differ by."""
    relative: bool = False
    """Compared in percent of the first run's."""
    scale: float = 1.0
    """From SI to the unit."""
    digits: int = 2


QUANTITIES = {
    "delay": Quantity("delay", "goals act", "ms", 1.0, scale=1e3, digits=1),
    "drive": Quantity("gain", "current for a position error", "%", 8.0, relative=True, digits=0),
    "torque_constant": Quantity("gain", "torque constant", "%", 8.0, relative=True, digits=0),
    "friction": Quantity("friction", "dry friction", "N·m", 0.05),
    "inertia": Quantity("inertia", "rotor inertia", "kg·m²", 0.01, digits=3),
}
LEAST_VOLTAGE = 0.3
"""[V]"""
LEAST_LEAN = np.radians(0.5)
"""Of a sole or the IMU [rad]."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One cause that stands out."""

    cause: str
    """delay, gain, friction, inertia, zero, imu or battery."""
    joint: str | None
    """None: the whole robot."""
    difference: float
    """Second run minus first, in `unit`."""
    unit: str
    deviation: float
    score: float
    """Difference over the least that counts, or over three deviations if that is more."""
    evidence: str
    """A sentence with its number."""
    candidates: tuple[str, ...] = ()
    """Joints that it may be instead, the likeliest first, where they cannot be told apart."""


def find_causes(first: Signs, second: Signs) -> list[Finding]:
    """What stands out, the largest score first; nothing if nothing does.

    A difference that at least three joints in four share is the robot's, and is taken off before
    joints are looked at.
    """
    found = _supply(first, second) + _leans(first, second)
    for key, quantity in QUANTITIES.items():
        found += _by_joint(first, second, key, quantity)
    return sorted(found, key=lambda finding: -finding.score)


def sign(signs: Signs, key: str) -> tuple[Floats, Floats]:
    """A quantity of all joints with its deviations, in SI, shape (n,) each."""
    part = signs.motors if hasattr(signs.motors, key) else signs.mechanics
    found: tuple[Floats, Floats] = getattr(part, key)
    return found


def _by_joint(first: Signs, second: Signs, key: str, quantity: Quantity) -> list[Finding]:
    (a, spread_a), (b, spread_b) = sign(first, key), sign(second, key)
    factor = 100.0 / a if quantity.relative else np.full(a.size, quantity.scale)
    change, deviation = (b - a) * factor, np.hypot(spread_a, spread_b) * np.abs(factor)
    known = np.isfinite(change) & np.isfinite(deviation)
    if not known.any():
        return []
    common = float(np.median(change[known]))
    near = np.abs(change - common) < np.maximum(quantity.least, SURE * deviation)
    spread = float(np.median(deviation[known]))
    if abs(common) < quantity.least or near[known].mean() < COMMON_SHARE:
        common = 0.0
    found = []
    if common:
        means = (float(np.median(a[known])), float(np.median(b[known])))
        found.append(_finding(quantity, None, common, spread, means))
    for place in np.flatnonzero(known).tolist():
        own = float(change[place]) - common
        if abs(own) >= max(quantity.least, SURE * float(deviation[place])):
            name = first.run.joints[place]
            values = (float(a[place]), float(b[place]))
            found.append(_finding(quantity, name, own, float(deviation[place]), values))
    return found


def _finding(
    quantity: Quantity,
    joint: str | None,
    difference: float,
    deviation: float,
    values: tuple[float, float],
) -> Finding:
    digits, factor = quantity.digits, 100.0 if quantity.relative else quantity.scale
    unit = quantity.unit
    before, after = (f"{value * factor:.{digits}f}" for value in values)
    of = " of the data sheet's" if quantity.relative else ""
    evidence = f"{quantity.label} {after} {unit}{of}, was {before} {unit}"
    if quantity.cause == "delay":
        way = "later" if difference > 0 else "earlier"
        evidence = f"samples show goals {abs(difference):.{digits}f} {unit} {way}"
    score = abs(difference) / max(quantity.least, SURE * deviation)
    return Finding(quantity.cause, joint, difference, unit, deviation, score, evidence)


def _supply(first: Signs, second: Signs) -> list[Finding]:
    a, b = first.supply, second.supply
    difference = b.voltage - a.voltage
    deviation = float(np.hypot(a.deviation, b.deviation))
    score = abs(difference) / max(LEAST_VOLTAGE, SURE * deviation)
    if score < 1.0:
        return []
    evidence = (
        f"supply {b.voltage:.2f} V at {b.current:.2f} A, was {a.voltage:.2f} V at {a.current:.2f} A"
    )
    return [Finding("battery", None, difference, "V", deviation, score, evidence)]


def _leans(first: Signs, second: Signs) -> list[Finding]:
    """Joint zeros and the IMU, from soles that lie flat."""
    imu, soles, deviation = sole_leans(first, second)
    found = []
    for axis in range(2):
        spread = float(np.nanmax(deviation[:, axis], initial=0.0))
        score = abs(float(imu[axis])) / max(LEAST_LEAN, SURE * spread)
        if score >= 1.0:
            degrees = float(np.degrees(imu[axis]))
            evidence = f"both soles lie flat and seem to {AXES[axis]} by {degrees:+.1f}°: the IMU"
            evidence += ", or the same zero in both legs"
            spread = float(np.degrees(spread))
            found.append(Finding("imu", None, degrees, "°", spread, score, evidence))
        for foot in range(2):
            lean, spread = float(soles[foot, axis]), float(deviation[foot, axis])
            if abs(lean) >= max(LEAST_LEAN, SURE * spread):  # false where it is unknown
                found.append(_zero(first, leg_zero(first, second, foot, axis, lean, spread)))
    return found


def _zero(first: Signs, zero: LegZero) -> Finding:
    degrees, spread = float(np.degrees(zero.lean)), float(np.degrees(zero.deviation))
    names, others = (
        tuple(first.run.joints[joint] for joint in joints)
        for joints in (zero.joints, zero.excluded)
    )
    shown = degrees * zero.sign
    evidence = f"the {SIDES[zero.foot]} sole lies flat and seems to {AXES[zero.axis]} by "
    evidence += f"{degrees:+.1f}°"
    if names:
        evidence += f": {' or '.join(names)} shows {abs(shown):.1f}° too "
        evidence += "much" if shown > 0 else "little"
    if others:
        evidence += f" (the torques speak against {' and '.join(others)})"
    score = abs(zero.lean) / max(LEAST_LEAN, SURE * zero.deviation)
    name = names[0] if names else None
    candidates = names if len(names) > 1 else ()
    return Finding("zero", name, shown, "°", spread, score, evidence, candidates)
