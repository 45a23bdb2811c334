"""`stride check` on a sound robot, and on every robot that was put together wrongly."""

import json
import zipfile

import pytest

from drivers.dynamixel.control_table import HardwareError, Register
from drivers.dynamixel.servo_models import find_servo_model
from hil.robot_files import load_robot


def findings(bench, *arguments, **ports):
    """Exit code and the sentences of `check --json`, problems only."""
    file = getattr(bench, "file", "minibiped")
    result = bench.stride("check", file, *bench.ports(**ports), "--json", *arguments)
    rows = json.loads(result.stdout)["findings"]
    return result.exit_code, [
        f"{row['where']}: {row['what']}: {row['advice']}"
        for row in rows
        if row["severity"] == "problem"
    ]


def test_a_sound_robot_has_no_problem(bench):
    result = bench.stride("check", *bench.ports())
    assert result.exit_code == 0, result.output
    assert "questions, no problem" in result.stdout
    assert "the robot file names none" in result.stdout


def test_checking_changes_nothing(bench):
    before = {joint: bytes(bench.registers(joint).memory[:120]) for joint in bench.robot.servos}
    bench.stride("check", *bench.ports())
    assert before == {
        joint: bytes(bench.registers(joint).memory[:120]) for joint in bench.robot.servos
    }


def test_swapped_legs_are_named(bench):
    code, said = findings(bench, left_leg="right_leg", right_leg="left_leg")
    assert code == 1
    assert len(said) == 2
    assert "answers as right_leg: ids 11, 12, 13, 14, 15, 16" in said[0]
    assert "the ports of left_leg and right_leg are swapped" in said[0]


def test_swapped_boards_are_named(bench):
    _, said = findings(bench, left_foot="imu", imu="left_foot")
    assert any("left_foot" in one and "sends frames of an imu board" in one for one in said)
    assert any("board imu" in one and "sends frames of a foot board" in one for one in said)


def test_a_wrong_model_is_named(bench):
    bench.robot.inject("servo:left_knee:wrong_model=1060")
    code, said = findings(bench)
    assert code == 1
    assert said == [
        "left_knee (left_leg id 4): is XL430-W250, the robot file says XM430-W350: put the right "
        "servo there, or mend the robot file"
    ]


def wrong_id(servo):
    servo.registers[Register.ID] = 9
    servo.id = 9


def wrong_baud(servo):
    servo.registers[Register.BAUD_RATE] = 1
    servo.baud_code = 1


@pytest.mark.parametrize(
    ("spoil", "sentences"),
    [
        (
            wrong_id,
            ["bus left_leg: id 9 answers and no joint", "left_knee (left_leg id 4): does not ans"],
        ),
        (
            wrong_baud,
            ["left_knee (left_leg id 4): answers at 57600 baud, not at the bus's 4000000"],
        ),
    ],
)
def test_a_servo_that_is_not_where_it_should_be(bench, spoil, sentences):
    spoil(bench.servo("left_knee"))
    code, said = findings(bench)
    assert code == 1
    assert [one[: len(text)] for one, text in zip(said, sentences, strict=True)] == sentences


WRONG_REGISTERS = {
    "left_hip_yaw": (Register.RETURN_DELAY_TIME, 250, "Return Delay Time is 250, must be 0"),
    "left_hip_roll": (Register.DRIVE_MODE, 1, "Drive Mode is 1, must be 0"),
    "left_hip_pitch": (Register.OPERATING_MODE, 4, "Operating Mode is 4, must be 3"),
    "left_knee": (Register.HOMING_OFFSET, 100, "Homing Offset is 100, must be 0"),
    "right_hip_yaw": (Register.SHUTDOWN, 0, "Shutdown is 0, must be 20"),
    "right_hip_roll": (Register.MAX_POSITION_LIMIT, 4000, "Max Position Limit is 4000, must be"),
    "right_hip_pitch": (Register.STARTUP_CONFIGURATION, 1, "Startup Configuration is 1, must be"),
    "right_knee": (Register.TORQUE_ENABLE, 1, "torque is on"),
}


def test_wrong_registers_are_named_with_both_values_all_at_once(bench):
    for joint, (register, value, _) in WRONG_REGISTERS.items():
        bench.registers(joint)[register] = value
    code, said = findings(bench)
    assert code == 1
    assert [one.split(" ")[0] for one in said] == list(WRONG_REGISTERS)
    for one, (_, _, sentence) in zip(said, WRONG_REGISTERS.values(), strict=True):
        assert f": {sentence}" in one


FAULTS = {
    "servo:left_hip_yaw:undervoltage=17": "has 17.0 V, XM430-W350 takes 10.0 to 14.8 V",
    "servo:left_hip_roll:undervoltage=9": "has 9.0 V, XM430-W350 takes 10.0 to 14.8 V",
    "servo:left_hip_pitch:overheat=70": "is 70 °C warm, its limit is 80 °C",
    "servo:left_knee:alert=overload": "hardware error: overload",
    "servo:right_hip_yaw:old_firmware=40": "has firmware 40, the other XM430-W350 have 48",
    "servo:right_hip_roll:old_firmware=37": "without the bus watchdog that stops it",
    "board:left_foot:open_cell=rear_left": "cell rear_left is",
    "board:right_foot:slow=2": "sends 300 frames a second, the robot file says 600",
    "board:imu:stale": "sends nothing",
}


def test_sick_parts_are_named_all_at_once(bench):
    for fault in FAULTS:
        bench.robot.inject(fault)
    code, said = findings(bench)
    assert code == 1
    for fault, sentence in FAULTS.items():
        part = fault.split(":")[1]
        assert any(part in one and sentence in one for one in said), (fault, said)


def test_overvoltage_of_everything_says_what_to_do(make_bench):
    code, said = findings(make_bench("supply.voltage=16.8"))
    assert code == 1
    assert sum("overvoltage destroys servos: cut the power now" in one for one in said) == 12


def test_a_rate_that_a_bus_cannot_carry(bench):
    code, said = findings(bench, "--rate", "2000")
    assert code == 1
    assert "bus left_leg cannot carry 2000 Hz" in said[0]


def test_a_joint_beyond_its_range_is_named(bench):
    bench.robot.inject("servo:left_knee:drift=300")
    bench.robot.clock.sleep_until_ns(bench.robot.clock.now_ns() + 1_000_000_000)
    _, said = findings(bench)
    assert any("left_knee: stands at" in one and "its range is 1.1° to 131.8°" in one
               for one in said)  # fmt: skip


def test_a_robot_with_one_leg_can_be_checked(bench):
    _, said = findings(bench, right_leg=None, right_foot=None, imu=None)
    assert all("no port is given" in one for one in said)
    assert len(said) == 3


def test_a_calibrated_robot_has_nothing_to_remark(calibrated):
    bench = calibrated()
    result = bench.stride("check", bench.file, *bench.ports(), "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["findings"] == []


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"imu": {"mounting": [0.0, 1.0, 0.0, 0.0]}},
            "board imu: says that the torso is tilted by 180°: hang the robot upright; if it is, "
            "the IMU's mounting in the calibration is wrong",
        ),
        ({"robot": "other"}, "calibration: "),
        ({"joint_offsets": {"left_hip_roll": 1.0}}, "left_hip_roll: stands at -57."),
    ],
)
def test_a_calibration_that_cannot_be_is_refused(calibrated, changes, sentence):
    code, said = findings(calibrated(**changes))
    assert code == 1
    assert len(said) == 1
    assert said[0].startswith(sentence)


def test_a_calibration_that_is_not_there_or_not_whole_is_refused(calibrated):
    record = {"date": "2026-01-02", "method": "by hand"}
    bench = calibrated(measured={"imu": record, "joints": {**record, "parts": {}}})
    assert findings(bench)[1][0].startswith("calibration: not measured yet: joint left_hip_yaw")
    bench.path.unlink()
    assert findings(bench) == (
        1,
        ["calibration: there is no file mine.yaml yet: stride calibrate joints, imu, feet, lean"],
    )


def test_values_with_which_nobody_leant_are_remarked(calibrated):
    record = {"date": "2026-01-02", "method": "by hand"}
    parts = dict.fromkeys(load_robot("minibiped").joint_names, "XM430-W350")
    bench = calibrated(
        measured={"imu": record, "joints": {**record, "parts": parts}},
        joint_ranges={"left_hip_yaw": [-0.3, 0.8]},
    )
    result = bench.stride("check", bench.file, *bench.ports(), "--json")
    assert result.exit_code == 0, result.output
    said = [row["what"] for row in json.loads(result.stdout)["findings"]]
    assert said[0] == "nobody has leant the robot with these values"
    assert said[1].startswith("is kept within -17.2° to 45.8° by its calibration")


def test_a_slow_adapter_is_refused(bench, monkeypatch):
    monkeypatch.setattr(
        "drivers.commissioning.inspection.latency_timer_ms",
        lambda url: 16 if url == bench.url("left_leg") else None,
    )
    code, said = findings(bench)
    assert code == 1
    assert len(said) == 1
    assert "the adapter's latency timer is 16 ms, the robot file counts on 1 ms" in said[0]


def test_after_a_fall_legs_that_hang_differently_are_named(bench):
    assert findings(bench, "--after-fall") == (0, [])
    bench.robot.inject("servo:left_hip_pitch:drift=8")
    code, said = findings(bench, "--after-fall")
    assert code == 1
    assert len(said) == 1
    assert said[0].startswith("hip_pitch: hangs at")
    assert "a horn has slipped" in said[0]


def test_before_a_walk_legs_may_hang_as_they_like(bench):
    bench.robot.inject("servo:left_hip_pitch:drift=8")
    assert findings(bench) == (0, [])


def test_the_watchdog_of_a_joint_is_measured_and_torque_is_off_again(bench):
    result = bench.stride("check", *bench.ports(), "--watchdog", "left_knee", "--yes", "--json")
    assert result.exit_code == 0, result.output
    trip = json.loads(result.stdout)
    assert trip["longest_quiet_ms"] < trip["shortest_trip_ms"]
    assert trip["shortest_trip_ms"] == pytest.approx(40.0, abs=3.0)
    assert trip["torque_stays"]
    registers = bench.registers("left_knee")
    assert (registers[Register.TORQUE_ENABLE], registers[Register.BUS_WATCHDOG]) == (0, 0)


def test_the_watchdog_is_not_measured_unasked(bench):
    result = bench.stride("check", *bench.ports(), "--watchdog", "left_knee")
    assert result.exit_code == 2
    assert "--yes says yes" in result.stderr
    assert not bench.registers("left_knee")[Register.TORQUE_ENABLE]


def test_a_bundle_holds_what_a_report_needs(bench, tmp_path):
    path = tmp_path / "report.zip"
    bench.registers("left_knee")[Register.SHUTDOWN] = HardwareError.OVERLOAD
    bench.stride("check", *bench.ports(), "--bundle", path)
    with zipfile.ZipFile(path) as bundle:
        content = {
            name: json.loads(bundle.read(name))
            for name in bundle.namelist()
            if name.endswith(".json")
        }
        assert "minibiped.yaml" in bundle.namelist()
    assert content["registers.json"]["left_knee"]["Shutdown"] == 32
    model = find_servo_model("XM430-W350")
    assert content["registers.json"]["right_knee"]["Model Number"] == model.number
    assert any("Shutdown is 32" in row["what"] for row in content["check.json"])
    assert "stridebridge" in content["versions.json"]


@pytest.mark.parametrize("command", ["check", "monitor", "setup"])
def test_without_ports_the_error_says_how_to_give_them(bench, command):
    result = bench.stride(command, "minibiped")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "--port left_leg=DEVICE" in result.stderr
    assert "stride emulate --json > ports.json" in result.stderr


@pytest.mark.parametrize(
    ("option", "says"),
    [("left_arm=/dev/x", "valid: left_leg, right_leg"), ("left_leg", "NAME=DEVICE")],
)
def test_a_wrong_port_option_names_the_choices(bench, option, says):
    result = bench.stride("check", "--port", option)
    assert result.exit_code == 2
    assert says in result.stderr


def test_ports_that_cannot_be_opened_are_bad_input(bench):
    result = bench.stride("check", "--port", "left_leg=/dev/nothing")
    assert result.exit_code == 2
    assert "/dev/nothing" in result.stderr
