"""Monitors and decision of the safety chain, with frames made by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.interface import NEVER_NS, AppliedCommand, Limit, SensorFrame
from hil.record_layout import topics
from hil.robot_files import load_robot
from hil.safety.assembly import make_supervisor
from hil.safety.decision import RUNNING, Action, WayOut, decide
from hil.safety.monitor import Situation
from hil.safety.severity import Event, Severity
from hil.safety.silence import never_heard

ROBOT = load_robot("minibiped")
WEIGHT_N = 25.7
TICK_NS = 3_333_333
WAY_OUT = WayOut(1_000, 300)


def fresh_frame():
    frame = SensorFrame.empty(12)
    frame.joint_age_ns[:] = 0
    frame.joint_valid[:] = True
    frame.joint_temperature[:] = 40.0
    frame.joint_voltage[:] = 12.0
    frame.imu_age_ns = 0
    frame.foot_age_ns[:] = 0
    frame.foot_valid[:] = True
    frame.foot_force[:] = WEIGHT_N / 8
    return frame


def body(height=0.25, roll=0.0, pitch=0.0, yaw=0.0):
    motion = topics(12, truth=True)["truth"]
    motion.base_position = np.array([1.0, 2.0, height])
    half = np.array([roll, pitch, yaw]) / 2
    (cr, cp, cy), (sr, sp, sy) = np.cos(half), np.sin(half)
    motion.base_orientation = np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )
    return motion


class Watched:
    """A supervisor, and the situation that it is shown tick after tick."""

    def __init__(self, robot=ROBOT, *, paced=True):
        self.supervisor = make_supervisor(robot, 300, WEIGHT_N, paced=paced)
        self.supervisor.begin_walking(0.25)
        self.frame = fresh_frame()
        self.applied = AppliedCommand.zeros(12)
        self.situation = Situation(0, self.frame, body(), self.applied, walking=True)

    def tick(self, count=1):
        """The action of the last of some ticks."""
        for _ in range(count):
            self.situation.now_ns += TICK_NS
            action = self.supervisor.judge(self.situation, self.situation.now_ns * 1e-9)
        return action

    @property
    def told(self):
        return [(fault.source, fault.name, fault.reaction) for fault in self.supervisor.faults]


@pytest.mark.parametrize("yaw", [0.0, 1.0, -3.0])
@pytest.mark.parametrize(
    ("pose", "fell"),
    [
        ({}, False),
        ({"roll": 0.7}, False),
        ({"roll": -1.01}, True),
        ({"pitch": 1.01}, True),
        ({"pitch": math.pi}, True),
        ({"height": 0.151}, False),
        ({"height": 0.149}, True),
    ],
)
def test_a_fall_is_a_tilt_of_one_radian_or_a_low_body(pose, fell, yaw):
    watched = Watched()
    watched.situation.motion = body(yaw=yaw, **pose)
    watched.situation.walking = False  # nothing is predicted then
    assert watched.tick() is (Action.OFF if fell else Action.RUN)
    assert watched.told == ([("body", "fell", "torque_off")] if fell else [])


def test_a_body_that_tips_over_is_caught_before_it_lies():
    watched, actions = Watched(), []
    for roll in np.arange(0.0, 0.6, 2.5 * TICK_NS * 1e-9):  # 2.5 rad/s
        watched.situation.motion = body(roll=roll)
        actions.append(watched.tick())
    assert watched.told == [("body", "falling", "land")]
    assert Action.LAND in actions and Action.SIT not in actions


def test_swaying_is_no_fall():
    watched = Watched()
    for time_s in np.arange(0.0, 3.0, TICK_NS * 1e-9):
        watched.situation.motion = body(roll=0.15 * math.sin(11.0 * time_s))
        assert watched.tick() is Action.RUN


def test_a_servo_silent_for_five_ticks_is_forgiven_and_for_six_is_lost():
    watched = Watched()
    watched.frame.joint_valid[3] = False
    assert watched.tick(5) is Action.RUN
    assert watched.tick() is Action.SIT
    assert ("left_knee", "silent", "soft_stop") in watched.told


def test_a_servo_that_answers_two_times_in_three_is_told_then_stops_the_robot():
    watched = Watched()
    watched.tick(200)
    actions = []
    for tick in range(60):
        watched.frame.joint_valid[7] = tick % 3 != 0
        actions.append(watched.tick())
    assert watched.told == [
        ("right_hip_roll", "poor link", "none"),
        ("right_hip_roll", "link lost too often", "soft_stop"),
    ]
    assert actions.index(Action.SIT) == 30  # the eleventh loss in a hundred ticks


@given(st.integers(0, 2**32 - 1))
def test_one_packet_in_a_hundred_lost_stops_nobody(seed):
    watched, draw = Watched(), np.random.default_rng(seed)
    for _ in range(300):
        watched.frame.joint_valid[:] = draw.random(12) > 0.01
        assert watched.tick() is Action.RUN


@pytest.mark.parametrize(
    ("board", "name"), [("imu", "imu"), ("left", "left_foot"), ("right", "right_foot")]
)
def test_a_silent_board_is_lost_by_name(board, name):
    watched = Watched()
    if board == "imu":
        watched.frame.imu_age_ns = 60_000_000
    else:
        watched.frame.foot_age_ns[("left", "right").index(board)] = 60_000_000
    assert watched.tick() is Action.SIT
    assert watched.told == [(name, "silent", "soft_stop")]


@pytest.mark.parametrize(
    ("celsius", "action", "told"),
    [
        (69.0, Action.RUN, []),
        (71.0, Action.RUN, [("left_knee", "hot", "none")]),
        (76.0, Action.SIT, [("left_knee", "too hot", "soft_stop")]),
    ],
)
def test_heat_is_told_ten_kelvin_and_stops_five_before_the_servo_does(celsius, action, told):
    watched = Watched()
    watched.frame.joint_temperature[3] = celsius
    assert watched.tick(10) is action
    assert watched.told == told


def test_a_sag_shorter_than_a_tenth_of_a_second_is_told_and_a_longer_one_stops():
    watched = Watched()
    watched.frame.joint_voltage[:] = 7.0
    assert watched.tick(25) is Action.RUN
    watched.frame.joint_voltage[:] = 12.0
    assert watched.tick(30) is Action.RUN
    assert watched.told == [("supply", "low voltage", "none")]
    watched.frame.joint_voltage[:] = 7.0
    assert watched.tick(45) is Action.SIT
    assert watched.told[1:] == [("supply", "low voltage", "soft_stop")]  # what ended it is told


def test_a_servo_that_reports_an_error_stops_the_robot():
    watched = Watched(load_robot("minibiped", ("safety.overload_ends_torque=true",)))
    watched.frame.joint_error[3] = 0x20
    assert watched.tick() is Action.SIT
    assert watched.told == [("left_knee", "servo error 0x20", "soft_stop")]


def test_an_overload_that_does_not_end_the_torque_is_told():
    watched = Watched()
    watched.frame.joint_error[3] = 0x20
    assert watched.tick(3) is Action.RUN
    assert watched.told == [("left_knee", "servo error 0x20", "none")]


def test_a_joint_that_stalls_stops_the_robot_in_seconds_and_a_peak_does_not():
    watched = Watched()
    watched.frame.joint_torque[3] = -4.1
    assert watched.tick(300) is Action.RUN  # one second
    assert watched.tick(450) is Action.SIT
    assert ("left_knee", "works hard", "none") in watched.told
    assert ("left_knee", "overloaded", "soft_stop") in watched.told


@pytest.mark.parametrize(
    ("error", "name"),
    [(0x100, "rebooted"), (0x220, "torque lost"), (0x400, "stopped by its watchdog")],
)
def test_a_servo_that_no_longer_obeys_stops_the_robot(error, name):
    watched = Watched()
    watched.frame.joint_error[3] = error
    assert watched.tick() is Action.SIT
    assert watched.told == [("left_knee", name, "soft_stop")]


def test_a_servo_that_only_complains_of_its_voltage_is_told():
    watched = Watched()
    watched.frame.joint_error[3] = 0x01
    assert watched.tick(3) is Action.RUN
    assert watched.told == [("left_knee", "servo error 0x01", "none")]


def test_a_servo_that_stays_while_its_goal_moves_is_frozen_and_one_at_rest_is_not():
    watched = Watched()
    watched.tick(60)
    for tick in range(40):
        goal = 0.01 * tick
        watched.applied.position[:] = goal
        watched.frame.joint_position[:] = goal
        watched.frame.joint_position[4] = 0.0
        watched.tick()
    assert ("left_ankle_pitch", "frozen", "soft_stop") in watched.told
    assert {source for source, *_ in watched.told} == {"left_ankle_pitch"}


def test_a_foot_needs_three_cells():
    watched = Watched()
    watched.frame.foot_valid[1, 0] = False
    assert watched.tick() is Action.RUN
    watched.frame.foot_valid[1, 1] = False
    assert watched.tick() is Action.SIT
    assert watched.told == [("right_foot", "too few valid cells", "soft_stop")]


def test_feet_that_feel_half_the_weight_are_not_believed_for_long():
    watched = Watched()
    watched.tick(300)
    watched.frame.foot_force[0] = 0.0  # stuck at nothing, and the other foot at half
    assert watched.tick(100) is Action.RUN
    assert watched.tick(200) is Action.SIT
    assert ("feet", "load is not the weight", "soft_stop") in watched.told


def test_a_pause_longer_than_the_watchdogs_stops_the_robot_but_not_in_lockstep():
    for paced, action in ((True, Action.SIT), (False, Action.RUN)):
        watched = Watched(paced=paced)
        watched.tick(3)
        watched.situation.now_ns += 50_000_000
        assert watched.tick() is action


def test_commands_that_are_clamped_all_the_time_are_told_once():
    watched = Watched()
    watched.applied.limit[2] = int(Limit.POSITION)
    assert watched.tick(25) is Action.RUN and not watched.told
    assert watched.tick(200) is Action.RUN
    assert watched.told == [("program", "commands outside limits", "none")]


def test_sitting_down_is_not_falling():
    watched = Watched()
    watched.supervisor.note(Event("operator", "SIGINT", Severity.SOFT_STOP))
    assert watched.tick() is Action.SIT
    watched.situation.motion = body(height=0.13)
    assert watched.tick() is Action.SIT
    assert watched.tick(400) is Action.OFF
    assert watched.told == [("operator", "SIGINT", "soft_stop")]


def test_a_human_of_torques_has_no_way_down():
    watched = Watched(load_robot("human"))
    watched.supervisor.note(Event("operator", "SIGINT", Severity.SOFT_STOP))
    assert watched.tick() is Action.OFF


def test_who_never_spoke_is_named():
    frame = fresh_frame()
    frame.joint_age_ns[11] = NEVER_NS
    frame.foot_age_ns[0] = NEVER_NS
    frame.imu_age_ns = NEVER_NS
    assert never_heard(ROBOT, frame) == ["right_ankle_roll", "imu", "left_foot"]
    assert never_heard(ROBOT, fresh_frame()) == []


SEVERITIES = [Action.RUN, Action.SIT, Action.LAND, Action.OFF]


@given(st.lists(st.tuples(st.integers(1, 400), st.lists(st.sampled_from(Severity)))))
def test_nothing_leads_back_and_the_worst_event_wins(ticks):
    now_ns, state, action = 0, RUNNING, Action.RUN
    for elapsed_ns, severities in ticks:
        now_ns += elapsed_ns
        events = [Event("x", "y", severity) for severity in severities]
        before, last = state, action
        state, action = decide(now_ns, state, events, WAY_OUT)
        assert state.severity >= before.severity
        assert SEVERITIES.index(action) >= SEVERITIES.index(last)
        if Severity.TORQUE_OFF in severities:
            assert action is Action.OFF
        if max(severities, default=Severity.OK) <= Severity.WARN:
            assert state == before


def test_sitting_ends_in_torque_off_in_time():
    state, action = decide(0, RUNNING, [Event("x", "y", Severity.SOFT_STOP)], WAY_OUT)
    assert action is Action.SIT
    assert decide(999, state, [], WAY_OUT)[1] is Action.SIT
    assert decide(1_000, state, [], WAY_OUT)[1] is Action.OFF


def test_a_fall_that_begins_after_torque_is_off_moves_nothing():
    state, _ = decide(0, RUNNING, [Event("x", "y", Severity.SOFT_STOP)], WAY_OUT)
    state, action = decide(1_000, state, [], WAY_OUT)
    assert action is Action.OFF
    assert decide(1_001, state, [Event("x", "y", Severity.LAND)], WAY_OUT)[1] is Action.OFF


def test_a_pause_is_told_before_what_it_brought():
    watched = Watched()
    watched.tick()
    watched.situation.now_ns += 500_000_000
    watched.frame.imu_age_ns = 500_000_000  # nobody asked the board meanwhile
    watched.tick()
    assert [name for _, name, _ in watched.told] == ["paused 503 ms", "silent"]


def test_sitting_down_low_at_the_walks_own_end_is_no_fall():
    watched = Watched()
    watched.tick()
    watched.supervisor.finish(watched.situation.now_ns)
    watched.situation.motion = body(height=0.13)
    assert watched.tick() is Action.SIT
    assert watched.told == []
