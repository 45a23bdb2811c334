"""Virtual servos make the stiffness and damping that they are asked for, class by class."""

import numpy as np
import pytest
from typer.testing import CliRunner

from hil import gain_bench
from hil.cli.main import app
from hil.compose import build_robot, servo_facts
from hil.errors import InputError
from hil.gain_bench import Motion, bench_robot, cases, fit_gains, measure_gains
from hil.interface import JointCommand, StopMode
from hil.request import RunRequest

PERIOD = 1 / 300


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(gain_bench, "CHIRP_S", 2.0)
    monkeypatch.setattr(gain_bench, "STEPS", 2)


# One of each class and mode: duty with much and little current, no current, a gain divisor of 256.
@pytest.mark.parametrize(
    ("servo", "mode", "share"),
    [
        ("XM430-W350", "position", 1.0),
        ("XM430-W350", "position", 1.5),
        ("XM430-W350", "current_position", 1.0),
        ("XM430-W350", "current", 1.0),
        ("XH540-W270", "current", 0.6),
        ("XL430-W250", "position", 1.5),
        ("XL330-M288", "position", 1.0),
        ("XC330-T288", "position", 1.5),
        ("MX-64", "current_position", 0.6),
    ],
)
def test_the_motion_shows_what_was_asked_within_ten_percent(servo, mode, share):
    facts = servo_facts(servo)
    row = measure_gains(
        servo,
        mode,
        600 * facts["position_stiffness"],
        share * facts["back_emf_damping"],
        "mujoco",
    )
    assert abs(row.stiffness_error_pct) < 5
    assert abs(row.damping_error_pct) < 6
    assert row.good


@pytest.mark.parametrize("mode", ["position", "current_position", "current"])
def test_driver_and_bytes_make_them_too(mode):
    row = measure_gains("XM430-W350", mode, 14.0, 0.86, "bus")
    assert row.good


def test_a_damping_that_a_servo_cannot_have_is_refused():
    with pytest.raises(InputError, match=r"left_hip_yaw: XM430-W350 cannot have damping 0\.4"):
        measure_gains("XM430-W350", "position", 14.0, 0.4, "mujoco")


def test_modes_that_a_servo_lacks_are_left_out():
    assert {mode for _, mode, *_ in cases(["XL430-W250"])} == {"position"}
    assert len({mode for _, mode, *_ in cases(["XM540-W270"])}) == 3


def test_the_bench_robot_hides_nothing():
    description = bench_robot("XL330-M288", "position", 0.9, 0.05)
    assert description.plant.draws is None
    assert description.supply.voltage == 5.0


# The experiment itself: a joint of known stiffness, damping and dry friction, late goals.
def test_the_fit_finds_the_gains_of_a_known_joint():
    inertia, stiffness, damping, friction, delay, fine = 0.02, 14.0, 0.6, 0.05, 0.004, 20
    goal, goal_velocity = gain_bench.excitation()
    q = w = 0.0
    position, velocity = np.empty(goal.size), np.empty(goal.size)
    for step in range(goal.size * fine):
        tick, late = step // fine, max(0, int((step * PERIOD / fine - delay) / PERIOD))
        if step % fine == 0:
            position[tick], velocity[tick] = q, w
        torque = stiffness * (goal[late] - q) + damping * (goal_velocity[late] - w)
        w += (torque - friction * np.tanh(w / 1e-3)) / inertia * PERIOD / fine
        q += w * PERIOD / fine
    motion = Motion(goal, goal_velocity, position, velocity, stiffness, damping)
    found = fit_gains(motion, inertia, PERIOD)
    assert found[0] == pytest.approx(stiffness, rel=0.02)
    assert found[1] == pytest.approx(damping, rel=0.02)


def test_the_command_prints_draws_and_judges(tmp_path, monkeypatch):
    monkeypatch.setattr(gain_bench, "CHIRP_S", 1.0)
    monkeypatch.setattr(gain_bench, "STEPS", 1)
    figure = tmp_path / "gains.png"
    result = CliRunner().invoke(app, ["gains", "XL430-W250", "--figure", str(figure)])
    assert result.exit_code in (0, 1)
    assert "XL430-W250" in result.stdout
    assert figure.stat().st_size > 5000
    unknown = CliRunner().invoke(app, ["gains", "XL999"])
    assert unknown.exit_code == 2


# A soft stop holds goals; a servo in current mode that held its goal would run away.
@pytest.mark.parametrize("backend", ["mujoco", "bus"])
def test_a_soft_stop_takes_the_current_from_servos_in_current_mode(backend):
    description = bench_robot("XM430-W350", "current", 14.0, 0.5)
    session = build_robot(RunRequest.checked(backend=backend, rate_hz=300), description)
    robot, servos = session.backend, session.world.servos
    robot.open()
    robot.read()
    robot.arm()
    command = JointCommand.zeros(12)
    command.torque[:] = 0.3
    for tick in range(3):
        robot.clock.sleep_until_ns(robot.clock.now_ns() + 3_333_333 * (tick + 1))
        robot.read()
        robot.write(command)
    robot.clock.sleep_until_ns(robot.clock.now_ns() + 3_333_333)
    assert min(firmware.goal_current for firmware in servos.firmware) > 20
    assert robot.stop(StopMode.SOFT)
    robot.clock.sleep_until_ns(robot.clock.now_ns() + 3_333_333)
    assert [firmware.goal_current for firmware in servos.firmware] == [0] * 12
    session.close()
