"""The whole estimate against the ground truth of the simulated robot."""

import numpy as np
import pytest
from servo_bench import FALLEN, ServoBench, minibiped

from controller.estimation.truth import TruthEstimator
from hil.interface import Reference


def tilt(orientation):
    """Angle between the base's z axis and the vertical [rad]."""
    _, x, y, _ = orientation
    return float(np.arccos(np.clip(1 - 2 * (x * x + y * y), -1, 1)))


def swayed(bench, seconds):
    """Both feet stay down while the pelvis sways and bobs; pairs of estimate and truth."""
    command, rest = bench.hold, bench.hold.position.copy()
    pairs = []
    for tick in range(round(seconds * bench.rate)):
        wave = np.sin(2 * np.pi * tick / bench.rate)
        command.position[[1, 7]] = rest[[1, 7]] + 0.1 * wave
        command.position[[5, 11]] = rest[[5, 11]] - 0.1 * wave
        command.position[[2, 4, 8, 10]] = rest[[2, 4, 8, 10]] - 0.1 * wave
        command.position[[3, 9]] = rest[[3, 9]] + 0.2 * wave
        truth = bench.plant.truth()
        com, speed, base = truth.com.copy(), truth.com_velocity.copy(), truth.base_orientation
        base = base.copy()
        estimate = bench.run()
        pairs.append(
            (estimate.com - com, estimate.com_velocity - speed,
             tilt(estimate.base_orientation) - tilt(base))
        )  # fmt: skip
    return [np.array(column) for column in zip(*pairs, strict=True)]


@pytest.mark.parametrize(("imu", "limit"), [(True, 0.012), (False, 0.025)])
def test_a_scripted_sway_is_followed(imu, limit):
    bench = ServoBench(minibiped(imu=imu))
    bench.stand(0.5)
    place, speed, lean = swayed(bench, 3.0)
    moved = place - place[0]
    assert np.abs(moved).max() < 0.002
    assert np.sqrt((speed**2).mean(axis=0)).max() < limit
    assert np.abs(lean).max() < 0.01


def test_odometry_counts_the_distance_walked():
    bench = ServoBench(minibiped())
    bench.stand(0.5)
    start_true, start = bench.plant.truth().com.copy(), bench.estimator.estimate.com.copy()
    track = bench.walk(7.0, Reference(speed=0.2))
    assert track is not None
    went = track[-1] - start_true
    counted = bench.estimator.estimate.com - start
    assert went[0] > 0.9
    assert counted[0] == pytest.approx(went[0], rel=0.04)
    assert counted[1] == pytest.approx(went[1], abs=0.05)


def test_a_tilted_imu_is_levelled_by_flat_soles():
    bench = ServoBench(minibiped(overrides=("noise.attitude_bias=0.03",)), seed=2)
    bench.stand(0.5)
    measured, truth = bench.backend.read().imu_orientation, bench.plant.truth()
    assert abs(tilt(measured) - tilt(truth.base_orientation)) > 0.01
    assert tilt(bench.estimator.estimate.base_orientation) == pytest.approx(
        tilt(truth.base_orientation), abs=0.004
    )


def test_without_an_imu_it_stands_and_steps():
    bench = ServoBench(minibiped(imu=False))
    bench.stand(0.5)
    assert bench.walk(4.0, Reference(speed=0.0)) is not None


def test_an_imu_that_falls_silent_is_replaced():
    silent = {"now": False}

    def spoil(frame):
        if silent["now"]:
            frame.imu_valid = False
            frame.imu_age_ns = 10**9
            frame.imu_orientation[:] = (0.0, 1.0, 0.0, 0.0)

    bench = ServoBench(minibiped(), spoil=spoil)
    bench.stand(0.5)
    assert bench.walk(3.0, Reference(speed=0.1)) is not None
    silent["now"] = True
    bench.walk(0.5, Reference(speed=0.1))
    truth = bench.plant.truth()
    assert tilt(bench.estimator.estimate.base_orientation) == pytest.approx(
        tilt(truth.base_orientation), abs=0.03
    )


def test_lost_joint_samples_do_not_fell_it():
    rng = np.random.default_rng(1)

    def spoil(frame):
        lost = rng.random(12) < 0.02
        frame.joint_valid[lost] = False
        frame.joint_age_ns[lost] += 3_333_333
        frame.joint_position[lost] = last["position"][lost]
        last["position"][:] = frame.joint_position

    last = {"position": np.array(minibiped().start_position)}
    bench = ServoBench(minibiped(), spoil=spoil)
    bench.stand(0.5)
    track = bench.walk(4.0, Reference(speed=0.15))
    assert track is not None


def test_truth_is_passed_on_with_contact_from_loads():
    bench = ServoBench(minibiped())
    bench.stand(0.5)
    estimator = TruthEstimator(bench.description, bench.plant.truth)
    estimate = estimator.update(bench.backend.read())
    truth = bench.plant.truth()
    np.testing.assert_array_equal(estimate.com, truth.com)
    np.testing.assert_array_equal(estimate.foot_force, truth.foot_force)
    assert estimate.contact.all()
    assert estimate.supply_voltage == pytest.approx(12.0, abs=0.5)
    assert truth.base_position[2] > FALLEN
