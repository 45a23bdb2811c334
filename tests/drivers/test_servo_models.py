"""The servo models against ROBOTIS' own files and published figures, and models made of data."""

from pathlib import Path

import dynamixel_easy_sdk
import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel import servo_models
from drivers.dynamixel.audit import PWM_SLOPE, ExpectedServo, audit_bus
from drivers.dynamixel.client import ServoClient
from drivers.dynamixel.control_table import OperatingMode, Register
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.dynamixel.group_access import GroupAccess
from drivers.dynamixel.servo_models import SERVO_MODELS, find_servo_model, read_models
from hil.errors import DescriptionError
from hil.robot_files import load_robot

VENDOR = Path(dynamixel_easy_sdk.__file__).parent / "control_table"
WANTED = (
    "XM430-W210", "XM430-W350", "XM540-W150", "XM540-W270",
    "XH430-W210", "XH430-W350", "XH430-V210", "XH430-V350",
    "XH540-W150", "XH540-W270", "XH540-V150", "XH540-V270",
    "XL430-W250", "XL330-M077", "XL330-M288", "XC330-T181", "XC330-T288", "XC330-M181",
    "XC330-M288", "XC430-W150", "XC430-W240", "2XL430-W250", "2XC430-W250",
    "MX-28", "MX-64", "MX-106",
)  # fmt: skip


def vendor_file(model, suffix=""):
    return VENDOR / f"{model.lower().replace('-', '_')}{suffix}.model"


def vendor_rows(path):
    lines = path.read_text().split("[control table]")[1].splitlines()[2:]
    return [line.split("\t")[:3] for line in lines if "\t" in line]


def test_every_wanted_model_is_known_by_the_vendors_number():
    numbers = dict(
        reversed(line.split("\t"))
        for line in (VENDOR / "dynamixel.model").read_text().splitlines()[1:]
    )
    assert set(WANTED) <= set(SERVO_MODELS)
    for name in WANTED:
        assert SERVO_MODELS[name].number == int(numbers[vendor_file(name).name])


@pytest.mark.parametrize("name", WANTED)
def test_a_model_has_the_registers_of_the_vendors_file(name):
    theirs = {row[2].upper().replace(" ", "_") for row in vendor_rows(vendor_file(name))}
    ours = {register.name for register in SERVO_MODELS[name].registers}
    for name_of_one in ("CURRENT_LIMIT", "GOAL_CURRENT", "PWM_SLOPE"):
        assert (name_of_one in theirs) == (name_of_one in ours)
    assert ("PRESENT_LOAD" in theirs) == (SERVO_MODELS[name].current_unit is None)


@pytest.mark.parametrize("name", WANTED)
def test_indirect_cells_move_with_the_firmware_as_the_vendors_files_say(name):
    def first_cells(path):
        rows = {row[2]: int(row[0]) for row in vendor_rows(path)}
        return rows["Indirect Address 1"], rows["Indirect Data 1"]

    model = SERVO_MODELS[name]
    old, new = model.indirect_for(48)[0], model.indirect_for(52)[0]
    assert (old.address, old.data) == first_cells(vendor_file(name))
    later = vendor_file(name, "_fw52")
    assert (new.address, new.data) == first_cells(later if later.is_file() else vendor_file(name))


# V/w0, T/w0 and k_t = T/I of the e-manual's figures, worked out by hand.
@pytest.mark.parametrize(
    ("name", "back_emf", "damping", "least_constant"),
    [
        ("XM430-W350", 2.49, 0.851, 1.78),
        ("XM430-W210", 1.49, 0.372, 1.29),
        ("XL330-M077", 0.125, 0.0054, 0.125),
        ("XC330-T288", 1.63, 0.135, 0.863),
        ("XH540-W270", 2.94, 2.42, 1.98),
        ("MX-64", 1.82, 0.909, 1.40),
    ],
)
def test_motor_constants_and_how_far_they_are_uncertain(name, back_emf, damping, least_constant):
    model = find_servo_model(name)
    assert model.torque_constant == pytest.approx(back_emf, rel=0.005)
    assert model.back_emf_damping == pytest.approx(damping, rel=0.01)
    assert model.torque_constant_range.low == pytest.approx(least_constant, rel=0.01)


@pytest.mark.parametrize("model", SERVO_MODELS.values(), ids=lambda model: model.name)
def test_every_nominal_constant_lies_in_its_range(model):
    for value, (low, high) in (
        (model.torque_constant, model.torque_constant_range),
        (model.resistance, model.resistance_range),
        (model.back_emf_damping, model.damping_range),
        (model.stall_torque / model.voltage, model.torque_per_volt_range),
    ):
        assert low * (1 - 1e-9) <= value <= high * (1 + 1e-9)
        assert high < 3 * low


def test_what_others_identified_widens_a_range():
    assert find_servo_model("XL330-M288").resistance_range.low == 2.81
    assert find_servo_model("XH540-W150").torque_constant_range.high == 1.67


def test_both_shafts_of_a_double_servo_have_an_id_and_one_board_no_fast_reads():
    for name in ("2XL430-W250", "2XC430-W250"):
        assert find_servo_model(name).axes == 2
        assert not find_servo_model(name).supports_fast_read(60)


OWN = """
sources: {SOURCES}
defaults: {axes: 1, resolution: 4096, voltage: 12.0, input_voltage: [10.0, 14.8],
  gear_ratio: 200.0, position_gains: [500, 0, 0], velocity_gains: [100, 1000],
  current_unit: 1.0e-3, current_limit: 1500, current_sensing: motor, velocity_limit: 300,
  voltage_limits: [95, 160], temperature_limit: 75, shutdown: 52, highest_baud: 4000000,
  modes: [0, 3, 5], gain_divisor: 128, current_divisor: 128, fast_read_firmware: 45,
  indirect: [{firmware: 0, cells: [{address: 168, data: 224, count: 20}]}],
  watchdog_firmware: 38, startup_firmware: null, pwm_slope: null, pwm_slope_unit: null}
models:
  ZZ999-T100:
    number: 9990
    datasheet: [{voltage: 12.0, torque: 3.0, current: 2.0, speed: 60}]
"""


def write_table(folder, leave_out=()):
    known = servo_models.TABLES / "x540.yaml"
    sources = [key for key in read_models(known)["XM540-W270"].sources if key not in leave_out]
    path = folder / "own.yaml"
    path.write_text(OWN.replace("SOURCES", ", ".join(f"{key}: assumed" for key in sources)))
    return path


def test_a_new_model_is_data_only(tmp_path, monkeypatch):
    model = read_models(write_table(tmp_path))["ZZ999-T100"]
    monkeypatch.setitem(SERVO_MODELS, model.name, model)
    description = load_robot("minibiped")
    joints = [joint.model_copy(update={"servo": model.name, "stiffness": 10.0, "damping": 0.5})
              for joint in description.joints]  # fmt: skip
    description = description.model_copy(update={"joints": tuple(joints)})
    calibration = RobotCalibration.model_validate(
        {"robot": "minibiped", "provenance": {"date": "2026-01-01", "method": "ideal"}}
    )
    motors = GainMapping(description, calibration).motor_parameters()
    assert motors.back_emf_damping()[0] == pytest.approx(3.0 / 6.283, rel=1e-3)


def test_a_value_without_a_source_is_refused(tmp_path):
    with pytest.raises(DescriptionError, match=r"own.yaml: sources.gain_divisor: is missing"):
        read_models(write_table(tmp_path, leave_out=["gain_divisor"]))


def test_a_mistake_in_a_table_is_named(tmp_path):
    path = write_table(tmp_path)
    path.write_text(path.read_text().replace("resolution: 4096", "resolution: 1024"))
    with pytest.raises(DescriptionError, match=r"models.ZZ999-T100.resolution"):
        read_models(path)


# Read-back on opening ------------------------------------------------------------------------


def audit(fake_port, timing, clock, expected):
    client, group = ServoClient(fake_port, timing, clock), GroupAccess(fake_port, timing, clock)
    return audit_bus("left_leg", client, group, expected)


def servos(*names, mode=OperatingMode.POSITION):
    return [ExpectedServo(f"joint{i}", i + 1, find_servo_model(n), mode)
            for i, n in enumerate(names)]  # fmt: skip


def test_one_old_servo_makes_its_bus_fall_back_to_plain_reads(fake_port, timing, clock):
    expected = servos(*["XM430-W350"] * 6)
    assert audit(fake_port, timing, clock, expected).fast_reads
    fake_port.servos[4][Register.FIRMWARE_VERSION] = 44
    assert not audit(fake_port, timing, clock, expected).fast_reads


def test_a_servo_without_watchdog_is_a_problem(fake_port, timing, clock):
    fake_port.servos[2][Register.FIRMWARE_VERSION] = 37
    (problem,) = audit(fake_port, timing, clock, servos(*["XM430-W350"] * 6)).problems
    assert "id 2 (joint1) has firmware 37" in problem
    assert "update it to 38" in problem


def test_the_mode_of_the_robot_file_and_the_fastest_slope_are_set(fake_port, timing, clock):
    for servo in fake_port.servos.values():
        servo[Register.MODEL_NUMBER] = 1200
        servo[Register.FIRMWARE_VERSION] = 46
        servo[Register.PWM_SLOPE] = 140
    expected = servos(*["XL330-M288"] * 6, mode=OperatingMode.CURRENT)
    result = audit(fake_port, timing, clock, expected)
    assert not result.problems
    assert "bus left_leg id 1 (joint0): Operating Mode 3 -> 0" in result.changes
    assert fake_port.servos[6][Register.PWM_SLOPE] == PWM_SLOPE
