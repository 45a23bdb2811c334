"""Walks in water, and what each mechanism of it is worth."""

import json
from functools import lru_cache

import numpy as np
import pytest

from hil.compose import build
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Ball, Schedules
from hil.studies.foot_lift import foot_lift
from hil.studies.walks import mean_velocity, walk_session


class Loads:
    """A sink: what drives the virtual force in the second half of a walk."""

    def __init__(self, session, begin_s):
        self.begin_s, self.plan = begin_s, session.controller._plan
        self.errors = {}

    def put(self, record):
        if record.time_s < self.begin_s:
            return
        if record.status.foot_flat:
            error = np.subtract(self.plan.wanted, self.plan.velocity)
            self.errors.setdefault(record.status.steps, []).append(error)

    @property
    def unevenness(self):
        """Standard deviation within a step of the speed errors that the force follows [m/s]."""
        whole = list(self.errors.values())[1:-1]
        return np.mean([np.std(step, axis=0) for step in whole], axis=0)


@lru_cache(maxsize=2)
def wade(*overrides, speed=0.5, seconds=8.0, robot="human", balls=(), **liquid):
    """A walk in a liquid that stays as it is, or follows points: its trace and its loads."""
    course = {
        name: points if isinstance(points, tuple) else ((0.0, points),)
        for name, points in liquid.items()
    }
    schedules = Schedules(speed=((0.0, speed),), balls=balls, **course)
    request = RunRequest(robot=robot, duration_s=seconds, schedules=schedules, overrides=overrides)
    session = build(request)
    loads = Loads(session, seconds / 2) if robot == "human" else None
    return walk_session(session, *([loads] if loads else [])), loads


def speed_of(walked):
    return mean_velocity(walked.trace)[0]


def test_the_human_wades_through_knee_deep_water_at_the_commanded_speed():
    walked, _ = wade(water=0.5)
    assert walked.stopped_s is None
    assert speed_of(walked) == pytest.approx(0.5, rel=0.02)


def test_without_leading_the_foot_through_the_water_it_falls_forward():
    """`placement.drag_lag`: with it 0.5 m/s in 0.75 m is walked, without it a fall at 2.7 s."""
    walked, _ = wade("walking.placement.drag_lag=[]", water=0.75, seconds=5.0)
    assert walked.ending == "fell"
    assert walked.stopped_s < 4.0


def test_without_the_learned_curve_the_force_fights_the_walk_s_own_sway():
    """Its error varies within a step 2.2 times as much along the heading, 7.5 times across."""
    _, learned = wade(water=0.5)
    _, plain = wade("walking.learned_velocity.threshold=1e-9", water=0.5)
    along, across = plain.unevenness / learned.unevenness
    assert along > 1.8
    assert across > 5.0


def test_without_the_alteration_the_walk_stays_too_slow():
    """Δ: 0.686 m/s after 8 s with it, 0.639 without, of 0.7 m/s."""
    altered, _ = wade(water=0.5, speed=0.7)
    plain, _ = wade("walking.alteration.gain=0", water=0.5, speed=0.7)
    assert abs(speed_of(altered) - 0.7) < 0.02
    assert speed_of(plain) < 0.66


def test_at_0_7_mps_the_foot_leaves_the_water_and_without_that_style_it_does_not():
    """The combiner: lifted to 0.36 m with the styles, to 0.15 m without, half a metre deep."""
    human = load_robot("human")
    lifted, _ = wade(water=0.5, speed=0.7)
    assert foot_lift(human, lifted.trace) > 0.3
    alone, _ = wade("walking.styles=[]", water=0.5, speed=0.7)
    assert foot_lift(human, alone.trace) < 0.2


def test_without_buoyancy_compensation_a_dense_liquid_floats_the_leg():
    """1500 kg/m³, 1 m, the standard controller: 0.503 m/s with it, without it a fall at 5.3 s."""
    carried, _ = wade("walking.styles=[]", water=1.0, density=1500.0)
    assert abs(speed_of(carried) - 0.5) < 0.01
    plain = ("walking.styles=[]", "walking.buoyancy_compensation=false")
    floating, _ = wade(*plain, water=1.0, density=1500.0)
    assert floating.ending == "fell"


@pytest.mark.parametrize(("speed", "level"), [(0.5, 0.5), (0.3, 0.75)])
def test_it_walks_in_a_liquid_five_times_as_viscous(speed, level):
    walked, _ = wade(speed=speed, water=level, viscosity=5.0)
    assert walked.stopped_s is None
    assert speed_of(walked) == pytest.approx(speed, rel=0.05)


def test_without_drag_compensation_the_leg_is_too_late_in_a_thick_liquid():
    """0.5 m/s, 0.5 m, viscosity 5: with it 20 s, without it a fall at 1.6 s."""
    walked, _ = wade("walking.drag_compensation=false", water=0.5, viscosity=5.0, seconds=3.0)
    assert walked.ending == "fell"


@pytest.mark.parametrize("off", [False, True])
def test_without_drag_compensation_it_cannot_walk_aside_in_water(off):
    change = ("walking.drag_compensation=false",) if off else ()
    aside = ((0.0, 0.2),)
    walked, _ = wade(*change, speed=0.0, seconds=6.0, water=0.5, lateral=aside)
    assert (walked.stopped_s is not None) is off
    if not off:
        assert mean_velocity(walked.trace)[1] == pytest.approx(0.2, abs=0.03)


def test_without_the_style_of_thick_liquids_it_falls_thigh_deep():
    """0.3 m/s, 0.75 m, viscosity 5: with it 20 s, without it a fall at 3.7 s."""
    styles = [style for style in load_robot("human").walking["styles"] if "resistance" not in style]
    override = f"walking.styles={json.dumps(styles)}"
    walked, _ = wade(override, speed=0.3, water=0.75, viscosity=5.0, seconds=5.0)
    assert walked.ending == "fell"


def test_it_walks_hip_deep_at_0_7_mps():
    walked, _ = wade(water=1.0, speed=0.7)
    assert walked.stopped_s is None
    assert speed_of(walked) == pytest.approx(0.7, rel=0.03)


def test_a_ball_from_behind_in_0_75_m_is_recovered_from():
    """Foreseeing the drag of the wanted speed, not of the real one, it fell 1.5 s later."""
    ball = Ball(mass=5.0, velocity=(5.4, 0.0, 0.0), start=4.0)
    walked, _ = wade(water=0.75, speed=0.6, seconds=9.0, balls=(ball,))
    assert walked.stopped_s is None


def test_water_that_rises_and_falls_during_a_walk():
    walked, _ = wade(water=((0.0, 0.0), (5.0, 0.75), (10.0, 0.0)), seconds=12.0)
    assert walked.stopped_s is None


def test_the_small_biped_wades_in_the_dry_run():
    """5 cm on a leg of 0.22 m: a quarter of it."""
    walked, _ = wade(robot="minibiped", speed=0.1, seconds=4.0, water=0.05)
    assert walked.stopped_s is None
    assert walked.report["steps"] >= 5


@pytest.mark.parametrize(
    "cell",
    [(style["speed"], style["water"]) for style in load_robot("human").walking["references"]],
    ids=lambda cell: f"{cell[0]:g} m/s, {cell[1]:g} m",
)
def test_every_reference_that_a_search_found_walks_at_its_cell(cell):
    speed, level = cell
    walked, _ = wade("walking.use_references=true", speed=speed, water=level, seconds=5.0)
    assert walked.stopped_s is None
    assert speed_of(walked) == pytest.approx(speed, rel=0.06)
