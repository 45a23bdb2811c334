"""The writes of one tick as bytes: goal positions always, gains and PWM where they changed.

Nobody acknowledges a sync write, so what was sent once may have been lost: registers that rarely
change are compared with what a servo says in idle time that it has, and sent again if need be.
"""

from collections.abc import Sequence

import numpy as np

from drivers.dynamixel.blocks import SlowRegisters
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.protocol import BROADCAST_ID, Instruction, encode_instruction
from hil.interface import Ints
from hil.servo import ServoGoals

_GOAL_DTYPE = np.dtype([("id", "u1"), ("value", "<i4")])
_GAIN_DTYPE = np.dtype([("id", "u1"), ("value", "<i2")])
_NEVER = -1


def _sync_head(register: Register) -> bytes:
    return register.address.to_bytes(2, "little") + register.size.to_bytes(2, "little")


class _RareRegister:
    """A two-byte register of every servo that is written when its value changes."""

    def __init__(self, register: Register, ids: Sequence[int]) -> None:
        self._head = _sync_head(register)
        self._items = np.zeros(len(ids), _GAIN_DTYPE)
        self._items["id"] = ids
        self._sent = np.full(len(ids), _NEVER, dtype=np.int64)
        self._last = b""
        """All joints' values when nothing was left to send."""

    def forget(self) -> None:
        """Send every servo's value again."""
        self._sent[:] = _NEVER
        self._last = b""

    def compare(self, place: int, found: int | None) -> None:
        """Send one servo's value again if it is found to have another."""
        if found is not None and found != self._sent[place]:
            self._sent[place] = _NEVER
            self._last = b""

    def encode(self, whole: Ints, joints: Ints) -> bytes:
        """A sync write of the changed values, empty if there are none.

        `whole` has the values of the robot's joints, `joints` are those of the bus.
        """
        key = whole.tobytes()
        if key == self._last:
            return b""
        self._last = key
        values = whole[joints]
        changed = values != self._sent
        if not changed.any():
            return b""
        self._sent[:] = values
        self._items["value"] = values
        return encode_instruction(
            BROADCAST_ID, Instruction.SYNC_WRITE, self._head + self._items[changed].tobytes()
        )


class ServoWriter:
    """Encodes the goals of one bus's servos."""

    def __init__(self, ids: Sequence[int], joints: Ints) -> None:
        self._joints = joints
        self._head = _sync_head(Register.GOAL_POSITION)
        self._goals = np.zeros(len(ids), _GOAL_DTYPE)
        self._goals["id"] = ids
        self._p_gain = _RareRegister(Register.POSITION_P_GAIN, ids)
        self._d_gain = _RareRegister(Register.POSITION_D_GAIN, ids)
        self._pwm = _RareRegister(Register.GOAL_PWM, ids)
        self._current = _RareRegister(Register.GOAL_CURRENT, ids)

    def compare(self, place: int, found: SlowRegisters) -> None:
        """Send again with the next write what a servo does not have as it should."""
        self._p_gain.compare(place, found.p_gain)
        self._d_gain.compare(place, found.d_gain)
        self._pwm.compare(place, found.goal_pwm)

    def forget(self) -> None:
        """Send everything with the next write."""
        for register in (self._p_gain, self._d_gain, self._pwm, self._current):
            register.forget()

    def encode(self, goals: ServoGoals) -> bytes:
        """Packets to send, in the order in which servos should act on them."""
        joints = self._joints
        self._goals["value"] = goals.position[joints]
        current = b"" if goals.current is None else self._current.encode(goals.current, joints)
        return (
            current
            + self._p_gain.encode(goals.p_gain, joints)
            + self._d_gain.encode(goals.d_gain, joints)
            + self._pwm.encode(goals.pwm_limit, joints)
            + encode_instruction(
                BROADCAST_ID, Instruction.SYNC_WRITE, self._head + self._goals.tobytes()
            )
        )
