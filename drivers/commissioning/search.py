"""Who is on this port? All speeds, all ids, and whether the answers can be believed."""

from collections import Counter
from collections.abc import Callable, Sequence

from drivers.commissioning.line import Heard, ServoLine
from drivers.dynamixel.control_table import BAUD_CODES, Register
from drivers.dynamixel.protocol import MAX_ID, Packet
from drivers.dynamixel.servo_models import SERVO_MODELS, ServoModel
from hil.bringup.facts import FoundServo, PortSearch
from hil.errors import InputError

BAUDS = tuple(sorted(BAUD_CODES, key=lambda baud: (baud != 57_600, -baud)))
"""Every speed of the X series [bit/s], a new servo's first."""
PROBES = 4
"""Reads of a block that differs from servo to servo: two servos with one id garble it."""
_IDENTITY_SIZE = 3
_CAUSES = "two servos with one id, a bad cable, or another sender"


def models_by_number() -> dict[int, ServoModel]:
    """Known models by Model Number (0)."""
    return {model.number: model for model in SERVO_MODELS.values()}


def check_bauds(bauds: Sequence[int]) -> tuple[int, ...]:
    """The same speeds, all of them if there are none. Raises InputError for an unknown one."""
    for baud in bauds:
        if baud not in BAUD_CODES:
            valid = ", ".join(map(str, sorted(BAUD_CODES)))
            raise InputError(f"--baud {baud}: is no speed of these servos; valid: {valid}")
    return tuple(bauds) or BAUDS


def search_line(
    line: ServoLine, bauds: Sequence[int], progress: Callable[[str], None]
) -> PortSearch:
    """Ask everybody at every speed. Raises BackendError for a port that is lost."""
    result = PortSearch(line.port.url)
    for baud in bauds:
        progress(f"{line.port.url} at {baud} baud")
        line.port.set_baud(baud)
        heard = line.ping_all()
        identities = _identities(heard.packets)
        if heard.garbled:
            _complain(result, baud, heard)
            identities |= _ask_one_by_one(line, set(identities))
        twice = Counter(packet.id for packet in heard.packets)
        for servo_id, (number, firmware) in sorted(identities.items()):
            result.servos.append(found_servo(line.port.url, baud, servo_id, number, firmware))
            _probe(line, servo_id, twice[servo_id], result)
    return result


def found_servo(port: str, baud: int, servo_id: int, number: int, firmware: int) -> FoundServo:
    """A servo by what it answered to a ping."""
    model = models_by_number().get(number)
    return FoundServo(
        port, baud, servo_id, number, model.name if model else None, firmware,
        missing_features(model, firmware) if model else (),
    )  # fmt: skip


def missing_features(model: ServoModel, firmware: int) -> tuple[str, ...]:
    """What the driver would use and a servo has not, and whether newer firmware would help."""
    lacks = []
    if not model.supports_fast_read(firmware):
        newer = model.fast_read_firmware
        lacks.append("fast sync read" + (f" (firmware {newer})" if newer else ""))
    if firmware < model.watchdog_firmware:
        lacks.append(f"bus watchdog (firmware {model.watchdog_firmware})")
    if model.startup_firmware is None or firmware < model.startup_firmware:
        newer = model.startup_firmware
        lacks.append("startup configuration" + (f" (firmware {newer})" if newer else ""))
    if model.current_unit is None:
        lacks.append("current control and measurement")
    elif model.current_sensing == "supply":
        lacks.append("motor current (measures the supply's)")
    if model.highest_baud < max(BAUD_CODES):
        lacks.append(f"speeds above {model.highest_baud} baud")
    return tuple(lacks)


def _identities(packets: Sequence[Packet]) -> dict[int, tuple[int, int]]:
    """Model number and firmware by id."""
    return {
        packet.id: (int.from_bytes(packet.data[:2], "little"), packet.data[2])
        for packet in packets
        if len(packet.data) == _IDENTITY_SIZE
    }


def _complain(result: PortSearch, baud: int, heard: Heard) -> None:
    clean = len(_identities(heard.packets))
    result.suspicious.append(
        f"{result.port} at {baud} baud: garbled answers to a ping of everybody, beside {clean} "
        f"clean ones: {_CAUSES}"
    )


def _ask_one_by_one(line: ServoLine, known: set[int]) -> dict[int, tuple[int, int]]:
    """Ping every other id alone: a garbled answer may have been several."""
    found: dict[int, tuple[int, int]] = {}
    for servo_id in range(MAX_ID + 1):
        if servo_id not in known:
            found |= _identities(line.ping(servo_id).packets)
    return found


def _probe(line: ServoLine, servo_id: int, answers: int, result: PortSearch) -> None:
    """Read what differs between servos; equal answers to a ping may be those of two."""
    where = f"{line.port.url} at {line.port.baud} baud, id {servo_id}"
    if answers > 1:
        result.suspicious.append(f"{where}: answered a ping {answers} times: {_CAUSES}")
    heard = [
        line.hear_block(servo_id, Register.REALTIME_TICK, Register.PRESENT_TEMPERATURE)
        for _ in range(PROBES)
    ]
    bad = sum(data is None or garbled for data, garbled in heard)
    silent = sum(data is None and not garbled for data, garbled in heard)
    if silent == PROBES:
        result.suspicious.append(
            f"{where}: answers pings, not reads: its Status Return Level is 0, or it is no servo"
        )
    elif bad:
        result.suspicious.append(
            f"{where}: {bad} of {PROBES} answers are missing or garbled: {_CAUSES}"
        )
