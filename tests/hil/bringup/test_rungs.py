"""The rungs of a real robot, as its builder types them: refused, passed, on record.

`--live` with the real driver on the lines of a virtual robot; the wall clock is the virtual one.
"""

import json
from functools import partial

import pytest

from drivers.calibration import load_calibration
from drivers.dynamixel.control_table import Register
from drivers.robot_backend import BusBackend
from hil.bringup.ladder import wiring
from hil.compose import sessions
from hil.robot_files import load_robot

RATE = 150
SECOND = 1_000_000_000


@pytest.fixture
def live(calibrated, monkeypatch, tmp_path):
    """A calibrated robot, and its commands with `--live`."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("hil.run.draw_run", lambda *_: None)  # slow, and drawn in other tests
    bench = calibrated()
    monkeypatch.setattr(sessions, "MonotonicClock", lambda: bench.robot.clock)

    class Unguarded(BusBackend):
        def __init__(self, *arguments, guarded):
            assert guarded  # by another process, which cannot share a virtual clock
            super().__init__(*arguments)

    monkeypatch.setattr(sessions, "BusBackend", Unguarded)
    bench.robot.world.set_support(True)

    def command(verb, *arguments, yes=True, stdin=""):
        options = [*bench.ports(), "--rate", RATE, *(["--yes"] if yes else [])]
        return bench.stride(verb, bench.file, "--live", *options, *arguments, stdin=stdin)

    bench.live = command
    bench.record = bench.path.with_name("mine.rungs.json")
    bench.torque = lambda: {bench.registers(j)[Register.TORQUE_ENABLE] for j in bench.robot.servos}
    return bench


def hang(bench):
    bench.robot.world.hoist()


def lower_after(bench, seconds):
    """What the hand beside the robot does."""
    clock = bench.robot.clock
    let_go = partial(bench.robot.world.set_support, False)
    clock.schedule(clock.now_ns() + round(seconds * SECOND), let_go)


def put_on_record(bench, **changes):
    described = load_robot(bench.file).at_rate(RATE)
    record = {
        "rung": "hoisted walk",
        "robot": "minibiped",
        "calibration": load_calibration(bench.path).identity(),
        "wiring": wiring(described),
    }
    bench.record.write_text(json.dumps({"passed": [record | changes]}))


def refusal(result):
    assert result.exit_code == 2, result.output
    assert result.stderr.startswith("stride: ") and result.stderr.count("\n") == 1
    return result.stderr


def test_from_limp_to_the_ground(live):
    hang(live)
    stood = live.live("stand", "--duration", "0.5")
    assert stood.exit_code == 0, stood.output
    assert live.torque() == {0}
    assert "stride walk" in refusal(live.live("walk", "--duration", "1"))

    hoisted = live.live("walk", "--hoisted", "--duration", "5")
    assert hoisted.exit_code == 0, hoisted.output
    assert f"on record in {live.record}" in hoisted.stderr
    assert live.torque() == {0}
    (record,) = json.loads(live.record.read_text())["passed"]
    assert (record["rung"], record["robot"], record["rate_hz"]) == (
        "hoisted walk",
        "minibiped",
        RATE,
    )


def test_a_walk_on_the_ground_waits_until_its_feet_carry_it(live):
    put_on_record(live)
    lower_after(live, 5.0)
    walked = live.live("walk", "--duration", "1.5", "--json")
    assert walked.exit_code == 0, walked.output
    report = json.loads(walked.stdout)
    assert (report["fell"], report["steps"] > 0, report["faults"]) == (False, True, [])
    assert live.torque() == {0}
    assert live.robot.clock.now_ns() > 6 * SECOND


def test_a_robot_that_nobody_lowers_sits_down_again(live, monkeypatch):
    monkeypatch.setattr("hil.start_plan.WAIT_S", 1.0)
    put_on_record(live)
    hang(live)
    walked = live.live("walk", "--duration", "1", "--json")
    assert walked.exit_code == 1, walked.output
    names = [(fault["source"], fault["name"]) for fault in json.loads(walked.stdout)["faults"]]
    assert names == [("feet", "never carried the weight")]
    assert live.torque() == {0}


def test_sit_takes_over_where_the_robot_is(live):
    lower_after(live, 1.0)
    sat = live.live("sit")
    assert sat.exit_code == 0, sat.output
    assert live.torque() == {0}
    knees = live.robot.world.joint_position[[3, 9]]
    assert (knees > 1.8).all()


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"calibration": "another"}, "another calibration"),
        ({"wiring": "another"}, "another wiring"),
        ({"rung": "stand"}, "on record"),
        ({"robot": "other"}, "on record"),
    ],
    ids=["another calibration", "another wiring", "another rung", "another robot"],
)
def test_a_record_of_something_else_does_not_count(live, changes, reason):
    put_on_record(live, **changes)
    told = refusal(live.live("walk", "--duration", "1"))
    assert reason in told and "--live --hoisted" in told
    assert live.torque() == {0}


def test_a_new_calibration_ends_what_was_on_record(live):
    put_on_record(live)
    text = live.path.read_text()
    live.path.write_text(text.replace("left_knee: 0.0", "left_knee: 0.01"))
    assert live.path.read_text() != text
    assert "another calibration" in refusal(live.live("walk", "--duration", "1"))


def test_a_short_or_stopped_hoisted_walk_is_not_on_record(live):
    hang(live)
    short = live.live("walk", "--hoisted", "--duration", "0.5")
    assert short.exit_code == 0
    assert "hoisted walk not passed: it was 0.5 s long" in short.stderr
    live.robot.inject("servo:left_knee:silent@3.5+0.2")
    stopped = live.live("walk", "--hoisted", "--duration", "5.5")
    assert stopped.exit_code == 1
    assert "hoisted walk not passed: left_knee" in stopped.stderr
    assert not live.record.exists()


def test_a_robot_on_its_feet_is_not_hoisted(live):
    live.robot.world.set_support(False)
    refused = live.live("walk", "--hoisted", "--duration", "1")
    assert refused.exit_code == 1
    assert "its feet carry" in refused.stderr and "nothing was armed" in refused.stderr
    assert live.torque() == {0}


@pytest.mark.parametrize("verb", ["stand", "sit", "walk --hoisted"])
def test_nothing_is_armed_without_a_yes(live, verb):
    hang(live)
    verb, *more = verb.split()
    assert "--yes" in refusal(live.live(verb, *more, yes=False))
    assert live.torque() == {0}


def test_a_record_that_cannot_be_read_refuses(live):
    live.record.write_text('{"passed": 3}')
    assert str(live.record) in refusal(live.live("walk", "--duration", "1"))


@pytest.mark.parametrize("verb", ["walk", "stand", "sit"])
@pytest.mark.parametrize("option", [["--port", "left_leg=x"], ["--bus", "real"]])
def test_a_real_robot_is_only_asked_for_with_live(verb, option, bench):
    assert "--live" in refusal(bench.stride(verb, "minibiped", *option))
