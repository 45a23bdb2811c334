"""The `walking` section of a new robot: minibiped's, scaled, and fitted to its own soles."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from hil.new_robot.posture import PosedLeg, Posture
from hil.new_robot.similar import Scale, pattern
from hil.new_robot.soles import Sole

Dimension = Callable[[Scale], float]


def _length(scale: Scale) -> float:
    return scale.length


def _time(scale: Scale) -> float:
    return scale.time


def _speed(scale: Scale) -> float:
    return scale.speed


DIMENSIONS: dict[str, Dimension] = {
    "gait.period": _time,
    "heading.ramp_time": _time,
    "placement.max_length": _length,
    "placement.max_width": _length,
    "swing.height": _length,
    "swing.search_speed": _speed,
    "governor.time": _time,
    "learned_load.inertia_bound": lambda scale: scale.inertia,
    "learned_load.friction_bound": lambda scale: scale.torque,
    "balance.settle_time": _time,
    "balance.load_transfer_time": _time,
    "timing.dead_band": _time,
    "timing.min_time": _time,
    "timing.outside": _length,
    "timing.swing_speed": _speed,
    "alteration.gain": _time,
    "alteration.error_limit": _speed,
    "alteration.bounds": _length,
    "lateral_alteration.gain": _time,
    "lateral_alteration.error_limit": _speed,
    "lateral_alteration.bounds": _length,
    "place_trim.error_limit": _length,
    "place_trim.bound": _length,
    "place_trim.settle_time": _time,
    "landing_trim.error_limit": _length,
    "landing_trim.bound": _length,
    "sole_trim.gain": lambda scale: 1.0 / scale.length,
    "height_trim.bound": _length,
    "weight_shift.time": _time,
}
"""How each number of the section scales. What is not named is a pure number, or belongs to wires
and filters (`latency`, `place_trim.delay`), or to the robot's own shape (`fitted`)."""

STEP_OVER_HIPS = 0.100 / 0.090
"""Step width over hip spacing, minibiped's."""
CLEARANCE = 1.08
"""Least step width over the one at which the soles touch, minibiped's."""
ROOM = 1.1
"""Step width over the least one, where wide soles ask for more than the hips."""
SHIFT = 0.36
"""First shift of the torso over the step width, minibiped's."""
CROUCH = 0.2 / 0.22
"""Hip above ankle in the walk, as a share of the straight leg, minibiped's."""
AHEAD = 0.5
"""Balanced centre of pressure between ankle and middle of the sole, minibiped's share."""


@dataclass(frozen=True, slots=True)
class Fitted:
    """Lengths that follow from the robot's own legs and soles [m]."""

    ankle_height: float
    hip_height: float
    hip_spacing: float
    step_width: float
    min_width: float
    ahead: float


def fitted(posture: Posture, soles: tuple[Sole, Sole]) -> Fitted:
    """The lengths of the walk that no scaling gives."""
    leg, sole = posture.legs[0], soles[0]
    ankle = leg.anchors["ankle_roll"]
    height = float(ankle[2] - sole.centre[2] + sole.half[2])
    hips = float(leg.anchors["hip_pitch"][1] - posture.legs[1].anchors["hip_pitch"][1])
    inner = float(ankle[1] - sole.centre[1] + sole.half[1])
    least = CLEARANCE * 2.0 * inner
    return Fitted(
        ankle_height=height,
        hip_height=height + CROUCH * leg.length,
        hip_spacing=hips,
        step_width=max(STEP_OVER_HIPS * hips, ROOM * least),
        min_width=least,
        ahead=AHEAD * float(sole.centre[0] - ankle[0]),
    )


def walking_section(scale: Scale, fit: Fitted) -> dict[str, Any]:
    """Everything under `walking`."""
    section = {
        key: {name: _scaled(f"{key}.{name}", value, scale) for name, value in entry.items()}
        if isinstance(entry, dict)
        else entry
        for key, entry in pattern().walking.items()
    }
    section["hip_height"] = _round(fit.hip_height)
    placement = section["placement"]
    placement["step_width"] = _round(fit.step_width)
    placement["min_width"] = _round(fit.min_width)
    placement["max_width"] = max(placement["max_width"], _round(2.0 * fit.step_width))
    section["balance"]["ahead"] = _round(fit.ahead)
    section["weight_shift"]["distance"] = _round(SHIFT * fit.step_width)
    return section


def crouch(leg: PosedLeg) -> dict[str, float]:
    """Pitch angles with the hip above the ankle at the height of the walk [rad], by role."""
    a, b, reach = leg.thigh, leg.shank, CROUCH * leg.length
    knee = math.acos((reach * reach - a * a - b * b) / (2.0 * a * b))
    ankle = -math.atan2(a * math.sin(knee), b + a * math.cos(knee))
    return {"hip_pitch": -(knee + ankle), "knee": knee, "ankle_pitch": ankle}


def _scaled(key: str, value: Any, scale: Scale) -> Any:
    dimension = DIMENSIONS.get(key)
    if dimension is None:
        return value
    factor = dimension(scale)
    if isinstance(value, list):
        return [_round(factor * part) for part in value]
    return _round(factor * value)


def _round(value: float) -> float:
    """Three significant digits: no file has more to say."""
    return float(f"{value:.3g}")
