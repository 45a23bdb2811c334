"""The SDK's own example flow, its classes unmodified, against the served robot on terminals."""

import time

import pytest
from dynamixel_sdk import (
    COMM_SUCCESS,
    GroupBulkRead,
    GroupBulkWrite,
    GroupSyncRead,
    GroupSyncWrite,
    PacketHandler,
    PortHandler,
)

from sim_backends.virtual.remote import ServerProcess
from tests.sim_backends.virtual.test_server import answered

pytestmark = [pytest.mark.pty, pytest.mark.usefixtures("patient_sdk")]

IDS = range(1, 7)
TORQUE, LED, P_GAIN, GOAL, POSITION, VOLTAGE, DELAY = 64, 65, 84, 116, 132, 144, 9


@pytest.fixture(scope="module")
def bus():
    """Port and packet handler of a bus at the robot's baud."""
    server = ServerProcess("minibiped", 300, 0)
    port = PortHandler(server.port_urls["left_leg"])
    assert port.openPort()
    assert port.setBaudRate(4_000_000)
    yield port, PacketHandler(2.0)
    port.closePort()
    server.close()


def four(value):
    return list(value.to_bytes(4, "little"))


def test_scan(bus):
    port, sdk = bus
    assert answered(lambda: sdk.ping(port, 1)) == (1020, COMM_SUCCESS, 0)
    assert sdk.ping(port, 33)[1] != COMM_SUCCESS
    for _ in range(10):
        found, result = sdk.broadcastPing(port)
        if len(found) == len(IDS):
            break
    assert result == COMM_SUCCESS
    assert found == {servo_id: [1020, 48] for servo_id in IDS}


def test_read_write(bus):
    port, sdk = bus
    assert answered(lambda: sdk.write1ByteTxRx(port, 1, TORQUE, 1)) == (COMM_SUCCESS, 0)
    here, _, _ = answered(lambda: sdk.read4ByteTxRx(port, 1, POSITION))
    assert answered(lambda: sdk.write4ByteTxRx(port, 1, GOAL, here)) == (COMM_SUCCESS, 0)
    assert answered(lambda: sdk.read4ByteTxRx(port, 1, GOAL)) == (here, COMM_SUCCESS, 0)
    result, error = answered(lambda: sdk.write1ByteTxRx(port, 1, DELAY, 5))
    assert (
        sdk.getRxPacketError(error)
        == "[RxPacketError] Writing or Reading is not available to target address!"
    )
    assert result == COMM_SUCCESS
    assert answered(lambda: sdk.write1ByteTxRx(port, 1, TORQUE, 0)) == (COMM_SUCCESS, 0)


@pytest.mark.parametrize("transfer", ["txRxPacket", "fastSyncRead"])
def test_sync_write_and_sync_read(bus, transfer):
    port, sdk = bus
    writer = GroupSyncWrite(port, sdk, GOAL, 4)
    for servo_id in IDS:
        assert writer.addParam(servo_id, four(2000 + servo_id))
    assert writer.txPacket() == COMM_SUCCESS
    reader = GroupSyncRead(port, sdk, GOAL, 4)
    for servo_id in IDS:
        assert reader.addParam(servo_id)
    assert answered(getattr(reader, transfer)) == COMM_SUCCESS
    assert [reader.getData(servo_id, GOAL, 4) for servo_id in IDS] == [2000 + i for i in IDS]


@pytest.mark.parametrize("transfer", ["txRxPacket", "fastBulkRead"])
def test_bulk_write_and_bulk_read(bus, transfer):
    port, sdk = bus
    writer = GroupBulkWrite(port, sdk)
    assert writer.addParam(1, GOAL, 4, four(2100))
    assert writer.addParam(2, LED, 1, [1])
    assert writer.txPacket() == COMM_SUCCESS
    reader = GroupBulkRead(port, sdk)
    assert reader.addParam(1, GOAL, 4)
    assert reader.addParam(2, LED, 1)
    assert reader.addParam(3, VOLTAGE, 2)
    assert answered(getattr(reader, transfer)) == COMM_SUCCESS
    values = reader.getData(1, GOAL, 4), reader.getData(2, LED, 1), reader.getData(3, VOLTAGE, 2)
    assert values[:2] == (2100, 1)
    assert values[2] == pytest.approx(120, abs=3)


def test_reboot(bus):
    port, sdk = bus
    assert answered(lambda: sdk.write2ByteTxRx(port, 5, P_GAIN, 321)) == (COMM_SUCCESS, 0)
    assert sdk.reboot(port, 5)[0] == COMM_SUCCESS
    time.sleep(0.4)
    assert answered(lambda: sdk.read2ByteTxRx(port, 5, P_GAIN)) == (800, COMM_SUCCESS, 0)


def test_factory_reset_and_setting_up_again(bus):
    """As the SDK's example does it: everything but the id, then back to the bus's baud."""
    port, sdk = bus
    assert answered(lambda: sdk.write1ByteTxRx(port, 6, DELAY, 7)) == (COMM_SUCCESS, 0)
    assert sdk.factoryReset(port, 6, 0x01)[0] == COMM_SUCCESS
    time.sleep(0.4)
    assert port.setBaudRate(57_600)
    assert answered(lambda: sdk.read1ByteTxRx(port, 6, DELAY)) == (250, COMM_SUCCESS, 0)
    assert answered(lambda: sdk.write1ByteTxRx(port, 6, 8, 6)) == (COMM_SUCCESS, 0)
    assert port.setBaudRate(4_000_000)
    assert answered(lambda: sdk.ping(port, 6)) == (1020, COMM_SUCCESS, 0)
