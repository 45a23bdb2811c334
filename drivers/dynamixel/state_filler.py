"""Answers of one bus's servos into the robot's `ServoStates`."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drivers.dynamixel.control_table import VOLTAGE_UNIT, Register
from drivers.dynamixel.protocol import ALERT, ERROR_MASK, FastBlock
from drivers.dynamixel.read_plan import FAULT, HOT, Block, BusServo, ReadPlan, hot_values
from drivers.dynamixel.states import ALERT_UNKNOWN, ServoStates


class StateFiller:
    """Takes answers one by one, or a whole tick's hot blocks at once."""

    def __init__(self, servos: Sequence[BusServo], states: ServoStates) -> None:
        self.heard: set[int] = set()
        """Places on the bus of the servos that answered in this tick."""
        self.alerting: set[int] = set()
        """Places of the servos that raise their alert bit."""
        self._joints = tuple(servo.joint for servo in servos)
        self._places = {servo.id: place for place, servo in enumerate(servos)}
        self._states = states
        self._sample_ns = 0

    def begin(self, sample_ns: int) -> None:
        """Begin a tick whose values are sampled at a time [ns]."""
        self.heard.clear()
        self._sample_ns = sample_ns

    def unexplained(self) -> int | None:
        """Place of a servo whose alert has no known cause yet."""
        for place in self.alerting:
            if self._states.error[self._joints[place]] == ALERT_UNKNOWN:
                return place
        return None

    def take_all(self, plan: ReadPlan, blocks: NDArray[np.void]) -> None:
        """Take hot blocks without errors or alerts, in the plan's order from its first servo."""
        count = len(blocks)
        joints = plan.joints[:count]
        states = self._states
        states.position[joints] = blocks["position"]
        states.velocity[joints] = blocks["velocity"]
        states.current[joints] = blocks["current"]
        states.valid[joints] = True
        states.time_ns[joints] = self._sample_ns
        self.heard.update(plan.members[:count])

    def take(self, plan: ReadPlan, servo: FastBlock) -> None:
        """Take one servo's answer, unless it reports that it could not do what it was asked."""
        place = self._places.get(servo.id)
        if place is None or place not in plan.members:
            return
        block = plan.last if place == plan.members[-1] else HOT
        if servo.error & ERROR_MASK or len(servo.data) != block.length:
            return
        joint = self._joints[place]
        states = self._states
        values = hot_values(block, servo)
        states.current[joint], states.velocity[joint], states.position[joint] = values
        states.valid[joint] = True
        states.time_ns[joint] = self._sample_ns
        if block is not HOT:
            voltage = block.value(Register.PRESENT_INPUT_VOLTAGE, servo.data)
            states.voltage[joint] = VOLTAGE_UNIT * voltage
            states.temperature[joint] = block.value(Register.PRESENT_TEMPERATURE, servo.data)
        self._take_alert(place, block, servo)
        self.heard.add(place)

    def _take_alert(self, place: int, block: Block, servo: FastBlock) -> None:
        """Keep track of who alerts, and why."""
        joint = self._joints[place]
        if not servo.error & ALERT:
            self.alerting.discard(place)
            self._states.error[joint] = 0
            return
        self.alerting.add(place)
        if block is FAULT:
            cause = block.value(Register.HARDWARE_ERROR_STATUS, servo.data)
            self._states.error[joint] = cause
        elif self._states.error[joint] == 0:
            self._states.error[joint] = ALERT_UNKNOWN
