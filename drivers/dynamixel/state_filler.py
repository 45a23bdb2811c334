"""Answers of one bus's servos into the robot's `ServoStates`."""

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drivers.dynamixel.blocks import HOT
from drivers.dynamixel.control_table import VOLTAGE_UNIT, WATCHDOG_TRIPPED
from drivers.dynamixel.idle_read import IdleAnswer
from drivers.dynamixel.protocol import ALERT, ERROR_MASK, FastBlock
from drivers.dynamixel.read_plan import BusServo, ReadPlan
from drivers.dynamixel.realtime_ticks import RealtimeTicks, Verdict
from drivers.dynamixel.states import ServoStates
from hil.interface import JointError

_HOT = struct.Struct("<HBBhhii")
"""Tick, moving, moving status, PWM, current, velocity, position."""
_SERVOS_OWN = 0xFF
"""Bits of `error` that are the servo's Hardware Error Status."""


class StateFiller:
    """Takes answers one by one, or a whole tick's hot blocks at once.

    While `armed`, a servo that is found without torque or with its watchdog tripped no longer
    obeys: its joint keeps that error until the robot is armed again.
    """

    def __init__(self, servos: Sequence[BusServo], states: ServoStates) -> None:
        self.heard: set[int] = set()
        """Places on the bus of the servos that answered in this tick."""
        self.repeated: set[int] = set()
        """Places of those whose answer was not newer than the one before."""
        self.alerting: set[int] = set()
        """Places of the servos that raise their alert bit."""
        self.suspects: set[int] = set()
        """Places of the servos whose state is to be read next."""
        self._armed = False
        self._joints = tuple(servo.joint for servo in servos)
        self._places = {servo.id: place for place, servo in enumerate(servos)}
        self._states = states
        self._ticks = RealtimeTicks(len(servos))
        self._sample_ns = 0

    def arm(self, armed: bool) -> None:
        """From now on the servos' torque and watchdog are to be on, or need not be."""
        self._armed = armed
        if armed:
            self.suspects.clear()
            self._ticks.forget()
            self._states.error[list(self._joints)] &= _SERVOS_OWN

    def begin(self, sample_ns: int) -> None:
        """Begin a tick whose values are sampled at a time [ns]."""
        self.heard.clear()
        self.repeated.clear()
        self._sample_ns = sample_ns

    def take_all(self, plan: ReadPlan, blocks: NDArray[np.void]) -> bool:
        """Take the hot blocks of all of a plan's servos, none of which reports anything; take none
        and return False where one has an odd time, or alerted before."""
        if self.alerting or not self._ticks.all_fresh(plan.places, blocks["tick"], self._sample_ns):
            return False
        joints = plan.joints
        states = self._states
        states.position[joints] = blocks["position"]
        states.velocity[joints] = blocks["velocity"]
        states.current[joints] = blocks["current"]
        states.valid[joints] = True
        states.time_ns[joints] = self._sample_ns
        self.heard.update(plan.members)
        return True

    def take(self, servo: FastBlock) -> Verdict | None:
        """Take one servo's hot block; what its clock says of it, None if it holds nothing."""
        place = self._places.get(servo.id)
        if place is None or servo.error & ERROR_MASK or len(servo.data) != HOT.length:
            return None
        tick, *_, current, velocity, position = _HOT.unpack(servo.data)
        verdict, late_ns = self._ticks.judge(place, tick, self._sample_ns)
        if verdict is Verdict.REPEATED:
            self.repeated.add(place)
            return verdict
        joint = self._joints[place]
        states = self._states
        states.current[joint] = current
        states.velocity[joint] = velocity
        states.position[joint] = position
        states.valid[joint] = True
        states.time_ns[joint] = self._sample_ns - late_ns
        self.heard.add(place)
        self._take_alert(place, servo.error)
        if verdict is Verdict.RESTARTED:
            self.suspects.add(place)
            if self._armed:
                states.error[joint] |= JointError.REBOOTED
        return verdict

    def take_idle(self, answer: IdleAnswer) -> None:
        """Take one servo's slow registers."""
        place, error, found = answer
        joint = self._joints[place]
        states = self._states
        self._take_alert(place, error)
        if found.hardware_error is not None:
            self.suspects.discard(place)
            errors = int(states.error[joint]) & ~_SERVOS_OWN | found.hardware_error
            states.error[joint] = errors
        if self._armed and found.torque == 0:
            states.error[joint] |= JointError.TORQUE_LOST
            if found.watchdog == 0:  # Its RAM is new.
                states.error[joint] |= JointError.REBOOTED
        if self._armed and found.watchdog == WATCHDOG_TRIPPED:
            states.error[joint] |= JointError.STOPPED
        if found.voltage is not None and found.temperature is not None:
            states.voltage[joint] = VOLTAGE_UNIT * found.voltage
            states.temperature[joint] = found.temperature

    def _take_alert(self, place: int, error: int) -> None:
        """Keep track of who alerts; why is read in idle time."""
        joint = self._joints[place]
        if not error & ALERT:
            if place in self.alerting:
                self.alerting.discard(place)
                self._states.error[joint] &= ~_SERVOS_OWN
            return
        self.alerting.add(place)
        if not self._states.error[joint] & _SERVOS_OWN:
            self._states.error[joint] |= JointError.UNEXPLAINED
            self.suspects.add(place)
