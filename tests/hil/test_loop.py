import os
import signal

import numpy as np
import pytest
from hil_fakes import Collector, make_session

from hil.clock import ManualClock
from hil.errors import BackendError
from hil.loop import Loop

STAND_UP = -450
"""First tick of start-up at 300 Hz."""
ERRORS = [RuntimeError("boom"), BackendError("port lost"), KeyboardInterrupt(), SystemExit(143)]


def run(session, *, sits=False):
    ticks = Collector()
    loop = Loop(session, (ticks,), sits=sits)
    session.backend.open()
    return loop, ticks


def test_a_walk_stands_up_first_and_lasts_as_long_as_it_should():
    session = make_session(world=True)
    loop, ticks = run(session)
    outcome = loop.run()
    assert ticks.ticks == list(range(STAND_UP, 300))
    assert outcome.faults == [] and not outcome.fell
    assert outcome.clock_ns == pytest.approx(1e9, abs=4e6)
    assert session.controller.ticks == 300
    assert session.world.support == [True, False]
    assert session.backend.journal == ["open", "arm", "torque_off", "close"]


def test_start_up_moves_smoothly_from_the_pose_found_to_the_start_pose():
    session = make_session()
    session.backend.frame.joint_position[:] = present = np.linspace(-0.3, 0.3, 12)
    present = present.copy()
    present[[3, 9]] = session.backend.frame.joint_position[[3, 9]] = 0.4
    loop, _ = run(session)
    loop.run()
    ramp = np.array(session.backend.written[:450])
    target = np.array(session.description.start_position)
    assert np.allclose(ramp[0], present, atol=1e-4)
    assert np.allclose(ramp[300:], target)
    assert np.abs(np.diff(ramp, axis=0)).max() < 1.6 * np.abs(target - present).max() / 300


def test_a_walk_ends_on_bent_legs_before_torque_goes_off():
    session = make_session(world=True)
    loop, ticks = run(session, sits=True)
    outcome = loop.run()
    sitting = session.description.sit
    assert ticks.ticks[-1] == pytest.approx(300 + (sitting.time + 0.3) * 300, abs=1)
    down = np.array(session.backend.written[750:])
    goal = [sitting.joints.get(name, 0.0) for name in session.description.joint_names]
    assert np.allclose(down[-1], goal)
    assert np.abs(np.diff(down, axis=0)).max() < 1.6 * np.abs(goal).max() / (300 * sitting.time)
    assert outcome.faults == [] and session.controller.ticks == 300
    assert session.backend.journal[-2:] == ["torque_off", "close"]


def test_one_command_that_is_not_sound_is_passed_over():
    session = make_session()
    step = session.controller.step

    def once(estimate, reference):
        command = step(estimate, reference)
        command.torque[2] = np.nan if session.controller.ticks == 50 else 0.0
        return command

    session.controller.step = once
    loop, _ = run(session)
    outcome = loop.run()
    assert [(fault.name, fault.reaction) for fault in outcome.faults] == [
        ("InvalidCommandError", "none")
    ]
    assert len(session.backend.written) == 750 and np.isfinite(session.backend.written).all()


def test_a_joint_outside_its_range_is_never_armed():
    session = make_session()
    session.backend.frame.joint_position[3] = -0.4
    loop, _ = run(session)
    with pytest.raises(BackendError, match=r"left_knee -0\.40 rad"):
        loop.run()
    assert "arm" not in session.backend.journal


def test_a_robot_that_starts_moving_walks_at_once():
    session = make_session()
    moving = session.description.start.model_copy(update={"moving": True})
    description = session.description.model_copy(update={"start": moving})
    object.__setattr__(session, "description", description)
    loop, ticks = run(session)
    loop.run()
    assert ticks.ticks == list(range(300))
    assert session.backend.journal[:2] == ["open", "arm"]


def test_the_operators_schedules_and_pushes_reach_controller_and_world():
    session = make_session(
        world=True,
        schedules={
            "speed": ((0.0, 0.1), (1.0, 0.3)),
            "turns": ((0.5, 1.0),),
            "pushes": ({"force": (0, 3, 0), "start": 0.2, "duration": 0.1},),
            "balls": ({"mass": 0.2, "velocity": (0, 2, 0), "start": 0.4},),
            "water": ((0.0, 0.1), (0.5, 0.1), (0.52, 0.2)),
        },
    )
    loop, _ = run(session)
    loop.run()
    speeds, headings = np.array(session.controller.references).T
    assert np.allclose(speeds, 0.1 + 0.2 * np.arange(300) / 300)
    assert headings.tolist() == [0.0] * 150 + [1.0] * 150
    assert session.world.pushes == [(0, 3, 0)] * 30 + [(0, 0, 0)]
    assert session.world.balls == [(0.2, (0, 2, 0))]
    levels = [level for level, _, _ in session.world.media]
    assert levels[0] == 0.1, "from the first tick on, and told again only when it changes"
    assert len(levels) == 7
    assert levels[-1] == pytest.approx(0.2)


def test_a_late_tick_skips_and_goes_on():
    class SlowOnce(ManualClock):
        slow_ns = 0

    session = make_session(clock=SlowOnce())
    step = session.controller.step

    def slow_step(estimate, reference):
        if session.controller.ticks == 100:
            session.backend.clock.sleep_until_ns(session.backend.clock.now_ns() + 12_000_000)
        return step(estimate, reference)

    session.controller.step = slow_step
    loop, ticks = run(session)
    outcome = loop.run()
    walked = [tick for tick in ticks.ticks if tick >= 0]
    assert sorted(set(range(300)) - set(walked)) == [101, 102, 103]
    assert outcome.missed == 4


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize("stage", ["read", "estimate", "control", "write"])
def test_whatever_a_part_raises_the_robot_is_stopped_and_the_error_comes_out(stage, error):
    session = make_session()
    part = {"estimate": session.estimator, "control": session.controller}.get(stage)
    if part is None:
        session.backend.raise_in[stage] = error
    else:
        part.raising = error
    loop, _ = run(session)
    with pytest.raises(type(error)) as caught:
        loop.run()
    assert caught.value is error
    assert session.backend.journal[-2:] == ["torque_off", "close"]
    assert [fault.name for fault in loop.outcome.faults] == [type(error).__name__]


def test_torque_off_is_repeated_until_it_is_read_back():
    session = make_session()
    session.backend.verify_after = 3
    loop, _ = run(session)
    loop.run()
    assert session.backend.journal[-4:] == [*["torque_off"] * 3, "close"]


def test_torque_that_never_goes_off_is_an_error_and_the_port_is_closed():
    session = make_session()
    session.backend.verify_after = 1000
    loop, _ = run(session)
    with pytest.raises(BackendError, match="cut the servo power"):
        loop.run()
    assert session.backend.journal[-1] == "close"


def test_a_second_error_while_stopping_does_not_hide_the_first():
    session = make_session()
    session.controller.raising = RuntimeError("boom")
    session.backend.verify_after = 1000
    loop, _ = run(session)
    with pytest.raises(RuntimeError, match="boom") as caught:
        loop.run()
    assert "cut the servo power" in caught.value.__notes__[0]
    assert session.backend.journal[-1] == "close"


def test_a_fall_ends_the_run_with_torque_off():
    session = make_session(world=True)
    step = session.controller.step

    def fall(estimate, reference):
        if session.controller.ticks == 60:
            session.world.truth_now.base_position[2] = 0.1
        return step(estimate, reference)

    session.controller.step = fall
    loop, ticks = run(session)
    outcome = loop.run()
    assert outcome.fell
    assert outcome.faults[0].time_s == pytest.approx(61 / 300)
    assert ticks.ticks[-1] == 61
    assert session.backend.journal[-2:] == ["torque_off", "close"]


def test_nothing_is_armed_while_a_sensor_is_silent():
    session = make_session()
    session.backend.frame.joint_age_ns[5] = np.iinfo(np.int64).max
    loop, _ = run(session)
    with pytest.raises(BackendError, match="left_ankle_roll"):
        loop.run()
    assert "arm" not in session.backend.journal


def test_a_command_that_is_not_finite_is_never_sent():
    session = make_session()
    session.controller.command.torque[2] = np.nan
    loop, _ = run(session)
    with pytest.raises(ValueError, match="left_hip_pitch"):
        loop.run()
    assert session.controller.ticks == 2  # the second one in a row ends the walk
    assert np.isfinite(session.backend.written).all()
    assert session.backend.journal[-2:] == ["torque_off", "close"]


@pytest.mark.parametrize(
    ("number", "error"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)]
)
def test_a_signal_stops_the_robot_at_the_end_of_the_tick(number, error):
    session = make_session()
    step = session.controller.step

    def interrupted(estimate, reference):
        if session.controller.ticks == 10:
            os.kill(os.getpid(), number)
        return step(estimate, reference)

    session.controller.step = interrupted
    before = signal.getsignal(number)
    loop, _ = run(session)
    with pytest.raises(error):
        loop.run()
    assert session.controller.ticks == 11
    assert [(fault.source, fault.reaction) for fault in loop.outcome.faults] == [
        ("operator", "soft_stop")
    ]
    sitting = session.description.sit.joints["left_knee"]
    assert session.backend.written[-1][3] == pytest.approx(sitting)
    assert session.backend.journal[-2:] == ["torque_off", "close"]
    assert signal.getsignal(number) is before


def test_a_second_signal_does_not_wait_for_a_controller_that_hangs():
    session = make_session()

    def hang(estimate, reference):
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        while True:
            pass

    session.controller.step = hang
    loop, _ = run(session)
    with pytest.raises(KeyboardInterrupt):
        loop.run()
    assert session.backend.journal[-2:] == ["torque_off", "close"]
