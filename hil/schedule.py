"""What the operator asks for over time, from the command line's texts: speeds, turns, water.

T = 0 is the first walking tick. Values are linear between their points and constant after the
last one; a schedule that says nothing of T = 0 starts there from the robot's default.
"""

import math
import re
from collections.abc import Sequence

import numpy as np
from pydantic import Field, NonNegativeFloat, PositiveFloat

from hil.errors import InputError
from hil.interface import Floats, Reference
from hil.validation import Config

Point = tuple[NonNegativeFloat, float]
"""Time [s] and value."""
LevelPoint = tuple[NonNegativeFloat, NonNegativeFloat]
FactorPoint = tuple[NonNegativeFloat, PositiveFloat]
Medium = tuple[float, float, float]
"""Level above the floor [m], density [kg/m³] and viscosity factor of a liquid."""

ROUNDING_S = 1e-9
"""A tick at the end of a push is after it, however the sum of two times was rounded."""

TURN_RATE = math.radians(30.0)
"""How fast a steered heading moves [rad/s]; a controller spreads it over its steps."""

NUMBER = r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"


class Push(Config):
    """A constant world-frame force at the root body's centre of mass."""

    force: tuple[float, float, float]
    """[N]"""
    start: NonNegativeFloat
    """[s]"""
    duration: PositiveFloat
    """[s]"""


class Ball(Config):
    """A ball thrown at the trunk."""

    mass: PositiveFloat
    """[kg]"""
    velocity: tuple[float, float, float]
    """Of the impact, world axes [m/s]."""
    start: NonNegativeFloat
    """When it is thrown [s]; it hits about 0.1 s later."""


class Schedules(Config):
    """Everything that changes during a run, as it was asked for."""

    speed: tuple[Point, ...] = ()
    """Sagittal speed [m/s]."""
    lateral: tuple[Point, ...] = ()
    """Coronal speed, left positive [m/s]."""
    turns: tuple[Point, ...] = ()
    """Relative turns, left positive [rad]; they add up."""
    step_width: float | None = Field(default=None, gt=0)
    """Lateral distance between the feet [m]; none for the robot's own."""
    pushes: tuple[Push, ...] = ()
    balls: tuple[Ball, ...] = ()
    water: tuple[LevelPoint, ...] = ()
    """Level of the liquid above the floor [m]; none is dry land."""
    density: tuple[FactorPoint, ...] = ()
    """[kg/m³]"""
    viscosity: tuple[FactorPoint, ...] = ()
    """Factor on the drag, 1 for water."""


class Operator:
    """The schedules of one run, evaluated tick by tick without allocation."""

    def __init__(self, schedules: Schedules, default_speed: float) -> None:
        self._speed = _anchored(schedules.speed, default_speed)
        self._lateral = _anchored(schedules.lateral, 0.0)
        self._turns = sorted(schedules.turns)
        self._bearing: list[Point] = []
        self._pushes = list(schedules.pushes)
        self._balls = sorted(schedules.balls, key=lambda ball: ball.start)
        dry = Reference()
        self._liquid = tuple(
            _anchored(points, default)
            for points, default in (
                (schedules.water, dry.water_level),
                (schedules.density, dry.liquid_density),
                (schedules.viscosity, dry.liquid_viscosity),
            )
        )
        self._wet = bool(schedules.water)
        width = schedules.step_width
        self._reference = Reference(step_width=math.nan if width is None else width)
        self._force = np.zeros(3)

    def reference(self, time_s: float) -> Reference:
        """What is asked for at a time. The returned object is reused by the next call."""
        reference = self._reference
        reference.speed = _interpolate(self._speed, time_s)
        reference.lateral = _interpolate(self._lateral, time_s)
        reference.heading = sum(angle for start, angle in self._turns if start <= time_s)
        if self._bearing:
            reference.heading = _interpolate(self._bearing, time_s)
        if self._wet:
            medium = self.medium(time_s)
            reference.water_level, reference.liquid_density, reference.liquid_viscosity = medium
        return reference

    def steer(self, axis: str, value: float, time_s: float) -> None:
        """Ask for a `speed` or `lateral` speed [m/s] or a `heading` [rad] from a time on.

        What was scheduled for that axis is given up. A heading is reached at `TURN_RATE`; how fast
        a speed may change is the controller's concern.
        """
        if axis == "heading":
            present = self.reference(time_s).heading
            way_s = abs(value - present) / TURN_RATE
            self._bearing = [(time_s, present), (time_s + way_s + ROUNDING_S, value)]
        elif axis == "speed":
            self._speed = [(time_s, value)]
        else:
            self._lateral = [(time_s, value)]

    @property
    def pushes(self) -> bool:
        """Whether there is, or was, any push."""
        return bool(self._pushes)

    def push_now(self, push: Push) -> None:
        """Add a push."""
        self._pushes.append(push)

    def medium(self, time_s: float) -> Medium:
        """The liquid at a time."""
        level, density, viscosity = self._liquid
        return (
            _interpolate(level, time_s),
            _interpolate(density, time_s),
            _interpolate(viscosity, time_s),
        )

    def push(self, time_s: float) -> Floats:
        """Sum of the pushes that act at a time [N]. The array is reused by the next call."""
        self._force[:] = 0.0
        for push in self._pushes:
            if -ROUNDING_S <= time_s - push.start < push.duration - ROUNDING_S:
                self._force += push.force
        return self._force

    def ball(self, time_s: float) -> Ball | None:
        """The next ball whose time has come; each is given once."""
        if self._balls and self._balls[0].start <= time_s + ROUNDING_S:
            return self._balls.pop(0)
        return None


def parse_point(option: str, text: str) -> Point:
    """`V` or `V@T`. Raises InputError naming the option and the form."""
    return _point(option, text, "V[@T]", required_time=False)


def parse_turn(option: str, text: str) -> Point:
    """`DEG@T`, into radians. Raises InputError."""
    time_s, degrees = _point(option, text, "DEG@T", required_time=True)
    return time_s, math.radians(degrees)


def parse_push(option: str, text: str) -> Push:
    """`FX,FY,FZ@T+DT`. Raises InputError."""
    form = "FX,FY,FZ@T+DT (newtons, seconds)"
    pattern = rf"{NUMBER},{NUMBER},{NUMBER}@{NUMBER}\+{NUMBER}"
    fx, fy, fz, start, duration = _numbers(option, text, pattern, form)
    if start < 0 or duration <= 0:
        raise InputError(f"{option}: {text!r}: T must not be negative and DT must be above 0")
    return Push(force=(fx, fy, fz), start=start, duration=duration)


def parse_ball(option: str, text: str) -> Ball:
    """`KG,VX,VY,VZ@T`. Raises InputError."""
    form = "KG,VX,VY,VZ@T (kilograms, metres a second, seconds)"
    pattern = rf"{NUMBER},{NUMBER},{NUMBER},{NUMBER}@{NUMBER}"
    mass, vx, vy, vz, start = _numbers(option, text, pattern, form)
    if mass <= 0 or start < 0 or not (vx or vy or vz):
        raise InputError(
            f"{option}: {text!r}: KG must be above 0, T not negative and the velocity not zero"
        )
    return Ball(mass=mass, velocity=(vx, vy, vz), start=start)


def _point(option: str, text: str, form: str, *, required_time: bool) -> Point:
    pattern = NUMBER + (rf"@{NUMBER}" if required_time else rf"(?:@{NUMBER})?")
    value, time_s = _numbers(option, text, pattern, form)
    if time_s < 0:
        raise InputError(f"{option}: {text!r}: T must not be negative (form: {form})")
    return time_s, value


def _numbers(option: str, text: str, pattern: str, form: str) -> list[float]:
    match = re.fullmatch(pattern, text.strip())
    values = [] if match is None else [float(group or 0.0) for group in match.groups()]
    if match is None or not all(map(math.isfinite, values)):
        raise InputError(f"{option}: {text!r} is not of the form {form}, with finite numbers")
    return values


def _anchored(points: Sequence[Point], default: float) -> list[Point]:
    ordered = sorted(points, key=lambda point: point[0])
    if not ordered or ordered[0][0] > 0:
        ordered.insert(0, (0.0, default))
    return ordered


def _interpolate(points: list[Point], time_s: float) -> float:
    after = next((i for i, point in enumerate(points) if point[0] > time_s), len(points))
    if after in (0, len(points)):  # start-up, which is before the first point, or the end
        return points[max(after - 1, 0)][1]
    (t0, v0), (t1, v1) = points[after - 1], points[after]
    return v0 + (v1 - v0) * (time_s - t0) / (t1 - t0)
