"""The plant: weights on corners, fresh truth, support, pushes, and what is refused."""

import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest

from hil.errors import BackendError, InputError
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors
from tests.sim_backends.conftest import hold, run

GRAVITY = 9.81


def standing(plant):
    hold(plant)
    plant.set_support(False)
    run(plant, 2.0)
    return plant


@pytest.mark.parametrize("rate", [300, 225])
def test_eight_corners_carry_the_weight_of_the_standing_minibiped(make_plant, rate):
    plant = standing(make_plant(rate=rate))
    weight = plant.model.body_mass.sum() * GRAVITY
    force = plant.truth().foot_force
    assert force.sum() == pytest.approx(weight, rel=0.03)
    assert (force > 0).all()
    assert force[0].sum() == pytest.approx(force[1].sum(), rel=0.05)


def test_soles_and_toes_of_the_human_carry_its_weight():
    """Stiffened like a statue: standing is the controller's work, not the plant's."""
    plant = Plant(load_robot("human"), 300)
    weight = plant.model.body_mass.sum() * GRAVITY
    plant.model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    plant.model.jnt_stiffness[1:] = 3000.0
    plant.model.dof_damping[6:] = 60.0
    plant.model.qpos_spring[7:] = plant.data.qpos[7:]
    run(plant, 0.4)
    plant.set_push(np.array([60.0, 0.0, 0.0]))  # onto the toes
    run(plant, 0.3)
    total = []
    for _ in range(30):
        plant.step()
        truth = plant.truth()
        total.append(truth.foot_force.sum() + truth.toe_force.sum())
    assert np.mean(total) == pytest.approx(weight, rel=0.03)
    assert truth.toe_force.sum() > 0


@pytest.mark.parametrize(
    ("push", "loaded"),
    [
        ((1.0, 0.0, 0.0), ([0, 1], [0, 1])),
        ((-1.0, 0.0, 0.0), ([0, 1], [2, 3])),
        ((0.0, 2.0, 0.0), ([0, 0], [0, 2])),
        ((0.0, -2.0, 0.0), ([1, 1], [1, 3])),
    ],
    ids=["forward", "backward", "left", "right"],
)
def test_corners_are_in_order_when_the_robot_leans(make_plant, push, loaded):
    """A push loads the corners on its side: both feet's front or rear, or the outer ones."""
    plant = standing(make_plant())
    before = plant.truth().foot_force.copy()
    plant.set_push(np.array(push))
    run(plant, 0.4)
    gain = plant.truth().foot_force - before
    feet, corners = loaded
    for foot, corner in zip([0, 1] if push[0] else feet[:1] * 2, corners, strict=True):
        pair = [corner, corner ^ 1] if push[0] else [corner]
        assert gain[foot, pair].sum() > 0.3


def test_loads_are_the_same_with_a_pyramidal_cone(make_plant):
    weights = []
    for cone in (mujoco.mjtCone.mjCONE_ELLIPTIC, mujoco.mjtCone.mjCONE_PYRAMIDAL):
        plant = make_plant()
        plant.model.opt.cone = cone
        plant._loads._elliptic = cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        weights.append(standing(plant).truth().foot_force.sum())
    assert weights[1] == pytest.approx(weights[0], rel=0.01)


def test_loads_agree_with_mujoco_contact_forces(make_plant):
    plant = standing(make_plant())
    plant.substep()
    wrench = np.zeros(6)
    total = 0.0
    for contact in range(plant.data.ncon):
        mujoco.mj_contactForce(plant.model, plant.data, contact, wrench)
        total += wrench[0]
    assert plant.foot_force().sum() == pytest.approx(total, rel=1e-9)


def test_truth_is_of_the_new_state(make_plant):
    """Everything must fit qpos and qvel as they are now, not as they were a substep ago."""
    plant = make_plant()
    hold(plant, np.array(plant.description.start_position) + 0.3)
    run(plant, 0.05)
    truth = plant.truth()
    fresh = mujoco.MjData(plant.model)
    fresh.qpos[:], fresh.qvel[:] = plant.data.qpos, plant.data.qvel
    mujoco.mj_forward(plant.model, fresh)
    mujoco.mj_subtreeVel(plant.model, fresh)
    np.testing.assert_allclose(truth.com, fresh.subtree_com[1], atol=1e-12)
    np.testing.assert_allclose(truth.com_velocity, fresh.subtree_linvel[1], atol=1e-12)
    np.testing.assert_array_equal(truth.joint_position, fresh.qpos[7:])
    assert truth.time_ns == plant.time_ns == 50_000_000


def test_looking_at_the_truth_does_not_change_it(make_plant):
    plants = [make_plant(), make_plant()]
    for plant in plants:
        hold(plant)
        plant.set_support(False)
    for _ in range(60):
        for plant in plants:
            plant.step()
        plants[0].truth()
        plants[0].foot_force()
    np.testing.assert_array_equal(plants[0].data.qpos, plants[1].data.qpos)


def test_it_starts_with_the_lowest_sole_point_on_the_floor(make_plant):
    plant = make_plant()
    lowest = min(contact.dist for contact in plant.data.contact)
    assert lowest == pytest.approx(0.0, abs=1e-6)
    assert plant.data.ncon >= 4  # a pose rounded to 0.1 mrad stands on its toes or heels


def test_a_moving_start_has_the_commanded_velocity():
    plant = Plant(load_robot("human"), 300, initial_velocity=(0.5, 0.1))
    np.testing.assert_allclose(plant.truth().base_linear_velocity, [0.5, 0.1, 0.0])
    np.testing.assert_allclose(plant.truth().com_velocity, [0.5, 0.1, 0.0], atol=1e-9)


def test_support_holds_a_limp_robot_and_lets_it_go(make_plant):
    plant = make_plant()
    start = plant.truth().base_position.copy()
    run(plant, 1.0)
    np.testing.assert_allclose(plant.truth().base_position, start, atol=2e-3)
    plant.set_support(False)
    run(plant, 1.0)
    assert plant.truth().base_position[2] < 0.6 * start[2]


def test_support_can_take_hold_again_where_the_robot_is(make_plant):
    plant = make_plant()
    plant.set_support(False)
    run(plant, 0.2)
    plant.set_support(True)
    held = plant.truth().base_position.copy()
    run(plant, 0.5)
    np.testing.assert_allclose(plant.truth().base_position, held, atol=0.02)


def test_a_push_changes_the_momentum_by_its_impulse(make_plant):
    """In the air nothing else acts sideways: m·Δv = F·Δt."""
    plant = make_plant()
    plant.data.qpos[2] += 5.0
    plant.set_support(False)
    plant.set_push(np.array([3.0, -2.0, 0.0]))
    run(plant, 0.3)
    mass = plant.model.body_mass.sum()
    np.testing.assert_allclose(
        plant.truth().com_velocity[:2], np.array([3.0, -2.0]) * 0.3 / mass, rtol=1e-3
    )


def test_overrides_reach_the_physics(make_plant):
    plain = make_plant()
    heavy = make_plant("mass_scale=1.25", "floor_friction=0.4", "armature=0.012")
    root = plain.model.body("torso").id
    assert heavy.model.body_mass[root] == pytest.approx(1.25 * plain.model.body_mass[root])
    assert (heavy.model.dof_armature[6:] == 0.012).all()
    hold(heavy)
    heavy.set_support(False)
    run(heavy, 0.5)
    np.testing.assert_allclose(heavy.data.contact.friction[:, 0], 0.4)


def test_divergence_is_an_error_not_a_reset(make_plant):
    plant = make_plant()
    plant.data.qvel[:] = 1e7
    with pytest.raises(BackendError, match="diverged at"):
        run(plant, 0.1)


def test_a_servo_robot_needs_motors_and_a_torque_robot_takes_none(minibiped):
    with pytest.raises(InputError, match="takes motor parameters"):
        Plant(minibiped, 300)
    with pytest.raises(InputError, match="takes no motor parameters"):
        Plant(load_robot("human"), 300, motors=nominal_motors(minibiped))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("root: torso", "root: pelvis", "no body 'pelvis'; there are: .*torso"),
        ("root: torso", "root: left_foot", "has no free joint"),
        ("site: imu", "site: gyro", "no site 'gyro'; there are: imu"),
        ("sole: left_sole", "sole: left_shoe", "no geom 'left_shoe'; there are: .*left_sole"),
        ("model: minibiped.xml", "model: missing.xml", "no such file"),
        ("model: minibiped.xml", "model: minibiped.yaml", "is not valid MJCF"),
    ],
)
def test_a_description_that_does_not_fit_its_mjcf_is_bad_input(
    minibiped, tmp_path, old, new, message
):
    source = Path(minibiped.file)
    shutil.copy(minibiped.model_path, tmp_path)
    file = tmp_path / source.name
    file.write_text(source.read_text().replace(old, new))
    description = load_robot(str(file))
    with pytest.raises(InputError, match=message):
        Plant(description, 300, motors=nominal_motors(description))
