"""Instructions to one servo: from a packet to the error byte and data of its answer."""

import struct
from collections.abc import Callable

from drivers.dynamixel.protocol import Instruction, Packet, StatusError
from sim_backends.virtual.servo import EmulatedServo

_WORDS = struct.Struct("<HH")
Answer = tuple[int, bytes]


def refuse(servo: EmulatedServo, _: Packet) -> Answer:
    """What it answers to an instruction that it does not know."""
    return servo.error(StatusError.INSTRUCTION), b""


def _read(servo: EmulatedServo, packet: Packet) -> Answer:
    if len(packet.params) != _WORDS.size:
        return servo.error(StatusError.DATA_LENGTH), b""
    return servo.read(*_WORDS.unpack(packet.params))


def _write(servo: EmulatedServo, packet: Packet) -> Answer:
    return servo.write(int.from_bytes(packet.params[:2], "little"), packet.params[2:]), b""


def _register_write(servo: EmulatedServo, packet: Packet) -> Answer:
    address = int.from_bytes(packet.params[:2], "little")
    return servo.register_write(address, packet.params[2:]), b""


def _act(servo: EmulatedServo, _: Packet) -> Answer:
    return servo.act(), b""


def _reboot(servo: EmulatedServo, _: Packet) -> Answer:
    servo.reboot()
    return servo.error(), b""


def _factory_reset(servo: EmulatedServo, packet: Packet) -> Answer:
    return servo.factory_reset(packet.params, packet.id), b""


def _clear(servo: EmulatedServo, packet: Packet) -> Answer:
    return servo.clear(packet.params), b""


def _back_up(servo: EmulatedServo, packet: Packet) -> Answer:
    return servo.back_up(packet.params), b""


SINGLE: dict[int, Callable[[EmulatedServo, Packet], Answer]] = {
    Instruction.READ: _read,
    Instruction.WRITE: _write,
    Instruction.REG_WRITE: _register_write,
    Instruction.ACTION: _act,
    Instruction.REBOOT: _reboot,
    Instruction.FACTORY_RESET: _factory_reset,
    Instruction.CLEAR: _clear,
    Instruction.BACKUP: _back_up,
}
"""What does each instruction."""
