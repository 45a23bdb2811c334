"""Heat, overload and wrong supply: what a servo endures, and what ends its torque."""

import numpy as np
import pytest

from sim_backends.pack_supply import PackSupply
from sim_backends.servo_heat import AMBIENT, ServoHeat
from sim_backends.servo_protection import (
    FACTORY_SHUTDOWN,
    INPUT_VOLTAGE,
    OVERHEATING,
    OVERLOAD,
    ServoProtection,
)
from sim_backends.virtual.motors import Motor, MotorBank, servo_models
from tests.sim_backends.conftest import hold, run

KNEE = 3
BLOCK_S = 0.1


def seconds_to_trip(load, longest=60.0):
    protection = ServoProtection(1)
    for block in range(round(longest / BLOCK_S)):
        protection.judge(np.array([load]), np.array([AMBIENT]), 12.0, BLOCK_S)
        if protection.tripped():
            return (block + 1) * BLOCK_S
    return None


def test_an_overload_trips_after_the_time_that_was_seen():
    """DynamixelSDK issue 285: an XM430-W350 at 941 mA of 2.3 A trips after about 5 s."""
    assert seconds_to_trip(0.941 / 2.3) == pytest.approx(5.0, abs=0.5)
    assert seconds_to_trip(1.0) == pytest.approx(0.9, abs=0.2)
    assert seconds_to_trip(0.3) is None


def test_short_peaks_are_no_overload():
    protection = ServoProtection(1)
    for block in range(600):
        load = 1.0 if block % 5 == 0 else 0.0
        protection.judge(np.array([load]), np.array([AMBIENT]), 12.0, BLOCK_S)
    assert not protection.tripped()
    assert 0.2 < protection.highest_load[0] < 0.38


def test_only_the_shutdown_mask_ends_the_torque():
    protection = ServoProtection(2)
    protection.lowest_voltage[:] = 9.5
    protection.shutdown[1] = INPUT_VOLTAGE
    protection.judge(np.zeros(2), np.array([81.0, AMBIENT]), 9.0, BLOCK_S)
    assert protection.errors.tolist() == [INPUT_VOLTAGE | OVERHEATING, INPUT_VOLTAGE]
    assert protection.tripped() == [0, 1]
    protection.shutdown[:] = 0
    assert protection.tripped() == []


def test_winding_and_case_settle_where_their_resistances_put_them():
    """P·(R_wc + R_ca) and P·R_ca above the air; the winding first, in seconds."""
    heat = ServoHeat(np.array([5.0]))
    for _ in range(200):
        heat.advance(np.array([0.2]), 0.05)
    assert heat.winding[0] > AMBIENT + 4.0
    assert heat.case[0] < AMBIENT + 0.2
    for _ in range(40000):
        heat.advance(np.array([0.2]), 0.1)
    loss = 0.2 * heat.resistance[0]
    assert heat.case[0] == pytest.approx(AMBIENT + 5.0 * loss, rel=0.01)
    assert heat.winding[0] == pytest.approx(AMBIENT + 11.0 * loss, rel=0.01)
    assert heat.resistance[0] == pytest.approx(5.0 * (1 + 0.00393 * 11.0 * loss), rel=0.01)


def test_a_servo_of_twice_the_size_warms_half_as_much_by_the_same_loss():
    one, two = ServoHeat(np.array([5.0])), ServoHeat(np.array([5.0]), np.array([2.0]))
    for _ in range(2000):
        one.advance(np.array([0.05]), 0.05)
        two.advance(np.array([0.05]), 0.05)
    assert two.case[0] - AMBIENT == pytest.approx((one.case[0] - AMBIENT) / 2, rel=0.02)


@pytest.fixture
def desk(in_the_air):
    def make(*overrides):
        plant = in_the_air(*overrides, gravity=True)
        bank = MotorBank(plant, plant.servos, servo_models(plant.description))
        return plant, Motor(bank, KNEE)

    return make


def test_a_hot_winding_gives_less_torque(desk):
    """100 K more copper temperature: 39 % more resistance, that much less stall torque."""
    plant, motor = desk()
    motor.set_goal(4095)
    still = np.zeros(12)
    torques = []
    for degrees in (AMBIENT, AMBIENT + 100.0):
        plant.servos.heat.winding[:] = degrees
        run(plant, 0.25)
        plant.servos.drive(plant.joint_position, still, still)
        torques.append(float(plant.servos.torque()[KNEE]))
    assert torques[1] / torques[0] == pytest.approx(1 / 1.393, rel=0.06)
    assert plant.model.actuator_gainprm[KNEE, 0] > 1.3 * plant.servos.motors.resistance[KNEE]


def test_a_blocked_joint_overloads_lets_go_and_stays_off_until_reboot(desk):
    """Against its end stop at full duty; then the arm hangs down, and torque cannot go on."""
    plant, motor = desk()
    plant.servos.protection.shutdown[:] = FACTORY_SHUTDOWN  # minibiped's is milder
    plant.servos.goal[KNEE] = 4095
    run(plant, 0.6)
    assert motor.hardware_error() == 0
    run(plant, 2.0)
    assert motor.hardware_error() == OVERLOAD
    assert motor.reading().pwm == 0
    motor.enable(True)
    assert not plant.servos.enabled[KNEE]
    assert plant.servos.enabled[0]
    motor.reboot()
    assert motor.hardware_error() == 0
    motor.enable(True)
    assert plant.servos.enabled[KNEE]


def test_a_hot_case_shuts_down_at_the_limit_of_its_register(desk):
    plant, motor = desk()
    motor.set_protection(60, 95, 160, OVERHEATING)
    plant.servos.heat.case[KNEE] = 59.0
    run(plant, 0.25)
    assert motor.hardware_error() == 0
    plant.servos.heat.case[KNEE] = 61.5
    run(plant, 0.25)
    assert motor.hardware_error() == OVERHEATING
    assert motor.reading().temperature == 61
    assert not plant.servos.enabled[KNEE]


def test_voltage_outside_its_limits_alerts_after_the_mean_has_left_them(make_plant):
    plant = make_plant("supply.voltage=9.0", "supply.resistance=0")
    bank = MotorBank(plant, plant.servos, servo_models(plant.description))
    motor = Motor(bank, KNEE)
    motor.set_protection(80, 95, 160, 52)
    hold(plant)
    run(plant, 0.25)
    assert motor.hardware_error() == INPUT_VOLTAGE
    assert plant.servos.enabled[KNEE]


def test_a_pack_gives_no_more_than_its_current(make_plant):
    currents = []
    for overrides in ((), ("supply.current_limit=4.0",)):
        plant = make_plant("supply.resistance=0.1", *overrides)
        hold(plant, np.array(plant.description.start_position) + 1.0)
        taken = []
        for _ in range(60):
            plant.substep()
            taken.append(float(plant.servos.duty @ plant.servos.current))
        currents.append(max(taken[5:]))
    assert currents[0] > 6.0
    assert currents[1] < 4.4


def test_a_supply_sags_by_its_resistance_and_counts_its_energy():
    supply = PackSupply(12.0, 0.2, None)
    supply.load(5.0)
    assert supply.voltage == pytest.approx(11.0)
    supply.load(0.0)
    assert supply.voltage == 12.0
    assert supply.lowest == pytest.approx(11.0)
    assert supply.energy == pytest.approx(60.0)
    assert supply.mean() == pytest.approx(11.5)
