"""The closed-form ceiling of gains against the whole discrete loop, and against a stored table."""

import numpy as np
import pytest

from controller.walking.gain_ceiling import GainCeiling, largest_factor, largest_share
from controller.walking.linear_stance import LinearStance, StancePose
from controller.walking.servo_ceiling import ServoCeiling, delayed_bound
from hil.robot_files import load_robot

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
BENT_ARMS = {"shoulder_roll": 0.3, "elbow": 1.5}
"""Near the pose of a walk, whose hands are held before the chest."""


@pytest.fixture(scope="module")
def sets(human):
    return {
        rate: {joint: tuple(map(float, pair)) for joint, pair in gains.items()}
        for rate, gains in human.walking["gains"].items()
    }


@pytest.fixture(scope="module")
def pose(human):
    """Elbows bent as in walking, the left foot on the floor."""
    joints = np.array(human.start_position)
    for name, angle in BENT_ARMS.items():
        joints[human.joint_names.index(f"left_{name}")] = -angle
        joints[human.joint_names.index(f"right_{name}")] = angle
    return StancePose(UPRIGHT, joints, 0.0, 0)


def spectral_radius(stance, gains, rate_hz):
    """Of semi-implicit Euler with all gains, the root's rate averaged over two ticks."""
    h, m = 1.0 / rate_hz, len(stance.mass)
    kp, kd = np.array([gains[row] for row in stance.rows]).T
    root = np.array([row == "root" for row in stance.rows])
    stiff = np.linalg.solve(stance.mass, stance.matrix(kp))
    own = np.linalg.solve(stance.mass, stance.matrix(kd * ~root))
    mean = np.linalg.solve(stance.mass, stance.matrix(kd * root)) / 2.0
    one, nil = np.eye(m), np.zeros((m, m))
    velocity = np.hstack((-h * stiff, one - h * (own + mean), -h * mean))
    position = np.hstack((one, nil, nil)) + h * velocity
    last = np.hstack((nil, one, nil))
    values = np.linalg.eigvals(np.vstack((position, velocity, last)))
    return float(np.abs(values).max())


@pytest.mark.parametrize("rate", [300, 225])
def test_the_ceiling_is_where_the_discrete_loop_begins_to_grow(human, sets, pose, rate):
    factor = float(GainCeiling(human, [pose]).whole(sets[rate], rate)[0])
    stance = LinearStance(human)
    stance.place(pose)
    for share, grows in ((0.98, False), (1.02, True)):
        gains = {
            j: (share * factor * kp, share * factor * kd) for j, (kp, kd) in sets[rate].items()
        }
        assert (spectral_radius(stance, gains, rate) > 1.001) is grows


@pytest.mark.parametrize("joint", ["shoulder", "knee", "hip", "ankle", "toe"])
def test_the_ceiling_of_one_joint_is_where_the_discrete_loop_begins_to_grow(
    human, sets, pose, joint
):
    factor = float(GainCeiling(human, [pose]).alone(sets[300], joint, 300)[0])
    stance = LinearStance(human)
    stance.place(pose)
    for share, grows in ((0.98, False), (1.02, True)):
        kp, kd = sets[300][joint]
        gains = sets[300] | {joint: (share * factor * kp, share * factor * kd)}
        assert (spectral_radius(stance, gains, 300) > 1.001) is grows


def test_published_sets_sit_just_below_the_ceiling_of_their_rate(human, sets, pose):
    """0 to 30 % below at all rates but 750 Hz, and s·rate is constant for one set."""
    ceiling = GainCeiling(human, [pose])
    found = {rate: float(ceiling.whole(gains, rate)[0]) for rate, gains in sets.items()}
    assert all(0.98 < factor < 1.35 for rate, factor in found.items() if rate != 750)
    assert 1.35 < found[750] < 1.8
    doubled = float(ceiling.whole(sets[300], 600)[0])
    assert doubled == pytest.approx(2.0 * found[300], rel=0.05)


def test_stretched_arms_and_bare_joints_lower_the_ceiling(human, sets, pose):
    """A bent forearm turns with the upper arm's axis, a rotor with its joint: both are mass."""
    stretched = StancePose(UPRIGHT, np.zeros_like(pose.joint_position), 0.0, 0)
    straight = float(GainCeiling(human, [stretched]).whole(sets[300], 300)[0])
    ceiling = GainCeiling(human, [pose])
    bent = float(ceiling.whole(sets[300], 300)[0])
    robot = ceiling._stance._robot
    robot.model.dof_armature[robot.dof_addresses] = 0.01
    assert straight < 0.6 * bent
    assert float(ceiling.whole(sets[300], 300)[0]) > 1.25 * bent


def test_a_foot_in_the_air_has_the_same_ceiling(human, sets, pose):
    """The arms decide it, which do not feel whether the foot is on the floor."""
    standing = GainCeiling(human, [pose]).whole(sets[300], 300)
    flying = GainCeiling(human, [pose], welded=False).whole(sets[300], 300)
    assert flying == pytest.approx(standing, rel=0.02)


def test_one_mass_on_one_damper():
    """v⁺ = (1 − h·d/m)·v grows beyond d = 2·m/h."""
    mass, damping = np.array([[3.0]]), np.array([[4.0]])
    assert largest_factor(mass, damping, 0.01) == pytest.approx(2.0 * 3.0 / (0.01 * 4.0))
    rest = np.array([[100.0]])
    assert largest_share(mass, damping, rest, 0.01) == pytest.approx((600.0 - 100.0) / 4.0)
    assert largest_share(mass, damping, 7.0 * rest, 0.01) == 0.0
    assert largest_share(mass, 0.0 * damping, rest, 0.01) == float("inf")


@pytest.mark.parametrize("ticks", [0, 1, 2, 3])
def test_delayed_damping_grows_beyond_its_bound(ticks):
    for share, grows in ((0.97, False), (1.03, True)):
        a = share * delayed_bound(ticks)
        velocity = [1.0] * (ticks + 1)
        for _ in range(4000):
            velocity.append(velocity[-1] - a * velocity[-1 - ticks])
        assert (max(map(abs, velocity[-20:])) > 1.0) is grows


def test_servo_ceiling_rises_with_the_rotor_and_the_rate():
    robot = load_robot("minibiped")
    pose = StancePose(UPRIGHT, np.array(robot.start_position), 0.0, 0)
    light, heavy = (ServoCeiling(robot, [pose], rotor) for rotor in (0.012, 0.045))
    assert (light.mobility > heavy.mobility).all()
    assert light.mobility.max() < 1.0 / 0.012  # the link adds to the rotor
    assert (light.host_damping(300, 0.003) > light.host_damping(225, 0.003)).all()
    assert (light.host_damping(300, 0.003) > light.host_damping(300, 0.004)).all()
    assert light.stiffness(1e-3) == pytest.approx(4e6 / light.mobility)
