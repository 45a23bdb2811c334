"""Standing, sitting and walking in the air in simulation: on both backends, and what is refused."""

import numpy as np
import pytest
from hil_fakes import make_session

from hil.compose import build
from hil.errors import DescriptionError, InputError
from hil.loop import Loop
from hil.progress import describe
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.start_plan import start_plan
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors

RATE = 150
BACKENDS = pytest.mark.parametrize("backend", ["bus", "mujoco"])


class Watch:
    """A sink: the truth, and the loads of the feet, tick by tick."""

    def __init__(self):
        self.rows = []

    def put(self, record):
        truth = record.truth
        tilt = 2.0 * np.hypot(*truth.base_orientation[1:3])
        self.rows.append(
            (record.time_s, tilt, truth.base_position[2], truth.foot_force.sum(),
             record.status.steps, *truth.joint_position)
        )  # fmt: skip

    def __getattr__(self, name):
        column = {"time_s": 0, "tilt": 1, "height": 2, "load": 3, "steps": 4}[name]
        return np.array([row[column] for row in self.rows])

    @property
    def joints(self):
        return np.array([row[5:] for row in self.rows])


def go(**request):
    session = build(RunRequest.checked(rate_hz=RATE, **request))
    session.backend.open()
    watch = Watch()
    outcome = Loop(session, (watch,)).run()
    return session, outcome, watch


@BACKENDS
def test_stand_stands_on_its_feet_and_sits_down(backend):
    session, outcome, watch = go(activity="stand", duration_s=1.0, backend=backend)
    assert outcome.faults == []
    standing = (watch.time_s > 0.5) & (watch.time_s < 1.0)
    assert watch.tilt[standing].max() < np.radians(5)
    np.testing.assert_allclose(watch.load[standing], 25.7, atol=1.0)
    assert watch.height[-1] < 0.65 * watch.height[standing].mean()
    assert watch.tilt.max() < np.radians(25)
    description = session.description
    reached = watch.joints[watch.time_s < 0][-1]
    np.testing.assert_allclose(reached, description.start_position, atol=0.1)


def test_the_present_pose_is_held_before_anything_moves():
    _, _, watch = go(activity="stand", duration_s=0.1, backend="mujoco")
    held = watch.time_s < watch.time_s[0] + 0.4
    assert np.ptp(watch.joints[held], axis=0).max() < 0.02


@BACKENDS
def test_sit_folds_the_legs_slowly_on_its_own_feet(backend):
    _, outcome, watch = go(activity="sit", duration_s=0.2, backend=backend)
    assert outcome.faults == []
    assert watch.joints[-1][3] > 1.9
    assert watch.load[-1] > 24.0
    speed = np.abs(np.diff(watch.joints, axis=0)).max() * RATE
    assert speed < 1.5  # 1.2 rad of knee in 3 s are 0.6 rad/s at most; the floor adds some
    assert watch.tilt.max() < np.radians(25)


@BACKENDS
def test_a_hoisted_walk_keeps_stepping_and_nobody_takes_it_for_a_fall(backend):
    _, outcome, watch = go(hoisted=True, duration_s=3.0, backend=backend, seed=2)
    assert outcome.faults == [] and not outcome.fell
    assert watch.load.max() == 0.0
    walking = (watch.time_s >= 0) & (watch.time_s < 3.0)
    assert watch.steps[walking][-1] == pytest.approx(3.0 / 0.32, abs=1.5)
    lifts = np.ptp(watch.joints[walking & (watch.time_s > 1.0)], axis=0)
    assert lifts[[3, 9]].min() > 0.3  # both knees bend and stretch


@BACKENDS
def test_a_walk_for_the_ground_stops_when_it_hangs(backend):
    _, outcome, _ = go(overrides=("hoist=true",), duration_s=2.0, backend=backend)
    assert [(fault.source, fault.name) for fault in outcome.faults] == [
        ("feet", "load is not the weight")
    ]


def test_a_hoisted_robot_that_touches_something_stops():
    session = build(
        RunRequest.checked(hoisted=True, rate_hz=RATE, duration_s=3.0, backend="mujoco")
    )
    session.backend.open()
    read = session.backend.read

    def touching():
        frame = read()
        if frame.time_ns > 2.5e9:
            frame.foot_force[0] = 3.0  # half of the weight, on the left foot
        return frame

    session.backend.read = touching
    outcome = Loop(session, ()).run()
    assert [(fault.source, fault.name) for fault in outcome.faults] == [("feet", "touch something")]


def test_what_stands_may_hang_as_well():
    request = {"activity": "stand", "backend": "mujoco", "overrides": ("hoist=true",)}
    _, outcome, watch = go(duration_s=1.0, **request)
    assert outcome.faults == []
    assert watch.load.max() == 0.0


def test_a_hoisted_plant_hangs_and_cannot_be_let_down():
    robot = load_robot("minibiped", ("hoist=true",))
    plant = Plant(robot, RATE, 0, nominal_motors(robot))
    height = float(plant.truth().base_position[2])
    plant.set_support(False)
    for _ in range(RATE // 2):
        plant.step()
    truth = plant.truth()
    assert truth.base_position[2] == pytest.approx(height, abs=2e-3)
    assert truth.foot_force.max() == 0.0


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"schedules": {"turns": ((2.0, 0.5),)}}, "--turn"),
        ({"schedules": {"pushes": ({"start": 1, "duration": 1, "force": (0, 1, 0)},)}}, "--push"),
        ({"estimator": "truth"}, "--estimator truth"),
    ],
    ids=["turn", "push", "truth"],
)
def test_what_a_robot_in_the_air_cannot_do_is_refused(values, told):
    with pytest.raises(InputError, match=told):
        RunRequest.checked(hoisted=True, **values)


@pytest.mark.parametrize("values", [{"hoisted": True}, {"activity": "stand"}, {"activity": "sit"}])
def test_robots_of_torques_have_no_rungs(values):
    with pytest.raises(InputError, match="robots with servos"):
        build(RunRequest.checked(robot="human", **values))


def test_sit_needs_a_pose_to_sit_in():
    robot = load_robot("minibiped").model_copy(update={"sit": None})
    with pytest.raises(DescriptionError, match="sit: is missing"):
        RunRequest.checked(activity="sit").resolved(robot)


def test_only_simulated_walks_start_in_a_hurry():
    robot = load_robot("minibiped")
    plans = {
        key: start_plan(RunRequest.checked(**values), robot)
        for key, values in {
            "simulated": {},
            "stand": {"activity": "stand"},
            "hoisted": {"live": True, "hoisted": True},
            "ground": {"live": True},
        }.items()
    }
    assert plans["simulated"].ticks(100) == (0, 100, 0, 50)
    assert all(plans[key].ramp_s >= 2.0 and plans[key].hold_s > 0 for key in ("stand", "hoisted"))
    assert (plans["hoisted"].wait_s, plans["ground"].wait_s) == (0.0, 60.0)


@pytest.mark.parametrize(
    ("time_s", "told"),
    [(-62.0, "standing up"), (-30.0, "lower it onto its feet"), (-0.2, "standing up")],
)
def test_the_terminal_says_when_to_lower_the_robot(time_s, told):
    row = np.array([(time_s,)], dtype=[("time_s", float)])[0]
    assert told in describe(row)


def test_no_file_is_read_while_the_servos_watchdogs_wait(monkeypatch):
    session = make_session(live=True, duration_s=0.1)
    session.estimator.estimate.foot_force = np.full((2, 4), 25.7 / 8)

    def weigh(_):
        assert "arm" not in session.backend.journal
        return 25.7

    monkeypatch.setattr("hil.startup.body_weight", weigh)
    outcome = Loop(session, ()).run()
    assert "arm" in session.backend.journal
    assert [fault.name for fault in outcome.faults if fault.reaction != "none"] == []
