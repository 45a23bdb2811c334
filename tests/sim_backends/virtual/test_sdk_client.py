"""The dynamixel-sdk as an independent client of the emulated bus, in lockstep."""

import serial
from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupBulkRead,
    GroupBulkWrite,
    GroupSyncRead,
    GroupSyncWrite,
    PortHandler,
    Protocol2PacketHandler,
)
from pytest import fixture

from drivers.dynamixel.protocol import StatusError

IDS = [1, 2, 3, 4, 5, 6]
MODEL = 1020


class LockstepPort(PortHandler):
    """The SDK's port on the virtual clock: nothing of our driver in between."""

    def __init__(self, url, clock):
        super().__init__(url)
        self._clock = clock
        self._serial = serial.serial_for_url(url, baudrate=4_000_000, timeout=0)
        self._deadline = 0
        self.is_open = True

    def clearPort(self):
        self._serial.reset_input_buffer()

    def readPort(self, length):
        if self._serial.in_waiting < length:
            self._clock.wait_readable([], self._clock.now_ns() + 100_000)
        return self._serial.read(length)

    def writePort(self, packet):
        return self._serial.write(bytes(packet))

    def setPacketTimeout(self, packet_length):
        self._deadline = self._clock.now_ns() + 30_000_000

    def setPacketTimeoutMillis(self, msec):
        self._deadline = self._clock.now_ns() + int(msec * 1e6)

    def isPacketTimeout(self):
        return self._clock.now_ns() >= self._deadline


@fixture
def rig(robot):
    made = robot()
    return made, LockstepPort(made.port_urls["left_leg"], made.clock), Protocol2PacketHandler()


def test_ping_and_broadcast_ping(rig):
    _, port, sdk = rig
    assert sdk.ping(port, 3) == (MODEL, COMM_SUCCESS, 0)
    assert sdk.ping(port, 11)[1] == COMM_RX_TIMEOUT
    found, result = sdk.broadcastPing(port)
    assert result == COMM_SUCCESS
    assert found == {servo_id: [MODEL, 48] for servo_id in IDS}


def test_read_and_write(rig):
    made, port, sdk = rig
    assert sdk.write2ByteTxRx(port, 1, 84, 640) == (COMM_SUCCESS, 0)
    assert sdk.read2ByteTxRx(port, 1, 84) == (640, COMM_SUCCESS, 0)
    assert sdk.write2ByteTxRx(port, 1, 84, 20000) == (COMM_SUCCESS, StatusError.DATA_RANGE)
    position, result, _ = sdk.read4ByteTxRx(port, 3, 132)
    assert (position, result) == (made.world.servos.counts[2], COMM_SUCCESS)


def test_registered_write_and_action(rig):
    made, port, sdk = rig
    data = list((2000).to_bytes(4, "little"))
    assert sdk.regWriteTxRx(port, 1, 116, 4, data) == (COMM_SUCCESS, 0)
    assert made.world.servos.goal[0] == 2048
    assert sdk.action(port, 1) == COMM_SUCCESS
    made.clock.sleep_until_ns(made.clock.now_ns() + 2_000_000)
    assert made.world.servos.goal[0] == 2000


def test_sync_write_then_sync_read(rig):
    _, port, sdk = rig
    writer = GroupSyncWrite(port, sdk, 116, 4)
    for servo_id in IDS:
        writer.addParam(servo_id, list((2000 + servo_id).to_bytes(4, "little")))
    assert writer.txPacket() == COMM_SUCCESS
    for fast in (False, True):
        reader = GroupSyncRead(port, sdk, 116, 4)
        for servo_id in IDS:
            assert reader.addParam(servo_id)
        assert (reader.fastSyncRead if fast else reader.txRxPacket)() == COMM_SUCCESS
        values = [reader.getData(servo_id, 116, 4) for servo_id in IDS]
        assert values == [2000 + servo_id for servo_id in IDS]


def test_bulk_write_then_bulk_read(rig):
    _, port, sdk = rig
    writer = GroupBulkWrite(port, sdk)
    writer.addParam(1, 84, 2, list((700).to_bytes(2, "little")))
    writer.addParam(2, 65, 1, [1])
    assert writer.txPacket() == COMM_SUCCESS
    reader = GroupBulkRead(port, sdk)
    reader.addParam(1, 84, 2)
    reader.addParam(2, 65, 1)
    reader.addParam(3, 144, 2)
    assert reader.txRxPacket() == COMM_SUCCESS
    values = (reader.getData(1, 84, 2), reader.getData(2, 65, 1), reader.getData(3, 144, 2))
    assert values == (700, 1, 120)


def test_reboot_and_factory_reset(rig):
    made, port, sdk = rig
    sdk.write2ByteTxRx(port, 2, 84, 555)
    assert sdk.reboot(port, 2) == (COMM_SUCCESS, 0)
    assert sdk.ping(port, 2)[1] == COMM_RX_TIMEOUT
    made.clock.sleep_until_ns(made.clock.now_ns() + 300_000_000)
    assert sdk.read2ByteTxRx(port, 2, 84) == (800, COMM_SUCCESS, 0)
    assert sdk.write1ByteTxRx(port, 2, 9, 33) == (COMM_SUCCESS, 0)
    assert sdk.factoryReset(port, 2, 0x02) == (COMM_SUCCESS, 0)
    made.clock.sleep_until_ns(made.clock.now_ns() + 300_000_000)
    assert sdk.read1ByteTxRx(port, 2, 9) == (250, COMM_SUCCESS, 0)
