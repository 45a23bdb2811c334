"""`stride setup`: what changes is shown, asked for, written and read back."""

import json

import pytest

from drivers.dynamixel.control_table import Register


def spoil(servo):
    """As a servo leaves the factory, but for its id and speed."""
    registers = servo.registers
    registers[Register.RETURN_DELAY_TIME] = 250
    registers[Register.HOMING_OFFSET] = 77
    registers[Register.MIN_POSITION_LIMIT] = 1000
    registers[Register.SHUTDOWN] = 1
    servo.return_delay = 250


def become(servo, servo_id, baud_code):
    servo.registers[Register.ID] = servo.id = servo_id
    servo.registers[Register.BAUD_RATE] = servo.baud_code = baud_code


def test_what_is_wrong_is_written_and_read_back(bench):
    spoil(bench.servo("left_knee"))
    result = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 0, result.output
    for words in ("Return Delay Time", "250", "Homing Offset", "77", "Shutdown"):
        assert words in result.stdout
    assert "left_knee: written and read back" in result.stdout
    assert "right_knee: written" not in result.stdout
    registers = bench.registers("left_knee")
    assert registers[Register.RETURN_DELAY_TIME] == 0
    assert registers[Register.HOMING_OFFSET] == 0
    assert registers[Register.MIN_POSITION_LIMIT] == 0
    assert registers[Register.SHUTDOWN] == 20
    again = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert "What will change" not in again.stdout


def test_after_setup_a_check_finds_nothing(bench):
    for joint in ("left_knee", "right_ankle_roll"):
        spoil(bench.servo(joint))
    assert bench.stride("check", *bench.ports()).exit_code == 1
    bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert bench.stride("check", *bench.ports()).exit_code == 0


@pytest.mark.parametrize(
    ("more", "code"), [(["--dry-run"], 0), ([], 2)], ids=["dry run", "nobody to ask"]
)
def test_nothing_is_written_unasked(bench, more, code):
    spoil(bench.servo("left_knee"))
    result = bench.stride("setup", "minibiped", *bench.ports(), *more)
    assert result.exit_code == code
    assert bench.registers("left_knee")[Register.RETURN_DELAY_TIME] == 250


def test_a_servo_with_torque_on_is_not_touched(bench):
    spoil(bench.servo("left_knee"))
    bench.registers("left_knee")[Register.TORQUE_ENABLE] = 1
    result = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 1
    assert "left_knee (left_leg id 4): torque is on: stride relax first" in result.stdout
    assert bench.registers("left_knee")[Register.RETURN_DELAY_TIME] == 250


def test_a_wrong_model_is_not_touched(bench):
    bench.robot.inject("servo:left_knee:wrong_model=1060")
    result = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 1
    assert "is XL430-W250, the robot file says XM430-W350" in result.stdout


def test_absent_servos_are_left_out(bench):
    bench.robot.inject("servo:left_knee:silent")
    result = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 0
    assert "do not answer, left out: left_knee" in result.stdout


def test_a_new_servo_alone_gets_id_and_speed(bench):
    bench.silence_all_but("left_knee")
    become(bench.servo("left_knee"), 1, 1)
    spoil(bench.servo("left_knee"))
    port = bench.url("left_leg")
    words = ("setup", "minibiped", "--servo", port, "--joint", "right_knee", "--yes", "--json")
    result = bench.stride(*words)
    assert result.exit_code == 0, result.output
    registers = bench.registers("left_knee")
    assert (registers[Register.ID], registers[Register.BAUD_RATE]) == (14, 6)
    assert registers[Register.RETURN_DELAY_TIME] == 0
    (plan,) = json.loads(result.stdout)
    assert (plan["id"], plan["baud"]) == (1, 57_600)


def test_two_servos_cannot_be_told_apart(bench):
    bench.silence_all_but("left_knee", "left_hip_roll")
    port = bench.url("left_leg")
    result = bench.stride("setup", "minibiped", "--servo", port, "--joint", "left_knee", "--yes")
    assert result.exit_code == 2
    assert "id 2 at 4000000 baud, id 4 at 4000000 baud" in result.stderr


def test_servos_at_another_speed_are_brought_to_that_of_their_bus(bench):
    for joint in ("left_knee", "left_ankle_roll"):
        servo = bench.servo(joint)
        become(servo, servo.id, 3)
    result = bench.stride("setup", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 0, result.output
    assert "1000000 to 4000000 baud" in result.stdout
    assert bench.registers("left_knee")[Register.BAUD_RATE] == 6
    assert bench.registers("left_ankle_roll")[Register.BAUD_RATE] == 6


def test_a_swapped_servo_takes_its_place(bench):
    become(bench.servo("left_knee"), 1, 1)
    words = ("setup", "minibiped", *bench.ports(), "--replace", "left_knee", "--yes")
    result = bench.stride(*words)
    assert result.exit_code == 0, result.output
    registers = bench.registers("left_knee")
    assert (registers[Register.ID], registers[Register.BAUD_RATE]) == (4, 6)
    assert bench.registers("left_hip_yaw")[Register.ID] == 1
    assert bench.stride("check", *bench.ports()).exit_code == 0


def test_a_servo_that_answers_needs_no_replacement(bench):
    result = bench.stride("setup", "minibiped", *bench.ports(), "--replace", "left_knee")
    assert result.exit_code == 2
    assert "there is nothing to replace" in result.stderr


@pytest.mark.parametrize(
    "words",
    [
        ["--servo", "/dev/x"],
        ["--servo", "/dev/x", "--joint", "left_knee", "--replace", "left_knee"],
        ["--replace", "left_knee", "--joint", "left_knee"],
        ["--joint", "left_elbow"],
        ["--replace", "left_elbow"],
    ],
    ids=" ".join,
)
def test_contradictions_are_bad_input(bench, words):
    result = bench.stride("setup", "minibiped", *bench.ports(), *words)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
