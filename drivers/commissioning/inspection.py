"""The check before arming: everything that can be asked of a limp robot, all findings together."""

from collections import Counter
from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np

from drivers.assembly import bus_budgets
from drivers.calibration import RobotCalibration
from drivers.commissioning.calibration_inspection import look_at_calibration
from drivers.commissioning.port_names import latency_timer_ms
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.roll_call import Present, roll_call
from drivers.commissioning.search import models_by_number
from drivers.commissioning.settings import (
    RegisterImage,
    errors_by_name,
    needed_changes,
    read_image,
)
from drivers.dynamixel.control_table import VOLTAGE_UNIT, WATCHDOG_TRIPPED, Register
from hil.bringup.facts import Inspection
from hil.errors import InputError
from hil.servo import CENTRE_COUNTS, COUNTS_PER_RADIAN

POSE_TOLERANCE = 0.1
"""How far beyond its range a joint may hang [rad]: a stop gives way, a limp knee hangs straight."""
TEMPERATURE_HEADROOM = 15
"""Below the shutdown limit, at the start of a walk [K] (assumed)."""
VOLTAGE_SPREAD = 1.0
"""Between servos on one supply without load [V] (assumed: more is a bad contact)."""

Images = Mapping[str, RegisterImage]
"""Registers by joint."""


def inspect_servos(
    bench: RobotBench, calibration: RobotCalibration | None, rate_hz: int, inspection: Inspection
) -> dict[str, RegisterImage]:
    """Look at ports, buses and servos; what was read is returned, by joint."""
    _look_at_ports(bench, inspection)
    present = roll_call(bench, inspection)
    images: dict[str, RegisterImage] = {}
    for one in present:
        one.line.port.set_baud(bench.baud(one.bus))
        image = read_image(one.line, one.servo.id, one.servo.model)
        what = "answers pings, but no reads"
        inspection.expect(image is not None, one.where, what, "Status Return Level: stride setup")
        if image is not None:
            images[one.servo.joint] = image
    known = [one for one in present if one.servo.joint in images]
    right = [one for one in known if _is_right_model(one, images[one.servo.joint], inspection)]
    for one in right:
        image = images[one.servo.joint]
        _look_at_settings(one, image, inspection)
        _look_at_state(one, image, bench, inspection)
    _compare_firmware(right, images, inspection)
    _compare_voltages(right, images, inspection)
    _look_at_pose(bench, calibration, images, inspection)
    _look_at_budgets(bench, right, images, rate_hz, inspection)
    return images


def joint_angle(image: RegisterImage, direction: int, offset: float) -> float:
    """q = direction·(counts − 2048)/COUNTS_PER_RADIAN − offset [rad]."""
    counts = image[Register.PRESENT_POSITION]
    return direction * (counts - CENTRE_COUNTS) / COUNTS_PER_RADIAN - offset


def _look_at_ports(bench: RobotBench, inspection: Inspection) -> None:
    description = bench.description
    for name in (*description.buses, *description.boards):
        kind = "bus" if name in description.buses else "board"
        reason = bench.closed.get(name, "")
        inspection.expect(not reason, f"{kind} {name}", reason, f"--port {name}=DEVICE")
    for url, count in Counter(bench.urls.values()).items():
        inspection.expect(count == 1, url, f"is the port of {count} buses or boards",
                          "each has its own")  # fmt: skip
    for name, bus in description.buses.items():
        found = latency_timer_ms(bench.urls.get(name, ""))
        if found is not None:
            inspection.expect(
                found <= bus.latency_timer_ms, f"bus {name}",
                f"the adapter's latency timer is {found} ms, the robot file counts on "
                f"{bus.latency_timer_ms} ms",
                f"echo {bus.latency_timer_ms} | sudo tee "
                "/sys/class/tty/DEVICE/device/latency_timer",
            )  # fmt: skip


def _is_right_model(one: Present, image: RegisterImage, inspection: Inspection) -> bool:
    number = image[Register.MODEL_NUMBER]
    model = models_by_number().get(number)
    name = model.name if model else f"model number {number}"
    return inspection.expect(
        number == one.servo.model.number, one.where,
        f"is {name}, the robot file says {one.servo.model.name}",
        "put the right servo there, or mend the robot file",
    )  # fmt: skip


def _look_at_settings(one: Present, image: RegisterImage, inspection: Inspection) -> None:
    wrong = needed_changes(one.servo, image)
    inspection.looked_at += 1 - len(wrong)
    for change in wrong:
        inspection.expect(
            False, one.where, f"{change.register} is {change.found}, must be {change.wanted}",
            f"stride setup ({change.why})",
        )  # fmt: skip


def _look_at_state(
    one: Present, image: RegisterImage, bench: RobotBench, inspection: Inspection
) -> None:
    model, where = one.servo.model, one.where
    firmware = image[Register.FIRMWARE_VERSION]
    inspection.expect(
        firmware >= model.watchdog_firmware, where,
        f"has firmware {firmware}, without the bus watchdog that stops it when the host dies",
        f"update it to {model.watchdog_firmware} or later",
    )  # fmt: skip
    errors = image[Register.HARDWARE_ERROR_STATUS]
    inspection.expect(not errors, where, f"hardware error: {errors_by_name(errors)}",
                      "find the cause, then cut its power and give it again")  # fmt: skip
    inspection.expect(not image[Register.TORQUE_ENABLE], where, "torque is on", "stride relax")
    inspection.expect(image[Register.BUS_WATCHDOG] != WATCHDOG_TRIPPED, where,
                      "its bus watchdog has tripped", "stride relax clears it")  # fmt: skip
    _look_at_supply(one, image, bench, inspection)
    limit = min(model.temperature_limit, int(bench.description.safety.temperature_limit))
    temperature = image[Register.PRESENT_TEMPERATURE]
    inspection.expect(
        temperature <= limit - TEMPERATURE_HEADROOM, where,
        f"is {temperature} °C warm, its limit is {limit} °C",
        f"let it cool to {limit - TEMPERATURE_HEADROOM} °C",
    )  # fmt: skip


def _look_at_supply(
    one: Present, image: RegisterImage, bench: RobotBench, inspection: Inspection
) -> None:
    volts = VOLTAGE_UNIT * image[Register.PRESENT_INPUT_VOLTAGE]
    low, high = one.servo.model.input_voltage
    least = max(low, bench.description.safety.voltage_min or 0.0)
    inspection.expect(
        least <= volts <= high, one.where,
        f"has {volts:.1f} V, {one.servo.model.name} takes {least:.1f} to {high:.1f} V",
        "overvoltage destroys servos: cut the power now" if volts > high else
        "charge the pack, look at the wiring",
    )  # fmt: skip


def _compare_firmware(present: Sequence[Present], images: Images, inspection: Inspection) -> None:
    """One old servo costs its bus what the others can."""
    for model in sorted({one.servo.model.name for one in present}):
        versions = {
            one.where: images[one.servo.joint][Register.FIRMWARE_VERSION]
            for one in present
            if one.servo.model.name == model
        }
        usual = Counter(versions.values()).most_common(1)[0][0]
        for where, version in versions.items():
            inspection.expect(
                version == usual, where,
                f"has firmware {version}, the other {model} have {usual}",
                f"one firmware for all: update it to {max(versions.values())}",
            )  # fmt: skip


def _compare_voltages(present: Sequence[Present], images: Images, inspection: Inspection) -> None:
    volts = {
        one.where: VOLTAGE_UNIT * images[one.servo.joint][Register.PRESENT_INPUT_VOLTAGE]
        for one in present
    }
    if not volts:
        return
    middle = median(volts.values())
    for where, value in volts.items():
        inspection.expect(
            abs(value - middle) <= VOLTAGE_SPREAD, where,
            f"has {value:.1f} V, the others about {middle:.1f} V",
            "a bad contact in its power wiring",
        )  # fmt: skip


def _look_at_pose(
    bench: RobotBench,
    calibration: RobotCalibration | None,
    images: Images,
    inspection: Inspection,
) -> None:
    look_at_calibration(bench.description, calibration, inspection)
    offsets = calibration.joint_offsets if calibration else {}
    for joint in bench.description.joints:
        if joint.name not in images:
            continue
        angle = joint_angle(images[joint.name], joint.direction, offsets.get(joint.name, 0.0))
        low, high = joint.range
        inspection.expect(
            low - POSE_TOLERANCE <= angle <= high + POSE_TOLERANCE, joint.name,
            f"stands at {np.degrees(angle):.1f}°, its range is {np.degrees(low):.1f}° to "
            f"{np.degrees(high):.1f}°",
            "move it back by hand; if it is inside, its direction or offset is wrong",
        )  # fmt: skip


def _look_at_budgets(
    bench: RobotBench,
    present: Sequence[Present],
    images: Images,
    rate_hz: int,
    inspection: Inspection,
) -> None:
    fast = dict.fromkeys(bench.description.buses, True)
    for one in present:
        firmware = images[one.servo.joint][Register.FIRMWARE_VERSION]
        fast[one.bus] &= one.servo.model.supports_fast_read(firmware)
    for budget in bus_budgets(bench.description, fast):
        try:
            budget.check(rate_hz)
        except InputError as error:
            inspection.expect(False, f"bus {budget.bus}", str(error), "another --rate, or baud")
        else:
            inspection.looked_at += 1
