"""Which servos answer on which bus, and the likely reason for every one that does not."""

from collections.abc import Mapping
from dataclasses import dataclass

from drivers.commissioning.line import ServoLine
from drivers.commissioning.robot_bench import RobotBench
from drivers.commissioning.search import BAUDS
from drivers.dynamixel.audit import ExpectedServo
from hil.bringup.facts import Inspection


@dataclass(frozen=True, slots=True)
class Present:
    """A servo that answers where it should."""

    bus: str
    servo: ExpectedServo
    line: ServoLine

    @property
    def where(self) -> str:
        """For a person."""
        return f"{self.servo.joint} ({self.bus} id {self.servo.id})"


def roll_call(bench: RobotBench, inspection: Inspection) -> list[Present]:
    """Servos that answer; absent, unknown and misplaced ones become findings."""
    found: dict[str, set[int]] = {}
    for bus, line in bench.open_buses():
        heard = line.ping_all()
        found[bus] = {packet.id for packet in heard.packets}
        inspection.expect(
            not heard.garbled, f"bus {bus}", "answers to a ping of everybody are garbled",
            "two servos with one id, or a bad cable: stride scan",
        )  # fmt: skip
        for servo in bench.expected(bus):
            # A broadcast's answer may be lost; three lost pings more are no accident.
            if servo.id not in found[bus] and line.client.ping(servo.id) is not None:
                found[bus].add(servo.id)
    swapped = _swapped(bench, found, inspection)
    present = []
    for bus, line in bench.open_buses():
        expected = bench.expected(bus)
        strangers = sorted(found[bus] - {servo.id for servo in expected})
        if bus in swapped:
            continue
        inspection.expect(
            not strangers, f"bus {bus}",
            f"id {', '.join(map(str, strangers))} answers and no joint of the robot file has it",
            "a wrong id, or a servo of another robot: stride setup --replace JOINT",
        )  # fmt: skip
        missing = [servo for servo in expected if servo.id not in found[bus]]
        _explain_missing(line, bus, missing, len(expected), inspection)
        present += [Present(bus, servo, line) for servo in expected if servo.id in found[bus]]
    return present


def _swapped(bench: RobotBench, found: Mapping[str, set[int]], inspection: Inspection) -> set[str]:
    """Buses that answer with the ids of another one."""
    ids = {bus: {servo.id for servo in bench.expected(bus)} for bus in bench.description.buses}
    swapped = set()
    for bus, answering in found.items():
        other = next(
            (name for name in ids if name != bus and answering and answering <= ids[name]), None
        )
        if answering & ids[bus] or other is None:
            inspection.looked_at += 1
            continue
        swapped.add(bus)
        inspection.expect(
            False, f"bus {bus}",
            f"its port {bench.urls[bus]} answers as {other}: ids "
            f"{', '.join(map(str, sorted(answering)))}",
            f"the ports of {bus} and {other} are swapped: exchange them in the robot file or the "
            "plugs",
        )  # fmt: skip
    return swapped


def _explain_missing(
    line: ServoLine, bus: str, missing: list[ExpectedServo], total: int, inspection: Inspection
) -> None:
    if missing and len(missing) == total:
        speeds = other_speeds(line, missing[:1])
        at = f"; id {missing[0].id} answers at {speeds[missing[0].id]} baud" if speeds else ""
        inspection.expect(
            False, f"bus {bus}", f"none of its {total} servos answers at {line.port.baud} baud{at}",
            "stride setup sets the speed" if speeds else "servo power, the plug, or another port",
        )  # fmt: skip
        return
    speeds = other_speeds(line, missing)
    for servo in missing:
        baud, where = speeds.get(servo.id), f"{servo.joint} ({bus} id {servo.id})"
        if baud is None:
            advice = "its cable, its power, its id; a new servo: stride setup --replace "
            inspection.expect(False, where, "does not answer", advice + servo.joint)
        else:
            what = f"answers at {baud} baud, not at the bus's {line.port.baud}"
            inspection.expect(False, where, what, "stride setup sets its speed")


def other_speeds(line: ServoLine, missing: list[ExpectedServo]) -> dict[int, int]:
    """At which other speed a servo answers, by id."""
    own = line.port.baud
    speeds: dict[int, int] = {}
    for baud in BAUDS:
        left = [servo.id for servo in missing if servo.id not in speeds]
        if baud != own and left:
            line.port.set_baud(baud)
            speeds |= {one: baud for one in left if line.ping(one).packets}
    line.port.set_baud(own)
    return speeds
