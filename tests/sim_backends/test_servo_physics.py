"""Servo physics: the motor's two numbers, the drive, the supply, torque off, totals."""

import mujoco
import numpy as np
import pytest

from hil.servo import COUNTS_PER_RADIAN
from sim_backends.servo_heat import AMBIENT
from tests.sim_backends.conftest import goals_at, hold, run

NO_LOAD = 46 * 2 * np.pi / 60
STALL = 4.1
KNEE = 3


@pytest.fixture
def hanging(make_plant):
    """Held high in the air, supply without resistance, so that nothing else moves a joint."""

    def make(*overrides):
        plant = make_plant("supply.resistance=0.0", *overrides)
        plant.data.qpos[2] += 1.0
        plant.set_support(True)
        return plant

    return make


def test_a_step_reaches_the_no_load_speed_of_the_data_sheet(hanging):
    """Frictionless and light, at full duty: 46 rev/min at 12 V, and not more."""
    plant = hanging("joint_friction=0.0", "armature=0.001")
    plant.model.opt.gravity[:] = 0.0
    hold(plant)
    run(plant, 0.2)
    plant.servos.goal[0] += 1.2 * COUNTS_PER_RADIAN
    peak = 0.0
    for _ in range(400):
        plant.substep()
        peak = max(peak, float(plant.joint_velocity[0]))
    assert peak == pytest.approx(NO_LOAD, rel=0.02)


def test_a_blocked_motor_gives_the_stall_torque_of_the_data_sheet(hanging):
    plant = hanging()
    hold(plant)
    plant.servos.goal[KNEE] = 4095
    plant.substep()
    plant.data.qvel[:] = 0.0
    plant.data.ctrl[:] = plant.servos.drive(
        plant.joint_position, plant.joint_velocity, plant.joint_velocity
    )
    mujoco.mj_fwdActuation(plant.model, plant.data)
    assert plant.data.qfrc_actuator[6 + KNEE] == pytest.approx(STALL, rel=0.01)
    assert plant.servos.torque()[KNEE] == pytest.approx(STALL, rel=0.01)


def test_dcmotor_moves_as_the_two_number_model(hanging):
    """MuJoCo's dcmotor against a general actuator of gain k/R and back-EMF damping k²/R."""
    plant = hanging()
    motors = plant.servos.motors
    other = mujoco.MjModel.from_xml_path(str(plant.description.model_path))
    spec = mujoco.MjSpec.from_file(str(plant.description.model_path))
    for j, name in enumerate(plant.description.joint_names):
        gain = motors.torque_constant[j] / motors.resistance[j]
        spec.add_actuator(
            name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gainprm=[gain] + [0] * 9, biastype=mujoco.mjtBias.mjBIAS_AFFINE,
            biasprm=[0, 0, -gain * motors.torque_constant[j]] + [0] * 7,
        )  # fmt: skip
    other = spec.compile()
    other.opt.timestep = plant.model.opt.timestep
    data = mujoco.MjData(other)
    plant.set_support(False)
    data.qpos[:], data.qvel[:] = plant.data.qpos, plant.data.qvel
    hold(plant)
    plant.servos.goal[:] += 200
    plant.data.ctrl[:] = plant.servos.drive(
        plant.joint_position, plant.joint_velocity, plant.joint_velocity
    )
    for _ in range(60):  # before the windings are looked at, which warm up
        data.ctrl[:] = plant.data.ctrl
        mujoco.mj_step(other, data)
        plant.substep()
    np.testing.assert_allclose(plant.data.qpos, data.qpos, atol=1e-9)


def test_stiffness_is_what_the_gain_formula_says(hanging):
    """Hanging still with an outside torque, K = P/128·(4096/2π)/885·stall (e-manual)."""
    plant = hanging("joint_friction=0.0")
    plant.model.opt.gravity[:] = 0.0
    hold(plant)
    run(plant, 0.3)
    rest = plant.joint_position[KNEE]
    plant.data.qfrc_applied[6 + KNEE] = 1.0
    run(plant, 1.0)
    expected = 800 / 128 * COUNTS_PER_RADIAN / 885 * STALL
    assert 1.0 / (plant.joint_position[KNEE] - rest) == pytest.approx(expected, rel=0.05)


def test_torque_off_opens_the_terminals(hanging):
    """A driven motor brakes with its back-EMF; one that is off turns against friction alone."""
    speeds = []
    for on in (True, False):
        plant = hanging("joint_friction=0.0")
        plant.model.opt.gravity[:] = 0.0
        hold(plant)
        plant.servos.set_goals(goals_at(plant.joint_position, p_gain=0))
        for servo in range(12):
            plant.servos.set_enabled(servo, on)
        plant.data.qvel[6] = 2.0
        run(plant, 0.1)
        speeds.append(float(plant.joint_velocity[0]))
    assert speeds[0] < 0.2
    assert speeds[1] == pytest.approx(2.0, abs=0.2)
    assert plant.servos.duty[0] == 0.0
    assert plant.servos.current[0] == 0.0


def test_the_pwm_limit_bounds_the_drive(hanging):
    plant = hanging()
    hold(plant)
    plant.servos.set_goals(goals_at(np.full(12, 3.0), pwm_limit=300))
    plant.substep()
    plant.substep()
    np.testing.assert_allclose(plant.servos.duty, 300 / 885)


def test_load_pulls_the_supply_down(make_plant):
    plant = make_plant("supply.resistance=0.2")
    hold(plant, np.array(plant.description.start_position) + 1.0)
    for _ in range(4):
        plant.substep()
    servos = plant.servos
    current = float(servos.duty @ servos.current)
    assert current > 5.0
    assert servos.voltage == pytest.approx(12.0 - 0.2 * current)
    assert servos.totals().voltage_min < 11.0


def test_direction_turns_the_servo_not_the_joint(minibiped, make_plant):
    """With direction -1 the same joint angle is the mirrored count, and the loop is stable."""
    from sim_backends.plant import Plant
    from sim_backends.virtual.motors import nominal_motors

    joints = tuple(joint.model_copy(update={"direction": -1}) for joint in minibiped.joints)
    description = minibiped.model_copy(update={"joints": joints})
    plant = Plant(description, 300, 0, nominal_motors(description))
    hold(plant, -np.array(description.start_position))
    run(plant, 0.5)
    np.testing.assert_allclose(plant.joint_position, description.start_position, atol=0.1)


def test_a_loaded_motor_warms_and_an_idle_one_does_not(hanging):
    """Blocked at full duty: 12²/7.3 W into a winding of 1 J/K, and from there into the case."""
    plant = hanging()
    hold(plant)
    plant.servos.goal[KNEE] = 4095
    run(plant, 1.0)
    heat = plant.servos.heat
    assert AMBIENT + 5.0 < heat.winding[KNEE] < AMBIENT + 20.0
    assert heat.case[KNEE] > AMBIENT + 0.005
    assert heat.winding[0] == pytest.approx(AMBIENT, abs=0.05)


def test_totals_count_what_happened(hanging):
    plant = hanging()
    hold(plant)
    run(plant, 0.5)
    quiet = plant.servos.totals()
    plant.servos.goal[KNEE] = 4095
    run(plant, 0.5)
    busy = plant.servos.totals()
    assert quiet.saturation[KNEE] == 0.0
    assert busy.saturation[KNEE] > 0.3
    assert busy.saturation[0] == 0.0
    assert busy.energy > quiet.energy
    assert 0.3 < busy.torque_rms_ratio[KNEE] < 1.0
