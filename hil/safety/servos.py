"""The servos: too hot, starved, in error, or frozen."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats, Ints, JointError
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

WARN_BELOW_K, STOP_BELOW_K = 10.0, 5.0
"""Distances to the servo's own shutdown temperature at which to warn and to stop [K]."""
_OWN_BITS, _VOLTAGE_BIT, _OVERLOAD = 0x7F, 0x01, 0x20
_DISOBEDIENT = (
    (JointError.REBOOTED, "rebooted"),
    (JointError.TORQUE_LOST, "torque lost"),
    (JointError.STOPPED, "stopped by its watchdog"),
)
"""Worst first."""
LOAD_TIME_S = 5.0
"""Time over which the torque is averaged: shorter than a winding needs to get hot (assumed)."""
LOAD_EVERY = 5
"""Ticks between two looks at the torques."""
WARN_SHARE = 0.85
LOOK_EVERY_NS = 20_000_000
"""Temperature and voltage are looked at this often."""


class TemperatureMonitor:
    """Case temperatures against the temperature at which the servo shuts itself down."""

    def __init__(self, description: RobotDescription) -> None:
        self._names = description.joint_names
        self._limit = description.safety.temperature_limit
        self._next_ns = 0

    def look(self, situation: Situation) -> list[Event]:
        """Joints that are hot (WARN), or too hot (SOFT_STOP: sooner than the servo's own end)."""
        if situation.now_ns < self._next_ns:
            return []
        self._next_ns = situation.now_ns + LOOK_EVERY_NS
        hot: Ints = np.flatnonzero(situation.frame.joint_temperature > self._limit - WARN_BELOW_K)
        return [self._event(j, situation.frame.joint_temperature[j]) for j in hot]

    def _event(self, joint: int, temperature: float) -> Event:
        if temperature > self._limit - STOP_BELOW_K:
            return Event(self._names[joint], "too hot", Severity.SOFT_STOP)
        return Event(self._names[joint], "hot", Severity.WARN)


class VoltageMonitor:
    """Supply at the servos below the least that they need, for longer than a step's impact.

    What counts is the mean over the servos: one servo's register is a moment's reading.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._least = description.safety.voltage_min
        self._patience_ns = round(description.safety.voltage_patience * 1e9)
        self._low_since_ns: int | None = None
        self._next_ns = 0
        self._low: list[Event] = []

    def look(self, situation: Situation) -> list[Event]:
        """Nothing, "low voltage" (WARN), or SOFT_STOP once it has lasted."""
        if self._least is None:
            return []
        if situation.now_ns >= self._next_ns:
            self._next_ns = situation.now_ns + LOOK_EVERY_NS
            self._low = self._judge(situation, self._least)
        return self._low

    def _judge(self, situation: Situation, least: float) -> list[Event]:
        voltage: Floats = situation.frame.joint_voltage
        known = voltage[np.isfinite(voltage)]
        if not known.size or known.mean() >= least:
            self._low_since_ns = None
            return []
        if self._low_since_ns is None:
            self._low_since_ns = situation.now_ns
        lasted = situation.now_ns - self._low_since_ns >= self._patience_ns
        severity = Severity.SOFT_STOP if lasted else Severity.WARN
        return [Event("supply", "low voltage", severity)]


class ErrorMonitor:
    """What an actuator says of itself, or what was found out about it.

    A servo that reports an error of its own may have switched its torque off for it; one that
    rebooted, lost its torque or stopped no longer does what it is told, whatever it measures.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._names = description.joint_names
        told = _VOLTAGE_BIT if description.safety.overload_ends_torque else _VOLTAGE_BIT | _OVERLOAD
        self._only_told = told

    def look(self, situation: Situation) -> list[Event]:
        """SOFT_STOP for the rest of the robot; what does not end a torque is only told (WARN)."""
        errors = situation.frame.joint_error
        if not np.count_nonzero(errors):
            return []
        return [self._event(j, int(errors[j])) for j in np.flatnonzero(errors).tolist()]

    def _event(self, joint: int, error: int) -> Event:
        for flag, name in _DISOBEDIENT:
            if error & flag:
                return Event(self._names[joint], name, Severity.SOFT_STOP)
        own = error & _OWN_BITS
        if own == 0:  # an alert whose cause is read in the next ticks
            return Event(self._names[joint], "servo alert", Severity.WARN)
        severity = Severity.SOFT_STOP if own & ~self._only_told else Severity.WARN
        return Event(self._names[joint], f"servo error 0x{own:02x}", severity)


class FrozenMonitor:
    """A servo that answers, but does not move although its goal does.

    Over a window of WINDOW_NS its goal moved by more than GOAL_MOVED while its encoder stayed on
    the same count. With stiffness K and dry friction F a servo moves before the goal has moved by
    2F/K, 0.026 rad for 0.25 N·m and 18.9 N·m/rad; the bound is four times that.
    """

    WINDOW_NS = 50_000_000
    GOAL_MOVED = 0.1

    def __init__(self, description: RobotDescription) -> None:
        n = len(description.joints)
        self._names = description.joint_names
        self._since_ns = 0
        self._position = np.full(n, np.nan)
        self._low, self._high = np.zeros(n), np.zeros(n)
        self._still = np.zeros(n, dtype=np.bool_)
        self._found: list[Event] = []

    def look(self, situation: Situation) -> list[Event]:
        """SOFT_STOP for every frozen joint, judged once a window."""
        goal, position = situation.applied.position, situation.frame.joint_position
        if situation.now_ns - self._since_ns >= self.WINDOW_NS:
            moved = self._high - self._low > self.GOAL_MOVED
            self._found = [
                Event(self._names[j], "frozen", Severity.SOFT_STOP)
                for j in np.flatnonzero(moved & self._still).tolist()
            ]
            self._since_ns = situation.now_ns
            # Before the first command there is no goal yet: that window is not judged.
            self._still[:] = np.isfinite(self._position)
            self._position[:] = position
            self._low[:], self._high[:] = goal, goal
        np.minimum(self._low, goal, out=self._low)
        np.maximum(self._high, goal, out=self._high)
        self._still &= position == self._position
        return self._found


class LoadMonitor:
    """Rms torque of every joint over LOAD_TIME_S, as a share of its limit.

        m ← m + (τ² − m)·h/T,    √m > share·τ_max

    Winding heat goes with the square of the torque. A joint that stalls reaches 0.6 after 2.2 s.
    """

    def __init__(self, description: RobotDescription, rate_hz: int) -> None:
        limits = np.array([joint.torque_limit for joint in description.joints])
        self._names = description.joint_names
        self._stop = np.square(limits * description.safety.torque_share_max)
        self._mean = np.zeros(limits.size)
        self._share = LOAD_EVERY / (LOAD_TIME_S * rate_hz)
        self._tick = 0

    def look(self, situation: Situation) -> list[Event]:
        """SOFT_STOP for joints that work too hard; WARN at WARN_SHARE of that torque."""
        self._tick += 1
        if self._tick % LOAD_EVERY:
            return []
        self._mean += (np.square(situation.frame.joint_torque) - self._mean) * self._share
        if (self._mean < WARN_SHARE**2 * self._stop).all():
            return []
        return [
            Event(
                self._names[j],
                "overloaded" if self._mean[j] > self._stop[j] else "works hard",
                Severity.SOFT_STOP if self._mean[j] > self._stop[j] else Severity.WARN,
            )
            for j in np.flatnonzero(self._mean >= WARN_SHARE**2 * self._stop).tolist()
        ]
