"""The servos: too hot, starved, in error, or frozen."""

import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats, Ints, JointError
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity

WARN_BELOW_K, STOP_BELOW_K = 10.0, 5.0
"""Distances to the servo's own shutdown temperature at which to warn and to stop [K]."""
_OWN_BITS, _VOLTAGE_BIT = 0x7F, 0x01
_DISOBEDIENT = (
    (JointError.REBOOTED, "rebooted"),
    (JointError.TORQUE_LOST, "torque lost"),
    (JointError.STOPPED, "stopped by its watchdog"),
)
"""Worst first."""
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

    def look(self, situation: Situation) -> list[Event]:
        """SOFT_STOP for the rest of the robot; a low voltage alone is only told (WARN)."""
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
        if own == _VOLTAGE_BIT:
            return Event(self._names[joint], "servo input voltage", Severity.WARN)
        return Event(self._names[joint], f"servo error 0x{own:02x}", Severity.SOFT_STOP)


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
