"""The path of a jump: where the centre of mass must go, how fast it must leave, with what force.

Seed 004_2880d7939e94ed85, section 3.1, which gives no push: its depth is ours. Gravity is 9.81
m/s² where the seed has 10, and any other that the target says.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hil.errors import InputError
from hil.interface import GRAVITY, Floats


@dataclass(frozen=True, slots=True)
class JumpTarget:
    """Where the feet shall land, and how: world axes, x forward, y left, z up.

    A flight of t seconds that rises at first and falls at its end needs t > √(2|z|/g).
    Raises InputError for a jump that is none, naming the option.
    """

    displacement: tuple[float, float, float]
    """Of the centre of the feet from start to landing [m]; z is the height of the surface."""
    airtime: float
    """From the last contact to the first [s]."""
    push_depth: float
    """How far the centre of mass rises while the feet push [m]."""
    gravity: float = GRAVITY
    """[m/s²]"""

    def __post_init__(self) -> None:
        values = (*self.displacement, self.airtime, self.push_depth, self.gravity)
        if not all(map(math.isfinite, values)):
            raise InputError(f"jump target: every number must be finite, got {self}")
        for name in ("airtime", "push_depth", "gravity"):
            if getattr(self, name) <= 0.0:
                option = name.replace("_", "-")
                raise InputError(f"--{option}: must be above 0 (got {getattr(self, name)})")
        least = math.sqrt(2.0 * abs(self.displacement[2]) / self.gravity)
        if self.airtime <= least:
            what = "up" if self.displacement[2] > 0.0 else "down"
            raise InputError(
                f"--airtime: {abs(self.displacement[2]):.3g} m {what} take more than "
                f"{least:.3f} s (got {self.airtime:.3g} s)"
            )


@dataclass(frozen=True, slots=True)
class JumpPath:
    """The centre of mass from the begin of the push to the touch-down; time 0 begins the push.

    Push, of duration T, from rest or from a walk: x(t) = x₀ + v₀·t + ½·a·t², a constant.
    Flight: x(T + t) = x(T) + v·t − ½·g·t²·ẑ, v = (Δx + ½·g·t²·ẑ)/t over the airtime t.
    All vectors of shape (3,).
    """

    start: Floats
    """Centre of mass when the push begins [m]."""
    initial_velocity: Floats
    """[m/s]"""
    take_off_velocity: Floats
    """[m/s]"""
    push_time: float
    """[s]"""
    airtime: float
    """[s]"""
    mass: float
    """[kg]"""
    gravity: float
    """[m/s²]"""

    @property
    def acceleration(self) -> Floats:
        """Of the push, (v − v₀)/T [m/s²]."""
        change: Floats = (self.take_off_velocity - self.initial_velocity) / self.push_time
        return change

    @property
    def force(self) -> Floats:
        """What the ground must push with, m·(a − g⃗) [N]."""
        wanted: Floats = self.mass * (self.acceleration + self.lift)
        return wanted

    @property
    def lift(self) -> Floats:
        """Acceleration that gravity takes away, −g⃗ [m/s²]."""
        return np.array((0.0, 0.0, self.gravity))

    @property
    def duration(self) -> float:
        """Push and flight together [s]."""
        return self.push_time + self.airtime

    @property
    def take_off(self) -> Floats:
        """Centre of mass at take-off [m]."""
        return self.position(self.push_time)

    @property
    def landing(self) -> Floats:
        """Centre of mass at touch-down [m]."""
        return self.position(self.duration)

    @property
    def apex_time(self) -> float:
        """When the centre of mass is highest, from the begin of the push [s]."""
        return self.push_time + float(self.take_off_velocity[2]) / self.gravity

    @property
    def apex(self) -> Floats:
        """Highest centre of mass [m]."""
        return self.position(self.apex_time)

    def position(self, time: float | Floats) -> Floats:
        """Centre of mass at a time [m], shape (3,), or (k, 3) for k times [s]."""
        push, flight = self._parts(time)
        pushed = self.initial_velocity * push + 0.5 * self.acceleration * push**2
        place: Floats = self.start + pushed + self.take_off_velocity * flight
        return place - 0.5 * self.lift * flight**2

    def velocity(self, time: float | Floats) -> Floats:
        """Velocity at a time [m/s], shape (3,), or (k, 3) for k times [s]."""
        push, flight = self._parts(time)
        speed: Floats = self.initial_velocity + self.acceleration * push - self.lift * flight
        return speed

    def _parts(self, time: float | Floats) -> tuple[Floats, Floats]:
        """How much of a time is push, and how much flight [s], broadcast against (3,)."""
        times = np.asarray(time, dtype=np.float64)[..., None]
        return np.minimum(times, self.push_time), np.maximum(times - self.push_time, 0.0)


def estimate_path(
    target: JumpTarget,
    mass: float,
    *,
    start: Sequence[float] | Floats = (0.0, 0.0, 0.0),
    initial_velocity: Sequence[float] | Floats = (0.0, 0.0, 0.0),
    posture_shift: Sequence[float] | Floats = (0.0, 0.0, 0.0),
) -> JumpPath:
    """The path that reaches a target: v = (Δx − ½·g⃗·t²)/t, pushed over T = 2·s/(v_z + v₀_z).

    `mass` [kg] only scales the force. `posture_shift` [m] is how much farther than the feet the
    centre of mass flies: its place over the feet at touch-down less that at take-off; 0 for the
    seed's rigid body. Raises InputError where the push cannot rise.
    """
    flight = np.asarray(target.displacement) + np.asarray(posture_shift, dtype=np.float64)
    lift = np.array((0.0, 0.0, target.gravity))
    velocity = flight / target.airtime + 0.5 * lift * target.airtime
    begin = np.asarray(initial_velocity, dtype=np.float64)
    rise = float(velocity[2] + begin[2])
    if velocity[2] <= 0.0 or rise <= 0.0:
        raise InputError(
            f"--airtime: at {target.airtime:.3g} s the push would not rise "
            f"(take-off at {velocity[2]:.3f} m/s, begin at {begin[2]:.3f} m/s)"
        )
    return JumpPath(
        start=np.array(start, dtype=np.float64),
        initial_velocity=begin,
        take_off_velocity=velocity,
        push_time=2.0 * target.push_depth / rise,
        airtime=target.airtime,
        mass=mass,
        gravity=target.gravity,
    )
