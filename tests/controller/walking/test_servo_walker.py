"""minibiped walks on its sensors, and does not without the parts that make it walk."""

import numpy as np
import pytest
from servo_bench import ServoBench, mean_speed, minibiped, walk

from controller.walking.servo_config import servo_walking_config
from controller.walking.servo_walker import ServoWalker
from hil.errors import DescriptionError
from hil.interface import Reference


@pytest.mark.parametrize(("rate", "seed"), [(300, 0), (225, 1)])
def test_it_walks_at_the_commanded_speed(rate, seed):
    bench, track = walk(7.0, 0.15, rate, seed)
    assert track is not None, "fell"
    forward, sideways = mean_speed(track, rate, 4.0)
    assert forward == pytest.approx(0.15, rel=0.1)
    assert abs(sideways) < 0.02
    assert 15 < bench.walker.status.steps < 30


def test_speed_zero_walks_in_place():
    bench, track = walk(5.0, 0.0)
    assert track is not None, "fell"
    assert bench.walker.status.steps > 12
    assert np.abs(track[:, 0]).max() < 0.05


def test_it_walks_backwards_and_sideways():
    _, track = walk(6.0, -0.1, lateral=0.05)
    assert track is not None, "fell"
    backward, left = mean_speed(track, 300, 3.0)
    assert backward == pytest.approx(-0.1, abs=0.02)
    assert left == pytest.approx(0.05, abs=0.02)


def test_lateral_speed_is_corrected_once_a_stride():
    """The integral over a stride: two steps, for one of them always sways the other way."""
    wrong = [("lateral_alteration.bounds", [-0.05, 0.05]), ("lateral_alteration.start", 0.02)]
    bench = ServoBench(minibiped(wrong))
    bench.stand(0.5)
    reference, offset, moved = Reference(speed=0.0, lateral=0.08), 0.02, []
    for _ in range(5 * 300):
        bench.run(reference)
        step = bench.walker._step
        value = step._alterations[1].value
        if value != offset:
            moved.append((step.gait.steps, value - offset))
            offset = value
    steps = [number for number, _ in moved]
    assert len(steps) > 4
    assert np.all(np.diff(steps) == 2)
    # With that pivot the walk is slower than asked.
    assert offset < 0.01


def test_it_turns_to_the_commanded_heading():
    bench, track = walk(6.5, 0.1, heading=np.pi / 2)
    assert track is not None, "fell"
    w, x, y, z = bench.plant.truth().base_orientation
    heading = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    assert heading == pytest.approx(np.pi / 2, abs=0.06)
    assert bench.walker.status.heading == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("direction", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_it_survives_a_push(direction):
    def pushed(time):
        return (2.0 * direction[0], 2.0 * direction[1], 0.0) if 3.0 <= time < 3.3 else (0, 0, 0)

    _, track = walk(5.5, 0.1, pushed=pushed)
    assert track is not None, "fell"


def test_a_loaded_stance_foot_is_flat():
    bench = ServoBench(minibiped())
    bench.stand(0.5)
    reference, weight = Reference(speed=0.2), bench.plant.model.body_mass.sum() * 9.81
    flat = []
    for tick in range(7 * 300):
        bench.run(reference)
        status = bench.walker.status
        if tick > 4 * 300 and 0.25 < status.phase < 0.9:
            corners = bench.plant.foot_force()[status.stance]
            flat.append(np.count_nonzero(corners > 0.0145 * weight) >= 3)
    assert np.mean(flat) > 0.95


@pytest.mark.parametrize(
    "change",
    [
        ("balance.torque_gain", 0.0),
        ("placement.gain_x", 0.4),
        ("swing.height", 0.002),
        ("latency", 0.08),
    ],
    ids=lambda change: change[0],
)
def test_without_what_makes_it_walk_it_falls_or_stalls(change):
    _, track = walk(6.0, 0.2, walking=[change])
    assert track is None or mean_speed(track, 300, 4.0)[0] < 0.1


def test_the_command_is_unshifted_and_carries_the_descriptions_gains():
    bench = ServoBench(minibiped())
    estimate = bench.run()
    command = bench.walker.step(estimate, Reference())
    np.testing.assert_allclose(command.stiffness, bench.hold.stiffness)
    np.testing.assert_allclose(command.damping, bench.hold.damping)
    np.testing.assert_allclose(command.position, bench.hold.position, atol=0.03)
    assert not bench.walker.status.walking


def test_ankle_limit_bounds_the_pressure_inside_the_sole():
    description = minibiped()
    config = servo_walking_config(description).balance
    limited = ServoWalker(description, 300)._step.balance._limit
    free = ServoWalker(description, 300, ankle_limit=False)._step.balance._limit
    assert free == pytest.approx((0.05, 0.036))
    assert limited == pytest.approx((0.05 * config.limit_x, 0.036 * config.limit_y))


@pytest.mark.parametrize(
    ("walking", "key"),
    [
        (("balance.gain_z", 1.0), "walking.balance.gain_z"),
        (("gait.period", "fast"), "walking.gait.period"),
        (("swing.height", -0.1), "walking.swing.height"),
    ],
)
def test_a_wrong_walking_section_is_named(walking, key):
    with pytest.raises(DescriptionError, match=key):
        ServoWalker(minibiped([walking]), 300)


def test_a_robot_without_six_leg_joints_is_refused():
    description = minibiped()
    short = description.model_copy(update={"joints": description.joints[:-1]})
    with pytest.raises(DescriptionError, match="right_ankle_roll"):
        ServoWalker(short, 300)


def test_the_swing_leg_is_asked_for_no_more_than_its_servos_can_do():
    bench = ServoBench(minibiped())
    share = bench.walker.config.governor.share
    fastest = 0.0
    for tick in range(4 * 300):
        bench.run(Reference(speed=0.3))
        if tick > 2 * 300:
            swing = bench.walker._legs[1 - bench.walker.status.stance][2:5]
            fastest = max(fastest, float(np.abs(bench.walker._command.velocity[swing]).max()))
    assert 2.0 < fastest <= share * 4.82 * 1.02


def test_a_robot_with_wrong_joint_zeros_learns_its_soles_and_its_com():
    bench = ServoBench(minibiped(overrides=("plant.joint_zero=0.012",)))
    for _ in range(5 * 300):
        bench.run(Reference(speed=0.1))
    step = bench.walker._step
    assert np.abs(step.sole_trim.value).max() > 0.003
    assert np.abs(step.trim.value).max() > 0.0005
    with_trim = step.landing
    step.trim.value = [0.0, 0.0]
    step.gait.phase = 0.5
    bench.run(Reference(speed=0.1))
    assert step.landing != pytest.approx(with_trim, abs=2e-4)


def test_a_sideways_fall_leaves_the_swing_foot_the_time_that_its_way_takes():
    bench = ServoBench(minibiped())
    step = bench.walker._step
    while not (step.gait.steps > 10 and 0.2 < step.gait.phase < 0.3):
        bench.run(Reference(speed=0.25))
    x, _ = step.state.capture
    step.state.capture = (x, 0.05 * step.gait.stance_sign)  # beyond the outside of the foot
    ankles = bench.walker._model.ankles
    stands, goal = ankles[step.gait.swing][0] - ankles[step.gait.stance][0], step.landing[0]
    time = step._set_phase_rate(0.0)
    assert time == pytest.approx((goal - stands) / bench.walker.config.timing.swing_speed, abs=2e-3)
    assert time > bench.walker.config.timing.min_time - step.gait.time_in_step + 0.01


def test_the_governor_counts_no_inertia_twice_that_was_learnt():
    bench = ServoBench(minibiped())
    for _ in range(5 * 300):
        bench.run(Reference(speed=0.2))
    walker = bench.walker
    told = np.array([walker._governor._limits[joint][0] for joint in (2, 4)])
    known = walker._inertia.at_rest(walker._rest)
    for leg in range(2):
        learnt = told + walker._load.inertia[leg][[0, 2]]
        np.testing.assert_allclose(learnt, [known[2], known[4]], rtol=0.14)
