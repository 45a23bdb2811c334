"""Mutated frames against our readers and the emulated servos: what is accepted, and why.

    python benchmarks/fuzz_frames.py --frames 1000000

Real frames (instructions of our encoder, answers of emulated servos, frames of boards) are
mutated: bits flipped, bytes dropped, inserted, doubled, cut off, or spliced with another frame.
Every mutated frame goes to whoever would read it. Nothing may raise. What is accepted must be
what was sent; where it is not, the accepted bytes must carry a valid CRC, checked here by a
second, bitwise implementation: a CRC of 16 bits passes one damaged frame in 65 536.
Exit code 1 if anything raised, or a wrong value was accepted without such a CRC.
"""

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable
from random import Random

import numpy as np

from drivers.boards.frames import FrameReader, encode_foot_frame, encode_imu_frame
from drivers.dynamixel import protocol
from drivers.dynamixel.blocks import HOT, WHOLE
from drivers.dynamixel.budget import BusTiming
from drivers.dynamixel.bus import ServoBus
from drivers.dynamixel.idle_read import IdleReader
from drivers.dynamixel.protocol import BROADCAST_ID, Instruction, PacketReader
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.servo_models import find_servo_model
from drivers.dynamixel.states import ServoStates
from sim_backends.virtual.dispatch import Dispatcher
from sim_backends.virtual.motors import Reading
from sim_backends.virtual.register_file import RegisterFile
from sim_backends.virtual.servo import EmulatedServo

IDS = (1, 2, 3, 4, 5, 6)
TICKS = 12
"""Ticks of one bus object: damaged answers make it drop its servos from the group."""
PERIOD_NS = 3_333_333


def crc16_bitwise(data: bytes) -> int:
    """CRC of Protocol 2.0: poly 0x8005, start 0, most significant bit first."""
    return _crc(data, 0x8005, 0)


def _crc(data: bytes, polynomial: int, crc: int) -> int:
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ polynomial if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


class Mutator:
    """Damages frames, one to three times each."""

    def __init__(self, random: Random) -> None:
        self._random = random
        self._ways: tuple[Callable[[bytearray, bytes], None], ...] = (
            self._flip, self._drop, self._insert, self._truncate, self._duplicate, self._splice,
        )  # fmt: skip

    def damage(self, frame: bytes, other: bytes) -> bytes:
        """A frame that differs from `frame`; `other` is what it may be spliced with."""
        while True:
            data = bytearray(frame)
            for _ in range(self._random.choice((1, 1, 1, 2, 3))):
                if data:
                    self._random.choice(self._ways)(data, other)
            if data != frame:
                return bytes(data)

    def _flip(self, data: bytearray, _: bytes) -> None:
        for _ in range(self._random.randint(1, 4)):
            bit = self._random.randrange(8 * len(data))
            data[bit // 8] ^= 1 << bit % 8

    def _drop(self, data: bytearray, _: bytes) -> None:
        begin = self._random.randrange(len(data))
        del data[begin : begin + self._random.randint(1, 4)]

    def _insert(self, data: bytearray, _: bytes) -> None:
        at = self._random.randint(0, len(data))
        data[at:at] = self._random.randbytes(self._random.randint(1, 6))

    def _truncate(self, data: bytearray, _: bytes) -> None:
        del data[self._random.randrange(len(data)) :]

    def _duplicate(self, data: bytearray, _: bytes) -> None:
        begin = self._random.randrange(len(data))
        part = data[begin : begin + self._random.randint(1, len(data))]
        data[begin:begin] = part

    def _splice(self, data: bytearray, other: bytes) -> None:
        cut = self._random.randrange(len(data))
        data[cut:] = other[self._random.randrange(len(other)) :]


class StillMotor:
    """A motor that measures what it is told to; goals and settings change nothing."""

    def __init__(self) -> None:
        self.reading = lambda: self.values
        self.values = Reading(0, 0, 0, 2048, 120, 30)

    def hardware_error(self) -> int:
        """None."""
        return 0

    def trajectory(self) -> tuple[int, int]:
        """None."""
        return 0, 0

    def reboot(self) -> None:
        """Nothing to forget."""

    def enable(self, on: bool) -> None:
        """Nothing moves."""

    def __getattr__(self, name: str) -> Callable[..., None]:
        if name.startswith("set_"):
            return lambda *_: None
        raise AttributeError(name)


class Servos:
    """Six emulated servos without a wire."""

    def __init__(self) -> None:
        self.now_ns = 0
        self.motors = [StillMotor() for _ in IDS]
        model = find_servo_model("XM430-W350")
        self._dispatcher = Dispatcher(
            [
                EmulatedServo(RegisterFile(model, i, 4_000_000), motor, lambda: self.now_ns)  # type: ignore[arg-type]
                for i, motor in zip(IDS, self.motors, strict=True)
            ]
        )

    def answer(self, request: bytes) -> bytes:
        """What they answer to bytes on the wire."""
        out = b""
        for packet in PacketReader().feed(request):
            replies = self._dispatcher.handle(packet, 6, self.now_ns)
            out += b"".join(reply.data for reply in replies)
        return out


class DamagedPort:
    """Looks like `drivers.dynamixel.port.Port`; the servos' answers arrive damaged.

    They are spliced with the answer before: what a late reply on a real line would bring.
    """

    def __init__(self, servos: Servos, mutator: Mutator, random: Random) -> None:
        self.name, self.baud, self.stream = "fuzz", 4_000_000, self
        self._servos, self._mutator, self._random = servos, mutator, random
        self._before = b"\0"
        self.received = b""
        self.truth: list[tuple[int, int, int]] = []
        """Position, velocity and current of every servo."""
        self.damaged = 0

    def begin_tick(self) -> None:
        """Servos move on."""
        random = self._random
        self.truth = [
            (random.randint(-4096, 8192), random.randint(-300, 300), random.randint(-900, 900))
            for _ in IDS
        ]
        self.received = b""
        for motor, (position, velocity, current) in zip(
            self._servos.motors, self.truth, strict=True
        ):
            motor.values = Reading(0, current, velocity, position, 120, 30)

    def write(self, data: bytes) -> int:
        """Take a request and hold a damaged answer ready."""
        answer = self._servos.answer(data)
        if answer:
            self.received += self._mutator.damage(answer, self._before)
            self._before = answer
            self.damaged += 1
        return len(data)

    def read_available(self) -> bytes:
        """The damaged answer."""
        data, self.received = self.received, b""
        return data

    def discard_input(self) -> int:
        """Forget the answer."""
        self.received = b""
        return 0


class Verdicts:
    """What became of the mutated frames."""

    def __init__(self) -> None:
        self.count: Counter[str] = Counter()
        self.unexplained: list[str] = []

    def judge(self, who: str, stream: bytes, valid: bool, what: object) -> None:
        """A wrong value was accepted; `valid`: a CRC in the stream covers it."""
        self.count[f"{who}: wrong, CRC valid" if valid else f"{who}: wrong"] += 1
        if not valid:
            self.unexplained.append(f"{who}: {what} from {stream.hex(' ')}")


def valid_spans(stream: bytes) -> list[bytes]:
    """Parts of a stream that begin with a header and end in a CRC that fits, checked bitwise."""
    found = []
    start = stream.find(protocol.HEADER)
    while start >= 0:
        crc = crc16_bitwise(stream[start : start + 8])
        for end in range(start + 10, len(stream) + 1):
            if crc == stream[end - 2] | stream[end - 1] << 8:
                found.append(stream[start:end])
            crc = _crc(stream[end - 2 : end - 1], 0x8005, crc)
        start = stream.find(protocol.HEADER, start + 1)
    return found


def vouched(stream: bytes, part: bytes) -> bool:
    """Whether a CRC that fits covers some bytes."""
    return any(part in protocol.unstuff(span) or part in span for span in valid_spans(stream))


def fuzz_driver(frames: int, random: Random, fast: bool, verdicts: Verdicts) -> None:
    """Damaged answers to the driver's own reads: every value it marks as valid must be true."""
    mutator, timing = Mutator(random), BusTiming(4_000_000, 1_000_000, 125_000)
    members = [BusServo(servo_id, joint) for joint, servo_id in enumerate(IDS)]
    who = "driver, fast reads" if fast else "driver, plain reads"
    servos, now_ns, done = Servos(), 0, 0
    while done < frames:
        port = DamagedPort(servos, mutator, random)
        states = ServoStates.empty(len(IDS))
        idle = IdleReader(list(IDS), (WHOLE,), timing.baud)
        bus = ServoBus("fuzz", port, timing, members, states, fast, idle)  # type: ignore[arg-type]
        history: list[list[tuple[int, int, int]]] = []
        began_ns, received = now_ns, b""
        for _ in range(TICKS):
            servos.now_ns = now_ns
            port.begin_tick()
            history.append(port.truth)
            states.valid[:] = False
            bus.begin_read(now_ns)
            stream, received = received + port.received, port.received
            bus.collect()
            bus.finish_read()
            verdicts.count[f"{who}: values accepted"] += int(states.valid.sum())
            judge_states(who, states, began_ns, history, stream, verdicts)
            now_ns += PERIOD_NS
        done += port.damaged
    verdicts.count[f"{who}: frames"] += done


def judge_states(
    who: str,
    states: ServoStates,
    began_ns: int,
    history: list[list[tuple[int, int, int]]],
    stream: bytes,
    verdicts: Verdicts,
) -> None:
    """Compare what is marked as valid with what the servos had at the time it is said to be of."""
    for joint in np.flatnonzero(states.valid).tolist():
        sampled = (int(states.time_ns[joint]) - began_ns) // PERIOD_NS
        got = tuple(
            int(values[joint]) for values in (states.position, states.velocity, states.current)
        )
        if got == history[sampled][joint]:
            continue
        if any(got == truth[joint] for truth in history[sampled + 1 :]):
            verdicts.count[f"{who}: true, and newer than said"] += 1
        elif any(got == truth[joint] for truth in history[:sampled]):
            verdicts.count[f"{who}: true, but older than said"] += 1
        else:
            read = got[1].to_bytes(4, "little", signed=True) + got[0].to_bytes(
                4, "little", signed=True
            )
            verdicts.judge(who, stream, vouched(stream, read), got)


def instructions(random: Random) -> list[bytes]:
    """Real instruction packets of every kind."""
    goals = [(i, random.randint(0, 4095).to_bytes(4, "little")) for i in IDS]
    single = random.choice(IDS)
    return [
        protocol.encode_instruction(single, Instruction.PING),
        protocol.encode_instruction(BROADCAST_ID, Instruction.PING),
        protocol.encode_read(single, HOT.address, HOT.length),
        protocol.encode_write(single, 116, goals[0][1]),
        protocol.encode_write(single, 102, b"\xff\xff\xfd\xff\xff\xff"),
        protocol.encode_sync_read(IDS, HOT.address, HOT.length),
        protocol.encode_sync_read(IDS, HOT.address, HOT.length, fast=True),
        protocol.encode_sync_write(116, 4, goals),
        protocol.encode_bulk_read([(i, 120, 27) for i in IDS]),
        protocol.encode_instruction(single, Instruction.CLEAR, b"\x01\x44\x58\x4c\x22"),
        protocol.encode_instruction(single, Instruction.BACKUP, b"\x01CTRL"),
        protocol.encode_instruction(single, Instruction.ACTION),
    ]


def fuzz_servos(frames: int, random: Random, verdicts: Verdicts) -> None:
    """Damaged instructions to emulated servos, which obey only what has a valid CRC."""
    mutator, reader = Mutator(random), PacketReader()
    for done in range(frames):
        if done % 1000 == 0:
            servos, kinds = Servos(), instructions(random)
            sent = [packet for kind in kinds for packet in PacketReader().feed(kind)]
        stream = mutator.damage(random.choice(kinds), random.choice(kinds))
        reader.reset()
        for packet in reader.feed(stream):
            verdicts.count["servo: packets accepted"] += 1
            if packet not in sent:
                body = bytes((packet.instruction,)) + packet.params
                verdicts.judge("servo", stream, vouched(stream, body), packet)
        servos.answer(stream)
    verdicts.count["servo: frames"] += frames


def fuzz_boards(frames: int, random: Random, verdicts: Verdicts) -> None:
    """Damaged board frames to the board reader."""
    mutator, reader = Mutator(random), FrameReader()
    for done in range(frames):
        counts = [random.randint(-(1 << 23), 1 << 23) for _ in range(4)]
        raw = [random.randint(-32767, 32767) for _ in range(10)]
        foot = encode_foot_frame(done, done * 1667, 15, counts)
        imu = encode_imu_frame(done, done * 1667, 7, raw[:4], raw[4:7], raw[7:])
        frame, other = (foot, imu) if done % 2 else (imu, foot)
        sent = [FrameReader().feed(f)[0] for f in (foot, imu)]
        stream = mutator.damage(frame, other)
        # A damaged length keeps the reader waiting; a whole frame behind it ends the wait.
        for got in [*reader.feed(stream), *reader.feed(bytes(64))]:
            verdicts.count["boards: frames accepted"] += 1
            if got not in sent:
                verdicts.judge("boards", stream, _board_crc_fits(stream), got)
    verdicts.count["boards: frames"] += frames


def _board_crc_fits(stream: bytes) -> bool:
    padded = stream + bytes(64)
    for start in range(len(stream)):
        for size in (30, 34):
            frame = padded[start : start + size]
            fits = len(frame) == size and frame[:2] == b"\xa5\x5a"
            crc = frame[-2] | frame[-1] << 8 if fits else -1
            if fits and _crc(frame[2:-2], 0x1021, 0xFFFF) == crc:
                return True
    return False


def run(frames: int, seed: int) -> Verdicts:
    """Mutate about so many frames, shared out among all readers."""
    verdicts = Verdicts()
    share = -(-frames // 10)
    fuzz_driver(3 * share, Random(f"{seed} fast"), fast=True, verdicts=verdicts)
    fuzz_driver(2 * share, Random(f"{seed} plain"), fast=False, verdicts=verdicts)
    fuzz_servos(3 * share, Random(f"{seed} servo"), verdicts)
    fuzz_boards(2 * share, Random(f"{seed} boards"), verdicts)
    return verdicts


def main() -> int:
    """Run and print the counts; 1 if something wrong was accepted without a valid CRC."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    began = time.monotonic()
    verdicts = run(options.frames, options.seed)
    for what, number in sorted(verdicts.count.items()):
        print(f"{what:40} {number:9d}")
    print(f"{'seconds':40} {time.monotonic() - began:9.0f}")
    for line in verdicts.unexplained[:10]:
        print(line)
    return 1 if verdicts.unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
