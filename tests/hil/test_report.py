"""Report figures on made-up walks whose answers are known."""

import json
from pathlib import Path

import numpy as np
import pytest
from hil_fakes import make_session
from hil_walks import walk

from hil.gait_report import disequilibrium, gait_figures, heading_error, mean_speed, percentiles_ms
from hil.loop import Outcome
from hil.report import make_report
from hil.safety.severity import Fault

WEIGHT = 100.0
DESIGN_KEYS = [
    "robot",
    "backend",
    "bus",
    "rate_hz",
    "seed",
    "duration_s",
    "pd",
    "stabilizer",
    "ankle_limit",
    "motion_source",
    "fell",
    "steps",
    "distance_m",
    "mean_speed_mps",
    "target_speed_mps",
    "speed_error_pct",
    "heading_error_deg",
    "controller_ms_mean",
    "controller_ms_p50",
    "controller_ms_p99",
    "controller_ms_max",
    "cycle_ms_mean",
    "cycle_ms_p50",
    "cycle_ms_p99",
    "cycle_ms_max",
    "deadline_misses",
    "real_time_factor",
    "disequilibrium_pct",
    "stabilizer_iterations_mean",
    "stabilizer_limit_pct",
    "bus_utilisation_pct",
    "bus_crc_errors",
    "bus_timeouts",
    "bus_stale_frames",
    "temperature_max_c",
    "torque_rms_ratio_max",
    "duty_saturation_pct_max",
    "voltage_min_v",
    "energy_wh",
    "faults",
]


def yawed(angles):
    half = np.asarray(angles) / 2
    return np.column_stack((np.cos(half), np.zeros_like(half), np.zeros_like(half), np.sin(half)))


def test_a_straight_walk():
    figures = gait_figures(walk(20.0), WEIGHT)
    assert figures["steps"] == 39
    assert figures["distance_m"] == pytest.approx(0.2 * 19.99)
    assert figures["mean_speed_mps"] == pytest.approx(0.2)
    assert figures["target_speed_mps"] == pytest.approx(0.25)
    assert figures["speed_error_pct"] == pytest.approx(-20.0)
    assert figures["heading_error_deg"] == pytest.approx(0.0)
    assert figures["disequilibrium_pct"] == 0.0


@pytest.mark.parametrize(("seconds", "begins"), [(20.0, 5.0), (12.0, 5.0), (6.0, 3.0)])
def test_speed_counts_from_five_seconds_or_from_half_of_a_short_walk(seconds, begins):
    trace = walk(seconds)
    moved = np.where(trace.time_s < begins - 0.01, 0.0, 0.2 * (trace.time_s - begins))
    trace.com[:, 0] = moved
    assert mean_speed(trace)[0] == pytest.approx(0.2, rel=2e-3)


def test_speed_is_along_the_commanded_heading_and_sideways_does_not_count():
    trace = walk(20.0, heading=np.full(2000, np.pi / 2))
    trace.com[:, 1] = 0.1 * trace.time_s
    assert mean_speed(trace)[0] == pytest.approx(0.1)


def test_speed_error_has_the_sign_of_going_too_fast_in_either_direction():
    backwards = walk(20.0, speed=np.full(2000, -0.1))
    backwards.com[:, 0] = -0.2 * backwards.time_s
    assert gait_figures(backwards, WEIGHT)["speed_error_pct"] == pytest.approx(-100.0)
    assert gait_figures(walk(20.0, speed=np.zeros(2000)), WEIGHT)["speed_error_pct"] is None


def test_heading_error_is_of_the_last_two_steps_and_is_not_fooled_by_turns():
    yaw = np.zeros(2000)
    yaw[-150:] = 0.1  # the last step and a half before the end is inside the last two steps
    yaw[-50:] = 0.1
    trace = walk(20.0, base_orientation=yawed(yaw + 3.0), heading=np.full(2000, 3.0 + 4 * np.pi))
    assert heading_error(trace) == pytest.approx(np.degrees(0.1), abs=1e-6)


def shared(left_share=0.5, front_share=0.5, toe=0.0, load=WEIGHT, **columns):
    """A walk whose stance foot carries the given shares."""
    trace = walk(10.0, **columns)
    side, end = np.array([left_share, 1 - left_share]), np.array([front_share, 1 - front_share])
    corners = load * np.array([end[0] * side, end[1] * side]).ravel()
    trace.foot_force[np.arange(1000), trace.stance] = corners
    trace.toe_force[np.arange(1000), trace.stance] = toe
    return trace


@pytest.mark.parametrize(
    ("shares", "percent"),
    [
        ({"left_share": 0.16}, 0.0),
        ({"left_share": 0.14}, 100.0),
        ({"left_share": 0.86}, 100.0),
        ({"front_share": 0.14}, 100.0),
        ({"front_share": 0.84}, 0.0),
        ({"front_share": 0.10, "toe": 10.0}, 0.0),  # (10 + 10) / 110 in front
        ({"front_share": 0.84, "toe": 10.0}, 100.0),  # 16 / 110 at the rear
        ({"left_share": 0.14, "load": 14.0}, None),  # hardly loaded: not counted
    ],
)
def test_disequilibrium_is_a_side_with_less_than_15_percent(shares, percent):
    assert disequilibrium(shared(**shares), WEIGHT) == percent


def test_only_ticks_after_foot_flat_while_walking_count():
    flat = np.zeros(1000, bool)
    assert disequilibrium(shared(left_share=0.1, foot_flat=flat), WEIGHT) is None
    flat[:400] = True
    walking = np.zeros(1000, bool)
    walking[:200] = True
    trace = shared(left_share=0.1, foot_flat=flat, walking=walking)
    trace.foot_force[:50] = 25.0
    assert disequilibrium(trace, WEIGHT) == pytest.approx(75.0)


def test_percentiles_of_known_durations():
    figures = percentiles_ms("x", np.arange(1, 101) * 1_000_000)
    assert figures == {
        "x_mean": pytest.approx(50.5),
        "x_p50": pytest.approx(50.5),
        "x_p99": pytest.approx(99.01),
        "x_max": 100.0,
    }


def report(trace=None, outcome=None, **request):
    session = make_session(**request)
    outcome = outcome or Outcome(clock_ns=20_000_000_000, wall_ns=4_000_000_000, missed=3)
    statistics = {"bus_utilisation_pct": 31.0, "voltage_min_v": float("nan")}
    return make_report(
        session.request,
        "minibiped",
        outcome,
        walk(20.0) if trace is None else trace,
        WEIGHT,
        statistics,
        truth=True,
    )


def test_the_report_has_exactly_the_released_keys_and_is_json():
    data = report()
    assert sorted(data) == sorted(DESIGN_KEYS)
    assert json.loads(json.dumps(data, allow_nan=False)) == data


def test_every_key_is_explained():
    text = (Path(__file__).parents[2] / "docs" / "reports.md").read_text()
    for key in DESIGN_KEYS:
        stem = key.rsplit("_", 1)
        assert f"`{key}`" in text or f"`_{stem[-1]}`" in text, key


def test_what_does_not_apply_is_null():
    data = report()
    assert data["deadline_misses"] is None  # lockstep
    assert data["stabilizer_iterations_mean"] is None
    assert data["voltage_min_v"] is None and data["bus_utilisation_pct"] == 31.0
    assert data["real_time_factor"] == pytest.approx(5.0)
    assert report(realtime=True)["deadline_misses"] == 3


def test_a_run_that_never_walked_has_a_report_too():
    outcome = Outcome(faults=[Fault(-0.2, "left_knee", "silent", "torque_off")])
    data = report(trace=walk(0.0), outcome=outcome)
    assert (data["steps"], data["distance_m"], data["cycle_ms_mean"]) == (0, None, None)
    assert data["faults"] == [
        {"time_s": -0.2, "source": "left_knee", "name": "silent", "reaction": "torque_off"}
    ]
    assert not data["fell"]


def test_falling_is_told_by_its_fault():
    assert report(outcome=Outcome(faults=[Fault(3.0, "body", "fell", "torque_off")]))["fell"]
