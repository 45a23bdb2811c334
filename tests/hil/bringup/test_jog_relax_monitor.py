"""Moving one servo, letting all go, and looking on."""

import csv
import json

import pytest

from drivers.dynamixel.control_table import Register
from hil.bringup.consent import Declined, require_consent
from hil.bringup.facts import JogSample
from hil.bringup.jog import JogRecord, step_figures

JOINT = "left_hip_yaw"


def jog(bench, tmp_path, *more):
    return bench.stride(
        *("jog", bench.url("left_leg"), "--id", 1, "--baud", 4_000_000, "--no-sharp"),
        *("--degrees", 3, "--out", tmp_path / "run", *more),
    )


def test_a_jog_moves_both_ways_and_ends_limp(bench, tmp_path):
    before = bytes(bench.registers(JOINT).memory[100:116])
    result = jog(bench, tmp_path, "--yes")
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines()[-2:] == ["torque off, read back", str(tmp_path / "run")]
    with (tmp_path / "run" / "samples.csv").open() as file:
        rows = list(csv.DictReader(file))
    position = [float(row["position_deg"]) for row in rows]
    assert max(position) > 2.0
    assert min(position) < -2.0
    assert max(abs(float(row["duty_pct"])) for row in rows) <= 30.2
    assert max(abs(float(row["velocity_dps"])) for row in rows) < 40.0
    registers = bench.registers(JOINT)
    assert (registers[Register.TORQUE_ENABLE], registers[Register.BUS_WATCHDOG]) == (0, 0)
    assert bytes(registers.memory[100:102]) == before[:2]
    assert bytes(registers.memory[108:116]) == before[8:16]
    assert (tmp_path / "run" / "picture.png").stat().st_size > 10_000
    meta = json.loads((tmp_path / "run" / "meta.json").read_text())
    assert (meta["servo"], meta["id"], meta["baud"]) == ("XM430-W350", 1, 4_000_000)


def test_a_jog_asks_first(bench, tmp_path):
    result = jog(bench, tmp_path)
    assert result.exit_code == 2
    assert "will switch torque on and move 3°" in result.stderr
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("register", "value", "says"),
    [
        (Register.TORQUE_ENABLE, 1, "torque is on already"),
        (Register.OPERATING_MODE, 1, "is in velocity mode"),
        (Register.MAX_POSITION_LIMIT, 2050, "turn it by hand"),
        (Register.DRIVE_MODE, 4, "its profile is time-based"),
    ],
)
def test_a_servo_that_cannot_be_moved_is_left_alone(bench, tmp_path, register, value, says):
    bench.registers(JOINT)[register] = value
    before = bytes(bench.registers(JOINT).memory[:120])
    result = jog(bench, tmp_path, "--yes")
    assert result.exit_code == 2
    assert says in result.stderr
    assert bytes(bench.registers(JOINT).memory[:120]) == before


def test_a_servo_that_fails_on_the_way_is_let_go(bench, tmp_path):
    bench.robot.inject("servo:left_hip_yaw:alert=overload@1")
    result = jog(bench, tmp_path, "--yes")
    assert result.exit_code == 1
    assert "hardware error: overload" in result.stderr
    assert f"recorded until then: {tmp_path / 'run'}" in result.stderr
    assert (tmp_path / "run" / "samples.csv").read_text().count("\n") > 10
    assert not bench.registers(JOINT)[Register.TORQUE_ENABLE]


def test_nobody_there_says_who_to_ask(bench, tmp_path):
    result = bench.stride("jog", bench.url("left_leg"), "--id", 77, "--baud", 4_000_000, "--yes")
    assert result.exit_code == 1
    assert "no servo with id 77 answers at 4000000 baud; who does: stride scan" in result.stderr


def test_step_figures_are_those_of_the_response():
    def sample(time_s, goal, position):
        return JogSample(time_s, goal, position, goal, 0.0, 0.0, None, 12.0, 30)

    # A dead time of 20 ms, then 1° in 10 ms up to 6°, back at 4.5°.
    path = [0.0, 0.0, *(float(n) for n in range(1, 7)), *[4.5] * 10]
    samples = [sample(0.0, 0.0, 0.0)]
    samples += [sample(1.0 + 0.01 * n, 5.0, place) for n, place in enumerate(path)]
    (step,) = step_figures(JogRecord(samples, 1))
    assert (step.from_deg, step.to_deg) == (0.0, 5.0)
    assert step.dead_time_ms == pytest.approx(20.0)
    assert step.rise_time_ms == pytest.approx(40.0)
    assert step.overshoot_pct == pytest.approx(20.0)
    assert step.rest_error_deg == pytest.approx(0.5)
    assert step_figures(JogRecord(samples, None)) == []


def switch_on(bench):
    for servo in bench.robot.servos.values():
        servo.write(Register.TORQUE_ENABLE.address, b"\x01")


def torques(bench):
    return {joint: servo.registers[Register.TORQUE_ENABLE]
            for joint, servo in bench.robot.servos.items()}  # fmt: skip


def test_relax_reaches_every_servo_of_a_robot(bench):
    switch_on(bench)
    result = bench.stride("relax", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 0, result.output
    assert not any(torques(bench).values())
    assert result.stdout.count("torque off, read back") == 12


def test_relax_reaches_a_servo_at_another_speed(bench):
    switch_on(bench)
    servo = bench.servo("left_knee")
    servo.registers[Register.BAUD_RATE] = servo.baud_code = 3
    result = bench.stride("relax", bench.url("left_leg"), "--yes")
    assert result.exit_code == 0, result.output
    assert "id 4 at 1000000 baud: torque off, read back" in result.stdout
    off = {joint for joint, torque in torques(bench).items() if not torque}
    assert off == {joint for joint in bench.robot.servos if joint.startswith("left")}


def test_relax_says_which_bus_it_did_not_reach(bench):
    switch_on(bench)
    words = ("relax", "minibiped", *bench.ports(right_leg=None), "--yes", "--json")
    result = bench.stride(*words)
    assert result.exit_code == 1
    assert "right_leg was not reached: no port is given" in result.stderr
    assert [servo["off"] for servo in json.loads(result.stdout)["servos"]] == [True] * 6
    off = {joint for joint, torque in torques(bench).items() if not torque}
    assert off == {joint for joint in bench.robot.servos if joint.startswith("left")}


def test_a_lost_bus_keeps_nobody_from_relaxing_the_other(bench):
    switch_on(bench)
    bench.robot.inject("bus:left_leg:disconnect@0.001")
    result = bench.stride("relax", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 1
    assert "left_leg was not reached: port left_leg" in result.stderr
    off = {joint for joint, torque in torques(bench).items() if not torque}
    assert off >= {joint for joint in bench.robot.servos if joint.startswith("right")}


def test_relax_asks_first(bench):
    switch_on(bench)
    assert bench.stride("relax", "minibiped", *bench.ports()).exit_code == 2
    assert all(torques(bench).values())


def test_relax_of_nobody_is_exit_1(bench):
    bench.silence_all_but()
    result = bench.stride("relax", "minibiped", *bench.ports(), "--yes")
    assert result.exit_code == 1
    assert "no servo answers" in result.stderr


def test_the_monitor_tells_everything_and_touches_nothing(bench):
    bench.servo("left_hip_yaw").write(Register.TORQUE_ENABLE.address, b"\x01")
    bench.robot.inject("servo:right_knee:silent")
    bench.robot.inject("servo:left_knee:overheat=66")
    result = bench.stride("monitor", *bench.ports(), "--json", "--duration", 0.5)
    assert result.exit_code == 0, result.output
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    assert len(lines) >= 2
    joints = {joint["joint"]: joint for joint in lines[-1]["joints"]}
    assert joints["left_knee"]["temperature_c"] == 66
    counts = bench.registers("left_knee")[Register.PRESENT_POSITION]  # as it was read last
    assert joints["left_knee"]["position_deg"] == pytest.approx(
        (counts - 2048) * 360 / 4096, abs=0.01
    )
    assert [name for name, joint in joints.items() if joint["torque_on"]] == ["left_hip_yaw"]
    assert joints["right_knee"]["position_deg"] is None
    boards = {board["board"]: board for board in lines[-1]["boards"]}
    assert set(boards["left_foot"]["values"]) == {
        "front_left", "front_right", "rear_left", "rear_right",
    }  # fmt: skip
    assert abs(boards["imu"]["values"]["pitch_deg"]) < 3.0
    assert [joint for joint, torque in torques(bench).items() if torque] == ["left_hip_yaw"]


def test_a_calibrated_monitor_speaks_newton(calibrated):
    bench = calibrated()
    words = ("monitor", bench.file, *bench.ports(), "--json", "--duration", 0.1)
    boards = json.loads(bench.stride(*words).stdout.splitlines()[-1])["boards"]
    feet = [board for board in boards if board["kind"] == "foot"]
    assert [board["unit"] for board in feet] == ["N", "N"]
    assert 0 <= sum(sum(board["values"].values()) for board in feet) < 40  # at most its weight


def test_the_monitor_shows_absent_joints_as_absent(bench):
    bench.robot.inject("servo:right_knee:silent")
    result = bench.stride("monitor", *bench.ports(), "--duration", 0.1)
    line = next(line for line in result.stdout.splitlines() if "right_knee" in line)
    assert "absent" in line


@pytest.mark.parametrize(("answer", "agreed"), [("y\n", True), ("yes\n", True), ("\n", False)])
def test_consent_is_a_clear_yes(monkeypatch, answer, agreed):
    class Terminal:
        def isatty(self):
            return True

        def readline(self):
            return answer

    monkeypatch.setattr("sys.stdin", Terminal())
    if agreed:
        require_consent("Sure?", yes=False)
    else:
        with pytest.raises(Declined, match="nothing was done"):
            require_consent("Sure?", yes=False)
