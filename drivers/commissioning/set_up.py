"""Setting up the servos of a robot: those in place, a new one alone, one that was swapped."""

from collections.abc import Sequence

from drivers.commissioning.line import ServoLine
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.roll_call import other_speeds
from drivers.commissioning.search import BAUDS, models_by_number
from drivers.commissioning.settings import (
    apply_changes,
    needed_changes,
    read_image,
    why_untouchable,
)
from drivers.dynamixel.audit import ExpectedServo
from drivers.dynamixel.control_table import BAUD_CODES, Register
from hil.bringup.facts import ServoPlan, SettingChange
from hil.errors import BackendError, InputError

SILENT = "does not answer"
"""Problem of a servo that is not there, or not at any speed."""
SETTLE_NS = 50_000_000
"""After a change of id or speed [ns] (assumed)."""


def plan_robot(bench: RobotBench, joints: Sequence[str]) -> list[ServoPlan]:
    """What the servos of these joints need, at whatever speed they are; of all if none is named."""
    for joint in joints:
        bench.find(joint)
    plans: list[ServoPlan] = []
    for bus, line in bench.open_buses():
        chosen = [one for one in bench.expected(bus) if not joints or one.joint in joints]
        found = {servo.joint: _plan(line, bus, servo, servo.id) for servo in chosen}
        silent = [servo for servo in chosen if found[servo.joint].problem == SILENT]
        speeds = other_speeds(line, silent)
        for servo in silent:
            if servo.id in speeds:
                line.port.set_baud(speeds[servo.id])
                plan = _plan(line, bus, servo, servo.id)
                found[servo.joint] = (
                    plan if plan.problem else _with_identity(plan, servo, bench.baud(bus))
                )
        plans += found.values()
    return plans


def plan_new(line: ServoLine, bench: RobotBench, joint: str) -> ServoPlan:
    """What the only servo on a port needs to become a joint's. Raises InputError."""
    bus, servo = bench.find(joint)
    found = [(baud, one) for baud in BAUDS for one in _ids_at(line, baud)]
    if len(found) != 1:
        listed = ", ".join(f"id {one} at {baud} baud" for baud, one in found) or "none answers"
        raise InputError(
            f"{line.port.url}: exactly one servo must be connected to become {joint}: {listed}"
        )
    (baud, servo_id) = found[0]
    line.port.set_baud(baud)
    return _with_identity(_plan(line, bus, servo, servo_id), servo, bench.baud(bus))


def plan_replacement(bench: RobotBench, joint: str) -> ServoPlan:
    """What the stranger on a joint's bus needs to take its place. Raises InputError."""
    bus, servo = bench.find(joint)
    if bus not in bench.lines:
        raise InputError(f"{bus}: {bench.closed[bus]}")
    line, own = bench.lines[bus], bench.baud(bus)
    known = {one.id for one in bench.expected(bus)}
    strangers = []
    for baud in sorted(BAUDS, key=lambda baud: baud != own):
        found = _ids_at(line, baud)
        if baud == own and servo.id in found:
            raise InputError(
                f"{joint}: id {servo.id} answers on {bus}: there is nothing to replace; "
                f"to set it up again: stride setup --joint {joint}"
            )
        strangers += [(baud, one) for one in found if baud != own or one not in known]
    if len(strangers) != 1:
        listed = ", ".join(f"id {one} at {baud} baud" for baud, one in strangers) or "none answers"
        raise InputError(
            f"{joint}: exactly one new servo must be on {bus}, beside those of the other joints: "
            f"{listed}; one with an id of another joint goes alone: --servo PORT --joint {joint}"
        )
    (baud, servo_id) = strangers[0]
    line.port.set_baud(baud)
    return _with_identity(_plan(line, bus, servo, servo_id), servo, own)


def apply_plan(line: ServoLine, servo: ExpectedServo, plan: ServoPlan) -> None:
    """Write what a plan says, id and speed last, and read it back. Raises BackendError."""
    line.port.set_baud(plan.baud)
    identity = (Register.ID.spec.name, Register.BAUD_RATE.spec.name)
    settings = [change for change in plan.changes if change.register not in identity]
    apply_changes(line, servo, plan.id, settings)
    servo_id, moved = plan.id, {change.register: change.wanted for change in plan.changes}
    if Register.ID.spec.name in moved:
        line.tell(servo_id, Register.ID, servo.id)
        servo_id = servo.id
        _settle(line)
    if Register.BAUD_RATE.spec.name in moved:
        code = moved[Register.BAUD_RATE.spec.name]
        line.tell(servo_id, Register.BAUD_RATE, code)
        line.port.set_baud(next(baud for baud, one in BAUD_CODES.items() if one == code))
        _settle(line)
    image = read_image(line, servo_id, servo.model)
    if image is None or needed_changes(servo, image):
        raise BackendError(
            f"{line.port.url}: {servo.joint} does not answer as id {servo_id} at "
            f"{line.port.baud} baud after it was set up: stride scan {line.port.url}"
        )


def _plan(line: ServoLine, bus: str, servo: ExpectedServo, servo_id: int) -> ServoPlan:
    """Settings of a servo that answers, or why there are none."""
    baud = line.port.baud
    image = read_image(line, servo_id, servo.model)
    if image is None:
        return ServoPlan(servo.joint, bus, servo_id, baud, (), SILENT)
    problem = why_untouchable(servo, image)
    if problem.startswith("is model"):
        model = models_by_number().get(image[Register.MODEL_NUMBER])
        name = model.name if model else f"model number {image[Register.MODEL_NUMBER]}"
        problem = f"is {name}, the robot file says {servo.model.name}"
    changes = () if problem else needed_changes(servo, image)
    return ServoPlan(servo.joint, bus, servo_id, baud, changes, problem)


def _with_identity(plan: ServoPlan, servo: ExpectedServo, baud: int) -> ServoPlan:
    """A plan with the joint's id and its bus's speed. Raises InputError for no such speed."""
    if plan.problem:
        raise InputError(f"{servo.joint}: the servo that answers {plan.problem}")
    if baud not in servo.model.bauds:
        valid = ", ".join(map(str, servo.model.bauds))
        raise InputError(f"{servo.joint}: {servo.model.name} cannot do {baud} baud; valid: {valid}")
    changes = list(plan.changes)
    if plan.id != servo.id:
        changes.append(
            SettingChange(Register.ID.spec.name, plan.id, servo.id, "the robot file's id")
        )
    if plan.baud != baud:
        codes = BAUD_CODES[plan.baud], BAUD_CODES[baud]
        why = f"{plan.baud} to {baud} baud"
        changes.append(SettingChange(Register.BAUD_RATE.spec.name, *codes, why))
    return ServoPlan(plan.joint, plan.bus, plan.id, plan.baud, tuple(changes))


def _ids_at(line: ServoLine, baud: int) -> list[int]:
    line.port.set_baud(baud)
    return sorted({packet.id for packet in line.ping_all().packets})


def _settle(line: ServoLine) -> None:
    line.clock.sleep_until_ns(line.clock.now_ns() + SETTLE_NS)
    line.port.discard_input()
