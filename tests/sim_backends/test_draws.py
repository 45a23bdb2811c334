"""What a seed hides: drawn alike for every backend, fixed one by one, felt by the plant."""

import numpy as np
import pytest

from hil.errors import DescriptionError, InputError
from hil.interface import SensorFrame
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN
from sim_backends.draws import hidden_values
from sim_backends.plant import Plant
from sim_backends.plant_sensors import PlantSensors
from sim_backends.sensor_models import CellErrors, ImuErrors, dead_cells
from sim_backends.virtual.motors import nominal_motors
from tests.sim_backends.conftest import NOMINAL, goals_at, hold, run

JOINTS = 12


def drawn(seed, *overrides):
    return hidden_values(load_robot("minibiped", overrides), seed)


def test_draws_lie_in_their_ranges_and_differ_from_joint_to_joint():
    ranges = load_robot("minibiped").plant.draws
    found = {key: [] for key in type(ranges).model_fields}
    for seed in range(40):
        for key, value in drawn(seed).as_dict().items():
            found[key] += np.atleast_1d(value).tolist()
    for key, values in found.items():
        low, high = getattr(ranges, key)
        assert low <= min(values) < max(values) <= high
        if key != "floor_height":
            assert max(values) - min(values) > 0.8 * (high - low), key
    assert np.unique(drawn(0).armature).size == JOINTS


def test_a_seed_is_a_robot_and_another_seed_another():
    assert drawn(3).as_dict() == drawn(3).as_dict()
    assert drawn(3).as_dict() != drawn(4).as_dict()


@pytest.mark.parametrize(
    ("override", "name", "value"),
    [
        ("plant.armature=0.02", "armature", [0.02] * JOINTS),
        ("joint_friction=0", "joint_friction", [0.0] * JOINTS),
        ("torque_constant_scale=1.1", "torque_constant_scale", [1.1] * JOINTS),
        ("joint_zero=0.01", "joint_zero", [0.01] * JOINTS),
        ("backlash=0", "backlash", [0.0] * JOINTS),
        ("pitch_bias=0.02", "pitch_bias", 0.02),
        ("supply.resistance=0.3", "supply_resistance", 0.3),
        ("floor_height=0.002", "floor_height", [-0.002, 0.002]),
    ],
)
def test_fixing_one_quantity_leaves_the_others_as_drawn(override, name, value):
    free, fixed = drawn(5).as_dict(), drawn(5, override).as_dict()
    assert fixed.pop(name) == value
    assert fixed == {key: kept for key, kept in free.items() if key != name}


def test_without_draws_the_robot_is_nominal():
    hidden = drawn(5, NOMINAL)
    assert hidden.armature is None
    assert hidden.joint_friction is None
    assert (hidden.torque_constant_scale == 1.0).all()
    for values in (hidden.joint_zero, hidden.backlash, hidden.floor_height):
        assert not np.any(values)
    assert (hidden.pitch_bias, hidden.supply_resistance) == (0.0, 0.1)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("plant.draws={armature: [0.04, 0.01]}", "must not fall"),
        ("plant.draws={armour: [0, 1]}", "valid here: armature, backlash"),
        ("plant.dead_cells=[left_foot:toe]", "left_foot:front_left"),
    ],
)
def test_a_bad_range_or_name_is_bad_input(override, message):
    with pytest.raises((DescriptionError, InputError), match=message):
        load_robot("minibiped", (override,))


def test_armature_and_friction_reach_the_motors_side(make_plant):
    plant = make_plant("plant.draws={armature: [0.01, 0.02], joint_friction: [0.1, 0.2]}")
    np.testing.assert_array_equal(plant.model.dof_armature[6:], plant.hidden.armature)
    np.testing.assert_array_equal(plant.model.dof_frictionloss[6:], plant.hidden.joint_friction)
    slack = make_plant("plant.draws={armature: [0.01, 0.02]}", "backlash=0.01")
    assert (slack.model.dof_armature[6:18] == 0.0).all()
    np.testing.assert_array_equal(slack.model.dof_armature[18:], slack.hidden.armature)


def test_the_torque_constant_scales_torque_and_back_emf_alike(make_plant):
    """At equal duty: stall torque × s and no-load speed / s; the host knows neither."""
    stalls, speeds, told = [], [], []
    for scale in (1.0, 1.25):
        plant = make_plant(
            f"torque_constant_scale={scale}", "joint_friction=0", "armature=0.001",
            "supply.resistance=0",
        )  # fmt: skip
        plant.data.qpos[2] += 1.0
        plant.model.opt.gravity[:] = 0.0
        plant.set_support(True)
        hold(plant)
        plant.servos.set_goals(goals_at(np.full(JOINTS, 3.0), p_gain=16383, pwm_limit=400))
        still = np.zeros(JOINTS)
        plant.servos.drive(plant.joint_position, still, still)
        stalls.append(float(plant.servos.torque()[0]))
        frame = SensorFrame.empty(JOINTS, True)
        PlantSensors(plant, 0).fill(frame, plant.time_ns, np.zeros(JOINTS))
        told.append(float(frame.joint_torque[0]))
        peak = 0.0
        for _ in range(300):
            plant.substep()
            peak = max(peak, float(plant.joint_velocity[0]))
        speeds.append(peak)
    assert stalls[1] / stalls[0] == pytest.approx(1.25, rel=1e-6)
    assert speeds[1] / speeds[0] == pytest.approx(1 / 1.25, rel=0.01)
    assert told[1] == pytest.approx(told[0])


def test_a_joint_zero_error_shows_in_the_encoder_and_turns_the_joint_away(minibiped, make_plant):
    plants = [make_plant(), make_plant("joint_zero=0.02")]
    counts = [plant.servos.counts for plant in plants]
    np.testing.assert_allclose(counts[1] - counts[0], 0.02 * COUNTS_PER_RADIAN, atol=1.0)
    for plant in plants:
        plant.data.qpos[2] += 1.0
        plant.model.opt.gravity[:] = 0.0
        plant.set_support(True)
        hold(plant)
        run(plant, 0.5)
    moved = plants[1].joint_position - plants[0].joint_position
    assert moved.mean() == pytest.approx(-0.02, abs=0.006)


def test_direction_turns_the_zero_error_with_the_servo(minibiped):
    joints = tuple(joint.model_copy(update={"direction": -1}) for joint in minibiped.joints)
    plant_set = minibiped.plant.model_copy(update={"joint_zero": 0.02})
    mirrored = minibiped.model_copy(update={"joints": joints, "plant": plant_set})
    plant = Plant(mirrored, 300, 0, nominal_motors(mirrored))
    frame = SensorFrame.empty(JOINTS, True)
    PlantSensors(plant, 0).fill(frame, 0, np.zeros(JOINTS))
    error = frame.joint_position - plant.joint_position
    np.testing.assert_allclose(error, 0.02, atol=2e-3)


def test_a_pitched_unit_measures_in_turned_axes():
    """Gravity of a level robot then has a part along x, and a yaw rate a part of roll."""
    quiet = load_robot("minibiped").noise.model_copy(
        update=dict.fromkeys(
            ("attitude", "attitude_bias", "gyro", "gyro_bias", "accelerometer"), 0.0
        )
    )
    unit = ImuErrors(quiet, np.random.default_rng(0), 0.1)
    orientation, gyro, force = unit.measure(
        np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 2.0]), np.array([0.0, 0.0, 9.81])
    )
    np.testing.assert_allclose(orientation, [np.cos(0.05), 0.0, np.sin(0.05), 0.0], atol=1e-12)
    np.testing.assert_allclose(force, [-9.81 * np.sin(0.1), 0.0, 9.81 * np.cos(0.1)], atol=1e-12)
    np.testing.assert_allclose(gyro, [-2.0 * np.sin(0.1), 0.0, 2.0 * np.cos(0.1)], atol=1e-12)


def test_pitch_bias_reaches_the_frame(make_plant):
    pitches = []
    for bias in (0.0, 0.02):
        plant = make_plant(f"pitch_bias={bias}")
        frame = SensorFrame.empty(JOINTS, True)
        PlantSensors(plant, 0).fill(frame, 0, np.zeros(JOINTS))
        pitches.append(2 * frame.imu_orientation[2])
    assert pitches[1] - pitches[0] == pytest.approx(0.02, abs=1e-4)


def test_a_dead_cell_reads_its_zero_and_the_others_their_load(minibiped, make_plant):
    description = load_robot("minibiped", (NOMINAL, "dead_cells=[right_foot:rear_left]"))
    assert dead_cells(description, "left") == set()
    assert dead_cells(description, "right") == {2}
    cells = CellErrors(description.noise, np.random.default_rng(0), 4, {2})
    mean = np.mean([cells.measure([5.0] * 4) for _ in range(300)], axis=0)
    np.testing.assert_allclose(mean, [5.0, 5.0, 0.0, 5.0], atol=0.1)
    plant = make_plant("dead_cells=[right_foot:rear_left]")
    hold(plant)
    plant.set_support(False)
    sensors = PlantSensors(plant, 0)
    for _ in range(300 * plant.substeps):
        plant.substep()
        sensors.after_substep()
    frame = SensorFrame.empty(JOINTS, True)
    sensors.fill(frame, plant.time_ns, np.zeros(JOINTS))
    assert abs(frame.foot_force[1, 2]) < 1.5
    assert plant.truth().foot_force[1, 2] > 2.0


def test_pad_stiffness_sets_how_deep_the_soles_sink(make_plant):
    depths = []
    for stiffness in (0.5, 1.0, 2.0):
        plant = make_plant(f"pad_stiffness={stiffness}")
        hold(plant)
        plant.set_support(False)
        run(plant, 1.5)
        depths.append(-np.mean([contact.dist for contact in plant.data.contact]))
    assert depths[0] / depths[1] == pytest.approx(2.0, rel=0.1)
    assert depths[1] / depths[2] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("ticks", [0, 1, 2])
def test_latency_delays_goals_by_whole_ticks(make_plant, ticks):
    plant = make_plant(f"latency_ticks={ticks}")
    hold(plant)
    plant.substep()
    duty = plant.servos.duty[0]
    plant.servos.goal[0] += 100
    late = 0
    while abs(plant.servos.duty[0] - duty) < 0.3:
        plant.substep()
        late += 1
    assert late == 1 + ticks * plant.substeps
