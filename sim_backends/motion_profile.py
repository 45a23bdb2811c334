"""Motion profile of a servo: the trajectory between one goal and the next."""

import math

from hil.servo import COUNTS_PER_TURN

VELOCITY_UNIT = 0.229 / 60 * COUNTS_PER_TURN
"""[counts/s] of one Profile Velocity unit, 0.229 rev/min (X-series e-manual)."""
ACCELERATION_UNIT = 214.577 / 3600 * COUNTS_PER_TURN
"""[counts/s²] of one Profile Acceleration unit, 214.577 rev/min² (X-series e-manual)."""


class MotionProfile:
    """Position trajectory of one servo: step, rectangle, trapezoid or triangle of velocity.

    Velocity-based: at most v = Profile Velocity and a = Profile Acceleration; 0 is no bound, and
    no bound on velocity is a step. Time-based (drive mode bit 2): Profile Velocity is the whole
    time T, Profile Acceleration the time T_a ≤ T/2 of speeding up, in ms; a goal at distance D
    then has v = D/(T − T_a), a = v/T_a (X-series e-manual, Profile Acceleration, Profile
    Velocity). A new goal is approached from the trajectory's own position and velocity. In
    every substep the velocity goes, by a·dt at most, towards the largest from which the
    trajectory still stops at the goal.
    """

    def __init__(self, timestep: float) -> None:
        self._dt = timestep
        self._registers = (0, 0, False)
        self._most_velocity, self._acceleration = math.inf, math.inf
        self.position = 0.0
        """[counts]"""
        self.velocity = 0.0
        """[counts/s]"""
        self.goal = 0.0
        """[counts]"""

    @property
    def steps(self) -> bool:
        """No profile: the trajectory is the goal."""
        return self._registers[0] == 0

    def configure(self, velocity: int, acceleration: int, time_based: bool) -> None:
        """Registers Profile Velocity and Profile Acceleration, and what they mean."""
        self._registers = (velocity, acceleration, time_based)
        self._plan()

    def restart(self, position: float) -> None:
        """Be at rest at a position [counts], which is the goal too."""
        self.position = self.goal = position
        self.velocity = 0.0

    def aim(self, goal: float) -> None:
        """Go to a goal [counts] from here."""
        self.goal = goal
        self._plan()

    def _plan(self) -> None:
        velocity, acceleration, time_based = self._registers
        if time_based and velocity:
            ramp = min(acceleration, velocity / 2)
            most = abs(self.goal - self.position) / (1e-3 * (velocity - ramp))
            self._most_velocity = most or math.inf
            self._acceleration = self._most_velocity / (1e-3 * ramp) if ramp else math.inf
        else:
            self._most_velocity = velocity * VELOCITY_UNIT or math.inf
            self._acceleration = acceleration * ACCELERATION_UNIT or math.inf

    def advance(self) -> float:
        """One substep; the acceleration of the trajectory in it [counts/s²]."""
        if self.steps:
            self.position, self.velocity = self.goal, 0.0
            return 0.0
        dt, before = self._dt, self.velocity
        gap = self.goal - self.position
        most = min(self._most_velocity, abs(gap) / dt)
        change = self._acceleration * dt
        if change < math.inf:
            # v²/(2a) + v·dt/2 = gap: what a velocity that falls in steps of a·dt still travels.
            braking = math.sqrt(0.25 * change * change + 2 * self._acceleration * abs(gap))
            most = min(most, braking - 0.5 * change)
        wanted = math.copysign(most, gap)
        self.velocity = min(max(wanted, before - change), before + change)
        self.position += self.velocity * dt
        if abs(self.goal - self.position) < 0.5 and abs(self.velocity) <= change:
            self.position, self.velocity = self.goal, 0.0
        return (self.velocity - before) / dt

    def advance_velocity(self, goal: float) -> None:
        """One substep of a velocity trajectory towards a goal [counts/s]."""
        change = self._registers[1] * ACCELERATION_UNIT * self._dt or math.inf
        self.velocity = min(max(goal, self.velocity - change), self.velocity + change)
