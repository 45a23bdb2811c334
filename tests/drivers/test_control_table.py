"""The register table against ROBOTIS' own model files, which the SDK ships."""

import itertools
from pathlib import Path

import dynamixel_easy_sdk
import pytest

from drivers.dynamixel.control_table import TABLE_SIZE, Access, Area, Register
from drivers.dynamixel.servo_models import (
    SERVO_MODELS,
    find_servo_model,
    find_servo_model_by_number,
)
from hil.errors import InputError, UnknownNameError

MODEL_FILES = Path(dynamixel_easy_sdk.__file__).parent / "control_table"
NOT_IN_FILES = {"PWM Slope", "Startup Configuration", "Backup Ready", "Moving Status"}


def rows_of(model):
    text = (MODEL_FILES / f"{model.lower().replace('-', '_')}.model").read_text()
    rows = text.split("[control table]")[1].splitlines()[2:]
    return {parts[2]: (int(parts[0]), int(parts[1])) for row in rows if (parts := row.split("\t"))}


@pytest.mark.parametrize("model", SERVO_MODELS)
def test_addresses_and_sizes_agree_with_the_vendors_files(model):
    theirs = rows_of(model)
    compared = 0
    for register in Register:
        if register.spec.name in theirs:
            assert (register.address, register.size) == theirs[register.spec.name], register
            compared += 1
    assert compared > 40


def test_registers_do_not_overlap():
    rows = sorted((register.address, register.end) for register in Register)
    assert all(end <= start for (_, end), (start, _) in itertools.pairwise(rows))
    assert rows[-1][1] <= TABLE_SIZE


@pytest.mark.parametrize("register", Register, ids=lambda register: register.name)
def test_every_register_round_trips_its_bounds(register):
    spec = register.spec
    for value in {0, spec.minimum or 0, spec.maximum or 0, spec.initial or 0}:
        assert spec.decode(spec.encode(value)) == value
    if spec.signed:
        assert spec.decode(spec.encode(-1)) == -1
    assert spec.area is (Area.EEPROM if register.address < 64 else Area.RAM)


def test_measurements_cannot_be_written():
    for register in Register:
        if register.name.startswith("PRESENT_") or register is Register.MODEL_NUMBER:
            assert register.spec.access is Access.READ


def test_models_are_found_by_name_and_number():
    assert find_servo_model("XM430-W350") is find_servo_model_by_number(1020)
    with pytest.raises(UnknownNameError, match=r"XM430-W351.*valid:.*XM430-W350"):
        find_servo_model("XM430-W351")
    with pytest.raises(InputError, match=r"1234; valid:.*1020 XM430-W350"):
        find_servo_model_by_number(1234)


@pytest.mark.parametrize("model", SERVO_MODELS.values(), ids=lambda model: model.name)
def test_the_motor_stalls_and_idles_as_the_datasheet_says(model):
    current = model.voltage / model.resistance
    assert model.torque_constant * current == pytest.approx(model.stall_torque)
    assert model.voltage / model.torque_constant == pytest.approx(model.no_load_speed)


# Derived figures of the reference XM430-W350: T/w0 and V/w0 at 12 V, 46 rpm, 4.1 N·m.
def test_xm430_w350_has_the_expected_constants():
    model = find_servo_model("XM430-W350")
    assert model.torque_constant == pytest.approx(2.49, abs=0.005)
    assert model.resistance == pytest.approx(7.29, abs=0.005)
    assert model.back_emf_damping == pytest.approx(0.851, abs=0.0005)


def test_factory_values_differ_per_model():
    assert find_servo_model("XL430-W250").initial(Register.POSITION_D_GAIN) == 4000
    assert find_servo_model("XL330-M288").initial(Register.SHUTDOWN) == 53
    assert find_servo_model("XM430-W350").initial(Register.PWM_SLOPE) is None
    assert find_servo_model("XM430-W350").initial(Register.PRESENT_POSITION) is None
