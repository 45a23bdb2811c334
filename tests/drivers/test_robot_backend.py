"""The whole driver against the virtual robot, byte by byte, in lockstep."""

import numpy as np
import pytest

from drivers.calibration import RobotCalibration
from drivers.dynamixel.control_table import WATCHDOG_TRIPPED, Register
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.clock import tick_time_ns
from hil.errors import BackendError, InputError, InvalidCommandError, PortError
from hil.interface import NEVER_NS, JointCommand, JointError, Limit, StopMode
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.robot import VirtualRobot

RATE = 300
DESCRIPTION = load_robot("minibiped", ("plant.draws=null",))
STATISTICS = {
    "bus_utilisation_pct",
    "bus_crc_errors",
    "bus_timeouts",
    "bus_stale_frames",
    "temperature_max_c",
    "voltage_min_v",
    "duty_saturation_pct_max",
}


class Rig:
    """A supported virtual minibiped and a driver for it."""

    def __init__(self, description=DESCRIPTION, rate=RATE):
        self.rate = rate
        provenance = {"date": "2026-01-01", "method": "ideal"}
        bare = RobotCalibration.model_validate({"robot": "minibiped", "provenance": provenance})
        motors = GainMapping(description, bare).motor_parameters()
        self.plant = Plant(description, rate, 1, motors)
        self.plant.set_support(True)
        self.robot = VirtualRobot(description, self.plant, 1, rate)
        self.robot.start()
        self.clock = self.robot.clock
        self.calibration = RobotCalibration.model_validate(
            {"robot": "minibiped", "provenance": provenance, **self.robot.calibration_data}
        )
        self.backend = self.make_backend(self.robot.port_urls, description)
        self.command = JointCommand.zeros(12)
        self.command.position[:] = description.start_position
        self.command.stiffness[:] = 18.9
        self.command.damping[:] = 0.851

    def make_backend(self, urls, description=DESCRIPTION):
        mapping = GainMapping(description, self.calibration)
        return BusBackend(description, self.clock, self.rate, urls, self.calibration, mapping)

    def registers(self, register):
        return [self.robot.servos[name].registers[register] for name in DESCRIPTION.joint_names]

    def run(self, ticks):
        """Tick from one period on; yields the frame and the duration of its read [ns]."""
        start_ns = self.clock.now_ns() + 1_000_000_000 // self.rate
        for tick in range(ticks):
            self.clock.sleep_until_ns(tick_time_ns(start_ns, tick, self.rate))
            before_ns = self.clock.now_ns()
            frame = self.backend.read()
            yield frame, self.clock.now_ns() - before_ns
            self.backend.write(self.command)


@pytest.fixture
def rig():
    rig = Rig()
    yield rig
    rig.backend.close()
    rig.robot.close()


def test_a_robot_is_opened_read_armed_moved_and_switched_off(rig):
    rig.backend.open()
    frame = rig.backend.read()
    assert frame.joint_valid.all()
    np.testing.assert_allclose(frame.joint_position, DESCRIPTION.start_position, atol=0.005)
    np.testing.assert_allclose(frame.joint_voltage, 12.0, atol=0.3)
    assert frame.foot_valid.all()
    assert frame.imu_valid
    assert not any(rig.registers(Register.TORQUE_ENABLE))

    rig.backend.arm()
    assert all(rig.registers(Register.TORQUE_ENABLE))
    rig.command.position[3] += 0.2
    for frame, duration_ns in rig.run(150):
        assert frame.joint_valid.all()
        assert duration_ns < 1e9 / RATE
    np.testing.assert_allclose(frame.joint_position, rig.command.position, atol=0.03)

    assert rig.backend.stop(StopMode.TORQUE_OFF)
    assert not any(rig.registers(Register.TORQUE_ENABLE))
    assert not any(rig.registers(Register.BUS_WATCHDOG))


def test_settings_that_need_it_are_corrected_and_reported(rig):
    knee = rig.robot.servos["left_knee"]
    knee.write(Register.RETURN_DELAY_TIME.address, b"\xfa")
    knee.write(Register.OPERATING_MODE.address, b"\x04")
    rig.backend.open()
    assert "bus left_leg id 4 (left_knee): Operating Mode 4 -> 3" in rig.backend.changes
    assert rig.registers(Register.RETURN_DELAY_TIME) == [0] * 12


def test_gains_and_position_are_adopted_before_torque(rig):
    rig.backend.open()
    rig.backend.arm()
    np.testing.assert_allclose(rig.registers(Register.POSITION_P_GAIN), 801, atol=16)
    assert rig.registers(Register.GOAL_POSITION) == rig.registers(Register.PRESENT_POSITION)
    assert rig.registers(Register.POSITION_D_GAIN) == [0] * 12
    assert rig.registers(Register.BUS_WATCHDOG) == [2] * 12


def test_nothing_is_sent_before_arming_and_after_stopping(rig):
    rig.backend.open()
    goals = rig.registers(Register.GOAL_POSITION)
    rig.command.position[:] += 0.1
    rig.backend.read()
    assert (rig.backend.write(rig.command).limit & Limit.HELD).all()
    rig.backend.arm()
    rig.backend.stop(StopMode.TORQUE_OFF)
    held = rig.registers(Register.GOAL_POSITION)
    assert (rig.backend.write(rig.command).limit & Limit.HELD).all()
    rig.clock.sleep_until_ns(rig.clock.now_ns() + 10_000_000)
    assert rig.registers(Register.GOAL_POSITION) == held
    np.testing.assert_allclose(held, goals, atol=5)


@pytest.mark.parametrize("name", ["position", "velocity", "stiffness", "damping", "torque"])
def test_a_command_that_is_not_finite_is_refused_by_name(rig, name):
    rig.backend.open()
    rig.backend.arm()
    rig.backend.read()
    sent = rig.robot.ports["left_leg"].last_read_ns
    getattr(rig.command, name)[3] = np.nan
    with pytest.raises(InvalidCommandError, match=f"joint left_knee: commanded {name} is nan"):
        rig.backend.write(rig.command)
    assert rig.robot.ports["left_leg"].last_read_ns == sent


def test_a_command_of_another_robot_is_refused(rig):
    with pytest.raises(InvalidCommandError, match=r"shape \(3,\), the robot has 12 joints"):
        rig.backend.write(JointCommand.zeros(3))


def test_a_silent_servo_costs_itself_and_one_tick_of_those_behind(rig):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(3))
    rig.robot.servos["left_hip_pitch"].ready_ns = NEVER_NS
    rows = [(frame.joint_valid.copy(), frame.joint_age_ns[2]) for frame, _ in rig.run(30)]
    # Asked from either end, whoever is behind the silent one stays silent in that tick.
    left = rows[0][0][:6].tolist()
    assert left in ([True] * 2 + [False] * 4, [False] * 3 + [True] * 3)
    assert rows[0][0][6:].all()
    for valid, _ in rows[1:]:
        assert valid.tolist() == [True] * 2 + [False] + [True] * 9
    assert rows[-1][1] == pytest.approx(30 * 1e9 / RATE, abs=2e6)
    assert all(duration_ns < 1e9 / RATE for _, duration_ns in rig.run(10))
    assert not rig.backend.stop(StopMode.TORQUE_OFF)
    assert sum(rig.registers(Register.TORQUE_ENABLE)) == 1


def test_missing_and_wrong_servos_end_opening_with_nothing_held(rig):
    rig.robot.servos["right_knee"].ready_ns = NEVER_NS
    with pytest.raises(BackendError, match=r"bus right_leg id 14 \(right_knee\) does not answer"):
        rig.backend.open()
    rig.robot.servos["right_knee"].ready_ns = 0
    rig.backend.open()  # no port was left open


def test_a_rate_that_the_bus_cannot_carry_is_refused_before_a_port_is_opened(rig):
    buses = {
        name: bus.model_copy(update={"baud": 57_600}) for name, bus in DESCRIPTION.buses.items()
    }
    description = DESCRIPTION.model_copy(update={"buses": buses})
    backend = rig.make_backend({}, description)
    with pytest.raises(InputError, match=r"bus left_leg cannot carry 300 Hz: .* highest rate"):
        backend.open()


def test_a_port_that_does_not_exist_is_named_and_the_others_are_released(rig):
    urls = {**rig.robot.port_urls, "imu": "/dev/does-not-exist"}
    with pytest.raises(PortError, match="imu: cannot open port '/dev/does-not-exist'"):
        rig.make_backend(urls).open()
    rig.backend.open()


def test_a_port_that_is_not_given_is_named(rig):
    urls = dict(rig.robot.port_urls)
    del urls["right_leg"]
    with pytest.raises(InputError, match=r"no port is given for right_leg; .*left_leg"):
        rig.make_backend(urls).open()


def test_a_soft_stop_holds_and_closing_switches_off(rig):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(5))
    assert rig.backend.stop(StopMode.SOFT)
    assert all(rig.registers(Register.TORQUE_ENABLE))
    rig.clock.sleep_until_ns(rig.clock.now_ns() + 100_000_000)
    assert WATCHDOG_TRIPPED not in rig.registers(Register.BUS_WATCHDOG)
    rig.backend.close()
    assert not any(rig.registers(Register.TORQUE_ENABLE))
    rig.backend.close()


def test_a_host_that_falls_silent_trips_the_watchdogs_in_40_ms(rig):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(5))
    rig.clock.sleep_until_ns(rig.clock.now_ns() + 45_000_000)
    assert {value & 0xFF for value in rig.registers(Register.BUS_WATCHDOG)} == {WATCHDOG_TRIPPED}
    assert rig.backend.stop(StopMode.TORQUE_OFF)


def test_a_servo_that_cannot_be_armed_leaves_no_torque_on(rig):
    rig.backend.open()
    rig.robot.servos["right_ankle_roll"].ready_ns = NEVER_NS
    with pytest.raises(BackendError, match="bus right_leg: id 16"):
        rig.backend.arm()
    assert not any(rig.registers(Register.TORQUE_ENABLE))


def test_reading_never_touches_torque(rig):
    rig.backend.open()
    list(rig.run(20))
    rig.backend.close()
    assert not any(rig.registers(Register.TORQUE_ENABLE))


def test_a_closed_backend_is_neither_read_nor_armed(rig):
    for _ in range(2):
        with pytest.raises(BackendError, match="minibiped: the bus backend is not open"):
            rig.backend.read()
        with pytest.raises(BackendError, match="not open"):
            rig.backend.arm()
        rig.backend.open()
        rig.backend.close()


def test_statistics_have_the_reports_keys(rig):
    assert set(rig.backend.statistics()) == STATISTICS
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(60))
    statistics = rig.backend.statistics()
    assert set(statistics) == STATISTICS
    assert 5 < statistics["bus_utilisation_pct"] < 30
    assert statistics["bus_crc_errors"] == statistics["bus_timeouts"] == 0
    assert statistics["temperature_max_c"] > 0
    assert 10 < statistics["voltage_min_v"] <= 12.1


def test_old_firmware_is_read_plainly(rig):
    for name in DESCRIPTION.joint_names:
        rig.robot.servos[name].registers[Register.FIRMWARE_VERSION] = 42
    rig.backend.open()
    rig.backend.arm()
    assert all(frame.joint_valid.all() for frame, _ in rig.run(30))


def test_one_old_servo_costs_its_own_bus_the_fast_reads_and_no_other(rig):
    rig.robot.servos["left_knee"].registers[Register.FIRMWARE_VERSION] = 42
    rig.backend.open()
    rig.backend.arm()
    assert all(frame.joint_valid.all() for frame, _ in rig.run(30))
    assert [bus.fast for bus in rig.backend._group.buses] == [False, True]


def test_a_bus_faster_than_one_of_its_servos_is_refused(rig):
    joints = [joint.model_dump() for joint in DESCRIPTION.joints]
    joints[3]["servo"] = "XL330-M288"
    data = DESCRIPTION.model_dump() | {"joints": joints}
    data["buses"]["left_leg"]["baud"] = 4_500_000
    strange = type(DESCRIPTION).model_validate(data)
    with pytest.raises(InputError, match=r"buses\.left_leg\.baud 4500000: left_knee is a XL330"):
        BusBackend(
            strange, rig.clock, RATE, rig.robot.port_urls, rig.calibration,
            GainMapping(DESCRIPTION, rig.calibration),
        ).open()  # fmt: skip


def test_the_bus_leaves_time_for_the_controller(rig):
    rig.backend.open()
    rig.backend.arm()
    durations = [duration_ns for _, duration_ns in rig.run(60)]
    assert max(durations) < 0.6 * 1e9 / RATE


@pytest.mark.parametrize(
    ("fault", "own", "found"),
    [
        ("silent@0+0.005", 1, 0),
        ("silent@0+0.012", 4, 0),
        ("silent@0", 60, 0),
        ("frozen@0", 60, 0),
        ("reboot@0", 60, 0),
        ("lost_torque@0", 0, JointError.TORQUE_LOST),
        ("watchdog_trip@0", 0, JointError.STOPPED),
        ("alert=overload@0", 0, 32),  # told: this robot masks it
        ("alert=electrical_shock@0", 0, JointError.TORQUE_LOST | 16),
    ],
)
def test_what_a_servos_fault_costs(rig, fault, own, found):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(60))
    rig.robot.inject(f"servo:left_hip_pitch:{fault}")
    lost, neighbours = 0, 0
    for frame, duration_ns in rig.run(60):
        assert duration_ns < 0.7 * 1e9 / RATE
        lost += not frame.joint_valid[2]
        neighbours += (~frame.joint_valid).sum() - (not frame.joint_valid[2])
    assert lost == own
    assert neighbours <= 3
    assert frame.joint_error.tolist() == [0, 0, found] + [0] * 9


def test_a_servo_that_rebooted_is_reported_and_gets_no_torque(rig):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(10))
    rig.robot.inject("servo:right_knee:reboot@0")
    *_, (frame, _) = rig.run(90)
    assert frame.joint_valid.all()
    error = JointError(int(frame.joint_error[9]))
    assert JointError.REBOOTED in error
    assert JointError.TORQUE_LOST in error
    assert rig.registers(Register.TORQUE_ENABLE) == [1] * 9 + [0] + [1] * 2


@pytest.mark.parametrize("kind", ["drop", "flip", "truncate", "duplicate", "garbage", "echo"])
def test_a_bad_wire_costs_samples_and_nothing_else(rig, kind):
    rig.backend.open()
    rig.backend.arm()
    list(rig.run(10))
    rig.robot.inject(f"bus:left_leg:{kind}=0.05@0")
    valid = []
    for frame, duration_ns in rig.run(200):
        assert duration_ns < 1e9 / RATE
        np.testing.assert_allclose(frame.joint_position, DESCRIPTION.start_position, atol=0.1)
        assert not frame.joint_error.any()
        valid.append(frame.joint_valid.copy())
    assert np.mean(valid) > 0.9
    assert np.array(valid)[:, 6:].all()


def test_a_stuck_board_ages_and_a_jumping_clock_does_not(rig):
    rig.backend.open()
    list(rig.run(20))
    rig.robot.inject("board:left_foot:stuck@0")
    rig.robot.inject("board:right_foot:clock_jump=0.2@0")
    rig.robot.inject("board:imu:clock_jump@0")
    *_, (frame, _) = rig.run(40)
    assert not frame.foot_valid[0].any()
    assert frame.foot_age_ns[0] > 100_000_000
    assert frame.foot_valid[1].all()
    assert frame.foot_age_ns[1] < 10_000_000
    assert frame.imu_valid
    assert frame.imu_age_ns < 10_000_000
