"""Identification: the fit on a servo simulated here, and the whole way on a virtual robot."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from drivers.calibration import load_calibration
from hil import identify_excitation
from hil.cli.main import app
from hil.compose import build, servo_rig
from hil.errors import BackendError, InputError, UnknownNameError
from hil.guarded_runner import ERROR_TICKS, GuardedRunner
from hil.identify import default_command, identify
from hil.identify_excitation import make_excitation
from hil.identify_fit import fit_servo
from hil.identify_load import JointLoad, joint_load
from hil.identify_record import JointRecord
from hil.interface import StopMode
from hil.request import RunRequest
from hil.robot_files import load_robot

PERIOD, FINE = 1 / 300, 16
COUNT = 2 * np.pi / 4096
ROBOT = load_robot("minibiped")
KNEE = ROBOT.joint_names.index("left_knee")
LOAD = JointLoad(
    np.linspace(-3, 3, 200), np.full(200, 0.012), 0.8 * np.sin(np.linspace(-3, 3, 200))
)
"""A pendulum of 0.8 N·m; heavy enough to tell the divisor."""


class Servo:
    """A position servo with friction on its rotor and a gap behind it, in small Euler steps."""

    k, r, divisor, armature, friction, gap, delay, voltage = (
        2.2,
        7.0,
        128,
        0.03,
        0.12,
        0.012,
        0.0027,
        12.0,
    )
    gain = 800

    def record(self, goals):
        theta = q = goals[0]
        rotor = w = 0.0
        dt, rows, goal, pending = PERIOD / FINE, [], goals[0], []
        for tick, wanted in enumerate(goals):
            duty = self.duty(goal, q)
            current = (duty * self.voltage - self.k * rotor) / self.r
            rows.append((round(q / COUNT) * COUNT, w, current))
            pending.append((tick * PERIOD + self.delay, round(wanted / COUNT) * COUNT))
            for step in range(FINE):
                time = tick * PERIOD + step * dt
                if pending and pending[0][0] <= time:
                    goal = pending.pop(0)[1]
                current = (self.duty(goal, q) * self.voltage - self.k * rotor) / self.r
                slack = theta - q
                over = slack - np.clip(slack, -self.gap / 2, self.gap / 2)
                teeth = 3000.0 * over + (2.0 * (rotor - w) if over else 0.0)
                drag = self.friction * np.tanh(rotor / 2e-3)
                rotor += (self.k * current - drag - teeth) / self.armature * dt
                w += (teeth - 0.8 * np.sin(q)) / 0.012 * dt
                theta, q = theta + rotor * dt, q + w * dt
        position, velocity, current = np.array(rows).T
        sent = np.rint(np.asarray(goals) / COUNT) * COUNT
        unit = 0.229 * 2 * np.pi / 60
        return JointRecord(
            PERIOD,
            position,
            np.rint(velocity / unit) * unit,
            np.rint(current / 0.00269) * 0.00269,
            np.full(position.size, self.voltage),
            sent,
            np.full(position.size, float(self.gain)),
        )

    def duty(self, goal, q):
        error = round((goal - q) / COUNT)
        return np.clip(self.gain / self.divisor * error / 885, -1, 1)


def excite():
    joint = ROBOT.joints[KNEE].model_copy(update={"range": (-1.0, 1.0)})
    with pytest.MonkeyPatch.context() as patch:
        shorten(patch)
        return make_excitation(joint, 0.0, 300).goal


def shorten(patch):
    """A third of the time; enough for a virtual servo."""
    patch.setattr(identify_excitation, "SWEEP_SPEED", 1.0)
    patch.setattr(identify_excitation, "SWEEPS", 1)
    patch.setattr(identify_excitation, "CHIRP_TIME", 4.0)
    patch.setattr(identify_excitation, "STEP_SIZES", (1.0, -1.0, 0.5, -0.7))


@pytest.fixture(scope="module")
def fitted():
    return fit_servo(Servo().record(excite()), LOAD, 7.3)


@pytest.mark.parametrize(
    ("name", "share"),
    [("torque_constant", 0.03), ("resistance", 0.03), ("armature", 0.08), ("friction", 0.15),
     ("backlash", 0.15), ("delay", 0.4)],
)  # fmt: skip
def test_the_fit_recovers_a_servo_and_says_how_surely(fitted, name, share):
    true = {"backlash": Servo.gap, "torque_constant": Servo.k, "resistance": Servo.r}.get(
        name, getattr(Servo, name, None)
    )
    one = getattr(fitted, name)
    assert one.value == pytest.approx(true, rel=share)
    assert abs(one.value - true) < 4 * one.deviation
    assert one.deviation < 0.5 * true


def test_the_load_tells_the_divisor(fitted):
    assert fitted.gain_divisor == 128
    assert fitted.free_divisor.value == pytest.approx(128, rel=0.08)


def test_another_divisor_is_found_against_the_data_sheet():
    servo = Servo()
    servo.divisor, servo.gain = 256, 1600
    found = fit_servo(servo.record(excite()), LOAD, 3.5)
    assert found.gain_divisor == 256
    assert found.torque_constant.value == pytest.approx(servo.k, rel=0.03)


def test_a_load_that_never_changes_sides_shows_no_backlash(fitted):
    one_sided = JointLoad(LOAD.angles, LOAD.inertias, np.full(200, 5.0))
    assert fitted.backlash.deviation < 0.002
    record = Servo().record(excite()[:3000])
    assert fit_servo(record, one_sided, 7.3).backlash.deviation == float("inf")


# Mass and geometry of minibiped's left shank and foot, from its MJCF.
def test_the_load_of_a_knee_is_a_pendulum():
    load = joint_load(ROBOT, KNEE)
    assert load.inertia(np.array([1.0]))[0] == pytest.approx(load.inertia(np.array([2.0]))[0])
    hanging = load.angles[np.argmin(np.abs(load.gravities))]
    assert hanging == pytest.approx(0.5114, abs=0.15)
    assert load.gravity(np.array([hanging + 1.0]))[0] > 0.05


def test_the_excitation_stays_inside_range_and_speed():
    joint = ROBOT.joints[KNEE]
    made = make_excitation(joint, 1.02, 300)
    assert joint.range[0] < made.goal.min() < made.goal.max() < joint.range[1]
    speed = np.abs(np.diff(made.goal)) * 300
    smooth = np.array([part != "step" and part != "rest" for part in made.part[1:]])
    assert speed[smooth].max() < 0.6 * joint.velocity_limit
    with pytest.raises(InputError, match=r"left_knee: the start pose leaves it 0\.010 rad"):
        make_excitation(joint, 0.03, 300)


# The whole way ------------------------------------------------------------------------------


@pytest.fixture
def short(monkeypatch):
    shorten(monkeypatch)


def test_a_virtual_servos_hidden_constants_are_recovered_and_kept(short, tmp_path):
    rig = servo_rig(RunRequest.checked(backend="bus", seed=5), "left_hip_roll")
    torque_off = []
    stop = rig.session.backend.stop
    rig.session.backend.stop = lambda mode: torque_off.append(mode) or stop(mode)
    found = identify(rig, "left_hip_roll", lambda *_: None)
    assert torque_off[-1] is StopMode.TORQUE_OFF
    fit, true = found.fit, rig.hidden
    assert abs(true["torque_constant"] / 2.491 - 1) > 0.1  # far from the data sheet
    assert fit.torque_constant.value == pytest.approx(true["torque_constant"], rel=0.03)
    assert fit.resistance.value == pytest.approx(true["resistance"], rel=0.03)
    assert fit.armature.value == pytest.approx(true["armature"], abs=0.004)
    assert fit.friction.value == pytest.approx(true["friction"], abs=0.04)
    assert fit.backlash.value == pytest.approx(true["backlash"], abs=0.003)
    assert fit.gain_divisor == true["gain_divisor"]

    path = tmp_path / "calibration.yaml"
    rig.keep(path, found)
    kept = load_calibration(path).servos["left_hip_roll"]
    assert kept.torque_constant == fit.torque_constant.value
    assert "virtual (seed 5) servo" in kept.method
    rig.keep(path, found)  # a second joint would join the first
    assert list(yaml.safe_load(path.read_text())["servos"]) == ["left_hip_roll"]


def test_a_dry_run_counts_with_what_was_identified_and_its_motors_stay_as_drawn(tmp_path):
    text = (Path(ROBOT.file)).read_text()
    (tmp_path / "calibration.yaml").write_text(CALIBRATION)
    own = tmp_path / "own.yaml"
    own.write_text(text.replace("model: minibiped.xml", f"model: {ROBOT.model_path}")
                   + "\ncalibration: calibration.yaml\n")  # fmt: skip
    session = build(RunRequest.checked(robot=str(own), backend="bus", seed=5))
    plain = build(RunRequest.checked(backend="bus", seed=5))
    assert session.backend.calibration.servos["left_knee"].torque_constant == 2.9
    motors = [one.world.servos.motors.torque_constant[KNEE] for one in (session, plain)]
    assert motors[0] == motors[1]
    session.close()
    plain.close()


CALIBRATION = """
robot: minibiped
provenance: {date: 2026-01-01, method: test}
feet: {left: &foot {zero: [0, 0, 0, 0], scale: [1, 1, 1, 1]}, right: *foot}
servos:
  left_knee: {torque_constant: 2.9, resistance: 7.3, gain_divisor: 128, armature: 0.02,
    friction: 0.1, viscous: 0, delay: 0.003, backlash: 0.01, date: 2026-01-01, method: test}
"""


def test_a_servo_that_measures_no_current_is_refused():
    with pytest.raises(UnknownNameError, match="unknown joint 'tail'; valid: left_hip_yaw"):
        servo_rig(RunRequest.checked(backend="bus"), "tail")
    result = CliRunner().invoke(app, ["identify", "tail"])
    assert result.exit_code == 2


def test_real_servos_are_moved_only_live():
    result = CliRunner().invoke(app, ["identify", "left_knee", "--live"])
    assert result.exit_code == 2


class Hanging:
    """A backend whose frames a test changes."""

    def __init__(self, session):
        self._inner = session.backend
        self.clock = session.backend.clock
        self.spoil = lambda _: None

    def read(self):
        frame = self._inner.read()
        self.spoil(frame)
        return frame

    def write(self, command):
        return self._inner.write(command)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("joint_valid", False, "left_knee is silent"),
        ("joint_error", 32, "left_knee reports a hardware error"),
        ("joint_temperature", 70.0, "left_knee is hotter than 65"),
        ("joint_position", 2.0, "left_knee does not come within 0.5 rad"),
    ],
)
def test_an_unwell_joint_stops_it(key, value, message):
    rig = servo_rig(RunRequest.checked(backend="bus"), "left_knee")
    hanging = Hanging(rig.session)
    rig.session.backend.open()
    runner = GuardedRunner(replace(rig.session, backend=hanging), 300)
    runner.begin()

    def spoil(frame):
        getattr(frame, key)[KNEE] = value

    hanging.spoil = spoil
    with pytest.raises(BackendError, match=message):
        for _ in range(ERROR_TICKS + 10):
            runner.tick(default_command(rig.session))
    rig.session.close()
