"""What one servo's fault costs the group transfer, in lockstep on the virtual minibiped at 300 Hz.

The robot hangs, torque on, and is read and written for a second after the fault. A tick is lost
where a joint's sample is not of that tick. Every figure is of the emulated robot.

Run: `python benchmarks/fault_costs.py`
"""

from datetime import UTC, datetime

from drivers.calibration import RobotCalibration
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.gain_mapping import GainMapping
from drivers.robot_backend import BusBackend
from hil.clock import tick_time_ns
from hil.interface import JointCommand, JointError
from hil.robot_files import load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.robot import VirtualRobot

RATE_HZ, TICKS, BEFORE = 300, 300, 30
JOINT = "left_hip_pitch"
PLAIN_FIRMWARE = 42
TICK_S = 1 / RATE_HZ
FAULTS = {
    "silent for 1 tick": f"servo:{JOINT}:silent@0+{0.9 * TICK_S}",
    "silent for 3 ticks": f"servo:{JOINT}:silent@0+{2.9 * TICK_S}",
    "silent for ever": f"servo:{JOINT}:silent@0",
    "answers 70 % of packets": f"servo:{JOINT}:silent=0.3@0",
    "frozen registers": f"servo:{JOINT}:frozen@0",
    "reboots (0.2 s)": f"servo:{JOINT}:reboot@0",
    "overload": f"servo:{JOINT}:alert=overload@0",
    "loses its torque": f"servo:{JOINT}:lost_torque@0",
    "watchdog trips": f"servo:{JOINT}:watchdog_trip@0",
    "1 % of its bus's packets lost": "bus:left_leg:drop=0.01@0",
    "1 % of its bus's packets damaged": "bus:left_leg:flip=0.01@0",
}


def measure(fault: str, fast: bool) -> tuple[int, int, float, str]:
    """Ticks lost of the joint, and of all its neighbours; the longest read [ms]; what was found,
    and after how many ticks."""
    description = load_robot("minibiped", ("plant.draws=null",))
    head = {
        "robot": "minibiped",
        "provenance": {"date": datetime.now(UTC).date(), "method": "ideal"},
    }
    ideal = RobotCalibration.model_validate(head)
    motors = GainMapping(description, ideal).motor_parameters()
    plant = Plant(description, RATE_HZ, 1, motors)
    plant.set_support(True)
    robot = VirtualRobot(description, plant, 1, RATE_HZ)
    robot.start()
    if not fast:
        for servo in robot.servos.values():
            servo.registers[Register.FIRMWARE_VERSION] = PLAIN_FIRMWARE
    calibration = RobotCalibration.model_validate({**head, **robot.calibration_data})
    backend = BusBackend(
        description, robot.clock, RATE_HZ, robot.port_urls, calibration,
        GainMapping(description, calibration),
    )  # fmt: skip
    backend.open()
    backend.arm()
    command = JointCommand.zeros(len(description.joints))
    command.position[:] = description.start_position
    command.stiffness[:] = [joint.stiffness for joint in description.joints]
    command.damping[:] = [joint.damping for joint in description.joints]
    start_ns = robot.clock.now_ns() + 1_000_000_000 // RATE_HZ
    own = description.joint_names.index(JOINT)
    lost = neighbours = longest_ns = 0
    found = "-"
    for tick in range(BEFORE + TICKS):
        if tick == BEFORE:
            robot.inject(fault)
        robot.clock.sleep_until_ns(tick_time_ns(start_ns, tick, RATE_HZ))
        frame = backend.read()
        if tick >= BEFORE:
            longest_ns = max(longest_ns, robot.clock.now_ns() - frame.time_ns)
            lost += not frame.joint_valid[own]
            neighbours += int((~frame.joint_valid).sum()) - int(not frame.joint_valid[own])
            error = int(frame.joint_error[own]) & ~JointError.UNEXPLAINED
            if error and found == "-":
                name = (JointError(error & ~0xFF).name or "hardware error").lower()
                found = f"{name} after {tick - BEFORE + 1} ticks"
        backend.write(command)
    backend.close()
    robot.close()
    return lost, neighbours, longest_ns * 1e-6, found


def main() -> None:
    print(f"{'':34s}{'read':6s}{'own':>5s}{'others':>8s}{'longest read':>14s}  found")
    for name, fault in FAULTS.items():
        for fast in (True, False):
            lost, others, longest_ms, found = measure(fault, fast)
            kind = "fast" if fast else "plain"
            print(f"{name:34s}{kind:6s}{lost:5d}{others:8d}{longest_ms:11.2f} ms  {found}")


if __name__ == "__main__":
    main()
