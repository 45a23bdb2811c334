"""Whole walks through the composition root: every rung that needs no terminals walks."""

import pytest

from hil.request import RunRequest
from hil.schedule import Schedules
from hil.studies.walks import walk


@pytest.mark.parametrize(
    ("request_", "least_m", "error_pct"),
    [
        ({"rate_hz": 300, "seed": 3}, 1.0, 10),
        ({"rate_hz": 225, "seed": 4}, 1.0, 10),
        ({"rate_hz": 225, "seed": 5, "backend": "mujoco"}, 1.0, 10),
        ({"robot": "human"}, 4.5, 5),
        ({"robot": "human", "rate_hz": 120, "pd": "implicit"}, 4.5, 5),
    ],
    ids=["dry-run-300", "dry-run-225", "simulation-225", "human-explicit", "human-implicit-120"],
)
def test_it_walks_as_fast_as_asked(request_, least_m, error_pct):
    report = walk(RunRequest(duration_s=10.0, **request_)).report
    assert not report["faults"]
    assert report["distance_m"] >= least_m
    assert abs(report["speed_error_pct"]) <= error_pct


def test_the_small_biped_turns_where_it_is_told():
    turn = Schedules(turns=((1.0, 1.0),))
    report = walk(RunRequest(duration_s=9.0, schedules=turn)).report
    assert not report["faults"]
    assert abs(report["heading_error_deg"]) < 6


def test_the_small_biped_survives_a_push_and_falls_under_a_large_one():
    def pushed(newtons):
        force = {"force": (0.0, newtons, 0.0), "start": 4.0, "duration": 0.3}
        return walk(RunRequest(duration_s=7.0, schedules=Schedules(pushes=(force,)))).report

    assert not pushed(2.0)["faults"]
    assert pushed(20.0)["fell"]
