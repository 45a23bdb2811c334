"""Inertia and friction of a swinging joint are found from its lag, and take the lag away."""

import numpy as np
import pytest

from controller.walking.learned_load import LearnedLoad, LearnedLoadConfig

DT, LATE = 1 / 300, 1.49
STIFFNESS, DAMPING, STALL, MODEL_INERTIA = 18.9, 0.851, 4.1, 0.035
SUBSTEPS = 20


def learner(stall=STALL, **changes):
    values = {"memory": 12, "prior": 15, "inertia_bound": 0.02, "friction_bound": 0.3} | changes
    config = LearnedLoadConfig(**values)
    return LearnedLoad(config, [STIFFNESS], [DAMPING], [stall], LATE, DT)


def target(time):
    """Angle, velocity and acceleration of a swing there and back."""
    rate = 2 * np.pi / 0.3
    c, s = np.cos(rate * time), np.sin(rate * time)
    return (
        0.03 * (1 - c) ** 2,
        0.06 * rate * (1 - c) * s,
        0.06 * rate**2 * (s * s + (1 - c) * c),
    )


def swing(load, inertia, friction, leg=0):
    """One swing of a joint whose servo holds goals for a tick; its largest lag [rad]."""
    load.begin(leg)
    angle, speed, worst = 0.0, 0.0, 0.0
    told = (0.0, 0.0, 0.0)
    for tick in range(90):
        time = tick * DT
        q, v, a = (np.array([value]) for value in target(time + LATE * DT))
        torque = MODEL_INERTIA * a + load.torque(leg, v, a)
        load.add(np.array([angle]), q, v, a, torque)
        # Goals act a tick later, and are meant for the middle of the tick in which they act.
        for _ in range(SUBSTEPS):
            goal, lead, feed = told
            drive = STIFFNESS * (goal - angle) + DAMPING * (lead - speed) + feed
            speed += (drive - friction * np.tanh(speed / 0.02)) / inertia * DT / SUBSTEPS
            angle += speed * DT / SUBSTEPS
        told = (float(q[0]), float(v[0]), float(torque[0]))
        worst = max(worst, abs(angle - target(time + DT)[0]))
    return worst


@pytest.mark.parametrize(
    ("inertia", "friction"), [(0.050, 0.05), (0.020, 0.05), (0.035, 0.2), (0.045, 0.15)]
)
def test_it_finds_the_inertia_and_the_lag_goes(inertia, friction):
    load = learner()
    first = swing(load, inertia, friction)
    for _ in range(8):
        last = swing(load, inertia, friction)
    assert load.inertia[0, 0] == pytest.approx(inertia - MODEL_INERTIA, abs=0.003)
    assert last < 0.6 * first


@pytest.mark.parametrize("friction", [0.05, 0.2])
def test_it_finds_the_friction_of_a_joint_that_follows(friction):
    load = learner()
    for _ in range(8):
        swing(load, MODEL_INERTIA, friction)
    assert load.friction[0, 0] == pytest.approx(friction, abs=0.05)
    assert load.inertia[0, 0] == pytest.approx(0.0, abs=0.003)


def test_legs_are_learnt_apart():
    load = learner()
    for _ in range(5):
        swing(load, 0.050, 0.05, leg=1)
    swing(load, MODEL_INERTIA, 0.0, leg=0)
    assert load.inertia[1, 0] > 0.01
    assert load.inertia[0, 0] == 0.0


def test_nothing_is_learnt_beyond_the_bounds():
    load = learner(inertia_bound=0.003, friction_bound=0.02)
    for _ in range(8):
        swing(load, 0.050, 0.1)
    assert load.inertia[0, 0] == 0.003
    assert load.friction[0, 0] == 0.02


def test_a_saturated_servo_teaches_nothing():
    load = learner(stall=0.001)
    for _ in range(5):
        swing(load, 0.050, 0.2)
    assert abs(load.inertia[0, 0]) < 0.002


def test_a_swing_of_a_few_ticks_teaches_nothing():
    load = learner()
    load.begin(0)
    for _ in range(3):
        load.add(*np.ones((5, 1)))
    load.begin(1)
    assert not load.inertia.any()
    assert not load.friction.any()
