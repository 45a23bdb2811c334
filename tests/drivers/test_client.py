"""One servo at a time, with dynamixel-sdk as an independent client of the same bytes."""

import pytest
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, Protocol2PacketHandler

from drivers.dynamixel.audit import ExpectedServo, audit_bus
from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import DriveMode, HardwareError, Register
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.power import BusPower
from drivers.dynamixel.sdk_port import SdkPort
from drivers.dynamixel.servo_models import find_servo_model
from hil.errors import BackendError

IDS = list(range(1, 7))
MODEL = find_servo_model("XM430-W350")


@pytest.fixture
def client(fake_port, timing, clock):
    return ServoClient(fake_port, timing, clock)


@pytest.fixture
def group(fake_port, timing, clock):
    return GroupAccess(fake_port, timing, clock)


@pytest.fixture
def power(group):
    return BusPower("left_leg", group, IDS)


def test_ping_tells_the_model_or_that_nobody_is_there(client, fake_port, clock):
    assert client.ping(3) == 1020
    fake_port.servos[3].silent = True
    before = clock.now_ns()
    assert client.ping(3) is None
    assert clock.now_ns() - before < 70_000_000


def test_registers_are_read_and_written_with_their_signs(client):
    client.write(2, Register.HOMING_OFFSET, -1000)
    assert client.read(2, Register.HOMING_OFFSET) == -1000
    client.write(2, Register.RETURN_DELAY_TIME, 0)
    assert client.read(2, Register.RETURN_DELAY_TIME) == 0


# The SDK's txPacket forgets stuffing: the port handler must mend it.
def test_a_write_that_needs_stuffing_arrives(client):
    client.write(2, Register.GOAL_POSITION, -131073)  # FF FF FD FF
    assert client.read(2, Register.GOAL_POSITION) == -131073


def test_an_alerting_servo_stays_readable(client, fake_port):
    fake_port.servos[5][Register.HARDWARE_ERROR_STATUS] = HardwareError.OVERHEATING
    assert client.read(5, Register.HARDWARE_ERROR_STATUS) == HardwareError.OVERHEATING


def test_a_missing_servo_is_named_with_bus_id_and_register(client):
    with pytest.raises(BackendError, match="bus left_leg id 9: cannot read Present Position: "):
        client.read(9, Register.PRESENT_POSITION)


@pytest.mark.parametrize("fast", [False, True], ids=["sync read", "fast sync read"])
def test_the_sdks_group_reads_understand_our_status_packets(fake_port, timing, clock, fast):
    handler = SdkPort(fake_port, timing, clock)
    group = GroupSyncRead(handler, Protocol2PacketHandler(), 126, 10)
    for servo_id in IDS:
        group.addParam(servo_id)
        fake_port.servos[servo_id][Register.PRESENT_POSITION] = 1000 + servo_id
    result = group.fastSyncRead() if fast else group.txRxPacket()
    assert result == COMM_SUCCESS
    assert [group.getData(servo_id, 132, 4) for servo_id in IDS] == [1000 + i for i in IDS]


def test_group_reads_get_around_a_silent_servo(group, fake_port):
    fake_port.servos[1].silent = True
    values = group.read(Register.PRESENT_TEMPERATURE, IDS)
    assert values == dict.fromkeys(IDS[1:], 30)


def expected(model=MODEL):
    return [ExpectedServo(f"joint_{servo_id}", servo_id, model) for servo_id in IDS]


def test_an_audit_corrects_settings_and_says_so(client, group, fake_port):
    fake_port.servos[2][Register.OPERATING_MODE] = 4
    fake_port.servos[4][Register.DRIVE_MODE] = (
        DriveMode.TORQUE_ON_BY_GOAL_UPDATE | DriveMode.TIME_BASED_PROFILE
    )
    result = audit_bus("left_leg", client, group, expected())
    assert not result.problems
    assert result.fast_reads
    assert len(result.changes) == 6 + 6 + 2  # return delay, shutdown, and the two above
    assert "bus left_leg id 2 (joint_2): Operating Mode 4 -> 3" in result.changes
    assert fake_port.servos[4][Register.DRIVE_MODE] == DriveMode.TIME_BASED_PROFILE
    assert not audit_bus("left_leg", client, group, expected()).changes


def test_all_missing_and_wrong_servos_are_named_together(client, group, fake_port):
    fake_port.servos[1].silent = True
    fake_port.servos[6][Register.MODEL_NUMBER] = 1060
    result = audit_bus("left_leg", client, group, expected())
    assert result.problems == [
        "bus left_leg id 1 (joint_1) does not answer",
        "bus left_leg id 6 (joint_6) is XL430-W250, the robot file says XM430-W350",
    ]
    assert not result.changes


def test_settings_are_not_touched_while_torque_is_on(client, group, fake_port):
    fake_port.servos[3][Register.TORQUE_ENABLE] = 1
    with pytest.raises(BackendError, match=r"id 3 .*Return Delay Time is 250.*torque is on"):
        audit_bus("left_leg", client, group, expected())


def test_narrow_position_limits_are_refused(client, group, fake_port):
    fake_port.servos[3][Register.MIN_POSITION_LIMIT] = 1000
    (problem,) = audit_bus("left_leg", client, group, expected()).problems
    assert "id 3 (joint_3) has position limits 1000 to 4095" in problem


def test_old_firmware_means_plain_reads(client, group, fake_port):
    fake_port.servos[5][Register.FIRMWARE_VERSION] = 44
    assert not audit_bus("left_leg", client, group, expected()).fast_reads


def test_arming_adopts_the_position_and_clears_factory_gains(power, fake_port):
    for servo_id, servo in fake_port.servos.items():
        servo[Register.PRESENT_POSITION] = 1500 + servo_id
        servo[Register.POSITION_D_GAIN] = 4000
        servo[Register.POSITION_I_GAIN] = 7
    power.prepare(power.present_positions(), dict.fromkeys(IDS, 800))
    power.on()
    power.arm_watchdog()
    servo = fake_port.servos[4]
    assert servo[Register.GOAL_POSITION] == 1504
    assert servo[Register.POSITION_P_GAIN] == 800
    assert (servo[Register.POSITION_D_GAIN], servo[Register.POSITION_I_GAIN]) == (0, 0)
    assert servo[Register.GOAL_PWM] == 885
    assert (servo[Register.TORQUE_ENABLE], servo[Register.BUS_WATCHDOG]) == (1, 2)


def test_a_servo_that_refuses_torque_is_named_with_its_error(power, fake_port):
    fake_port.servos[2].refuses.add(Register.TORQUE_ENABLE)
    fake_port.servos[2][Register.HARDWARE_ERROR_STATUS] = HardwareError.OVERLOAD
    with pytest.raises(BackendError, match=r"Torque Enable was not accepted: id 2 .*OVERLOAD"):
        power.on()


def test_torque_off_is_true_only_when_every_servo_said_so(power, fake_port):
    power.on()
    assert power.off()
    assert not any(servo[Register.TORQUE_ENABLE] for servo in fake_port.servos.values())
    power.on()
    fake_port.servos[2].refuses.add(Register.TORQUE_ENABLE)
    assert not power.off()
    assert not fake_port.servos[1][Register.TORQUE_ENABLE]
