"""What a servo is set up to, by model and firmware; and what a mirror does to joints."""

import pytest

from drivers.commissioning.settings import (
    FIRST,
    LAST,
    RegisterImage,
    errors_by_name,
    needed_changes,
    wanted_settings,
)
from drivers.dynamixel.audit import ExpectedServo
from drivers.dynamixel.control_table import OperatingMode, Register
from drivers.dynamixel.servo_models import find_servo_model
from hil.bringup.mirror import mirrored_pairs
from hil.robot_files import load_robot


def image(model, firmware=48, **registers):
    """Registers as from the factory."""
    block = bytearray(LAST.end - FIRST.address)
    values = {register: model.initial(register) or 0 for register in Register}
    values |= {Register.MODEL_NUMBER: model.number, Register.FIRMWARE_VERSION: firmware}
    values |= {Register[name]: value for name, value in registers.items()}
    for register, value in values.items():
        if register.end <= LAST.end:
            block[register.address : register.end] = register.spec.encode(value)
    return RegisterImage(model, bytes(block))


def servo(name, mode=OperatingMode.POSITION):
    return ExpectedServo("left_knee", 4, find_servo_model(name), mode)


def wanted(name, firmware=48, mode=OperatingMode.POSITION):
    one = servo(name, mode)
    return {row.register: row.value for row in wanted_settings(one, image(one.model, firmware))}


def test_a_factory_servo_needs_little():
    one = servo("XM430-W350")
    changes = needed_changes(one, image(one.model))
    assert [(row.register, row.found, row.wanted) for row in changes] == [
        ("Return Delay Time", 250, 0)
    ]


def test_a_5_v_servo_loses_its_slow_slope_and_its_voltage_shutdown():
    rows = wanted("XL330-M288")
    assert rows[Register.PWM_SLOPE] == 255
    assert rows[Register.SHUTDOWN] == 52


def test_registers_that_a_model_or_firmware_lacks_are_left_alone():
    assert Register.CURRENT_LIMIT not in wanted("XL430-W250")
    assert Register.PWM_SLOPE not in wanted("XM430-W350")
    assert Register.STARTUP_CONFIGURATION in wanted("XM430-W350", 45)
    assert Register.STARTUP_CONFIGURATION not in wanted("XM430-W350", 44)


def test_the_mode_is_the_robot_files_and_comes_before_what_it_resets():
    rows = wanted("XM430-W350", mode=OperatingMode.CURRENT_BASED_POSITION)
    assert rows[Register.OPERATING_MODE] == 5
    order = list(rows)
    assert order.index(Register.OPERATING_MODE) < order.index(Register.PWM_LIMIT)


def test_harmless_drive_mode_bits_stay():
    one = servo("XM430-W350")
    rows = {
        row.register: row.value for row in wanted_settings(one, image(one.model, DRIVE_MODE=13))
    }
    assert rows[Register.DRIVE_MODE] == 4


@pytest.mark.parametrize(
    ("value", "text"), [(0, ""), (32, "overload"), (5, "input voltage, overheating")]
)
def test_errors_have_names(value, text):
    assert errors_by_name(value) == text


def test_legs_mirror_with_the_signs_of_their_axes():
    signs = {left: sign for left, _, sign in mirrored_pairs(load_robot("minibiped"))}
    assert signs == {
        "left_hip_yaw": -1, "left_hip_roll": -1, "left_hip_pitch": 1,
        "left_knee": 1, "left_ankle_pitch": 1, "left_ankle_roll": -1,
    }  # fmt: skip
