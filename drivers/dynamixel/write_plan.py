"""The writes of one tick as bytes: goal positions always, gains and PWM where they changed.

Nobody acknowledges a sync write, so what was sent once may have been lost: registers that rarely
change are also refreshed servo by servo, in the ticks in which that servo is polled.
"""

from collections.abc import Sequence

import numpy as np

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
        self._due = True

    def forget(self, place: int | None = None) -> None:
        """Send the value again, of one servo or of all."""
        self._sent[slice(None) if place is None else place] = _NEVER
        self._due = True

    def encode(self, values: Ints) -> bytes:
        """A sync write of the changed values, empty if there are none."""
        changed = values != self._sent
        if not (self._due or changed.any()):
            return b""
        self._due = False
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

    def refresh(self, place: int) -> None:
        """Send the rarely written registers of one servo with the next write."""
        for register in (self._p_gain, self._d_gain, self._pwm):
            register.forget(place)

    def forget(self) -> None:
        """Send everything with the next write."""
        for register in (self._p_gain, self._d_gain, self._pwm):
            register.forget()

    def encode(self, goals: ServoGoals) -> bytes:
        """Packets to send, in the order in which servos should act on them."""
        joints = self._joints
        self._goals["value"] = goals.position[joints]
        return (
            self._p_gain.encode(goals.p_gain[joints])
            + self._d_gain.encode(goals.d_gain[joints])
            + self._pwm.encode(goals.pwm_limit[joints])
            + encode_instruction(
                BROADCAST_ID, Instruction.SYNC_WRITE, self._head + self._goals.tobytes()
            )
        )
