"""Faults of one emulated servo: what begins, and what ends it."""

import math
from collections.abc import Callable
from random import Random

from drivers.dynamixel.control_table import VOLTAGE_UNIT, Register
from hil.servo import COUNTS_PER_RADIAN
from sim_backends.virtual.bus import ServoBus
from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.motors import Reading
from sim_backends.virtual.servo import EmulatedServo

DRIFT_STEP_NS = 2_000_000
"""How often the loop of a servo with a drifting encoder follows it [ns]."""

End = Callable[[], None]
"""Undoes a fault."""


def nothing() -> None:
    """The end of a fault whose effect stays, like a reboot's."""


class ServoFaults:
    """Begins the faults of one servo. What it measures goes through the overlays in turn."""

    def __init__(self, servo: EmulatedServo, bus: ServoBus, clock: VirtualClock) -> None:
        self._servo, self._bus, self._clock = servo, bus, clock
        self._healthy = servo.drive.sense
        self._overlays: list[Callable[[Reading], Reading]] = []
        self._deaf = 0
        self._muted = False

    def begin(self, kind: str, values: tuple[float, ...], random: Random) -> End:
        """Begin a fault of `hil.fault_kinds`; returns what ends it."""
        if kind == "silent":
            return self._silence(values[0], random)
        begin: dict[str, Callable[..., End]] = {
            "frozen": self._freeze,
            "reboot": self._reboot,
            "alert": self._alert,
            "overheat": self._overheat,
            "undervoltage": self._undervoltage,
            "wrong_model": self._impersonate,
            "wrong_id": self._rename,
            "old_firmware": self._downgrade,
            "lost_torque": self._lose_torque,
            "watchdog_trip": self._trip,
            "drift": self._drift,
        }
        return begin[kind](*values)

    # Communication ---------------------------------------------------------------------------

    def _silence(self, share: float, random: Random) -> End:
        """Deaf and mute, for good or by chance packet by packet."""
        if share < 1.0:
            return self._bus.wire().before_packets(lambda: self._mute(random.random() < share))
        self._deaf += 1
        self._mute(True)
        if self._servo.watchdog_ns:
            episode = self._deaf
            due_ns = self._clock.now_ns() + self._servo.watchdog_ns
            self._clock.schedule(due_ns, lambda: self._watchdog_of_a_deaf(episode))
        return self._hear_again

    def _hear_again(self) -> None:
        self._mute(False)

    def _mute(self, mute: bool) -> None:
        self._muted = mute
        self._servo.set_mute(mute)

    def _watchdog_of_a_deaf(self, episode: int) -> None:
        """It hears no packet although the bus is busy, so its own watchdog trips."""
        if self._muted and episode == self._deaf:
            self._servo.trip()

    def _freeze(self) -> End:
        self._servo.drive.frozen = True
        return self._thaw

    def _thaw(self) -> None:
        self._servo.drive.frozen = False

    def _impersonate(self, number: float) -> End:
        registers = self._servo.registers
        true = registers[Register.MODEL_NUMBER]
        registers[Register.MODEL_NUMBER] = int(number)

        def end() -> None:
            registers[Register.MODEL_NUMBER] = true

        return end

    def _rename(self, servo_id: float) -> End:
        true = self._servo.id
        self._servo.take_id(int(servo_id))
        return lambda: self._servo.take_id(true)

    def _downgrade(self, version: float) -> End:
        """Another version from now on; it restarts with it."""
        self._servo.registers.install(int(version))
        self._servo.reboot()
        self._servo.ready_ns = self._clock.now_ns()
        return nothing

    # States that only a reboot or the driver undoes ------------------------------------------

    def _reboot(self) -> End:
        self._servo.reboot()
        return nothing

    def _alert(self, error: float) -> End:
        self._servo.drive.raise_error(int(error))
        return nothing

    def _lose_torque(self) -> End:
        self._servo.drive.lose_torque()
        return nothing

    def _trip(self) -> End:
        self._servo.trip()
        return nothing

    # What it measures ------------------------------------------------------------------------

    def _overheat(self, celsius: float, rise_s: float) -> End:
        begin_ns = self._clock.now_ns()

        def hot(reading: Reading) -> Reading:
            elapsed_s = 1e-9 * (self._clock.now_ns() - begin_ns)
            share = 1.0 if elapsed_s >= rise_s else elapsed_s / rise_s
            cold = reading.temperature
            return reading._replace(temperature=max(0, round(cold + share * (celsius - cold))))

        return self._overlay(hot)

    def _undervoltage(self, volts: float) -> End:
        voltage = round(volts / VOLTAGE_UNIT)
        return self._overlay(lambda reading: reading._replace(voltage=voltage))

    def _drift(self, degrees_per_s: float) -> End:
        """The encoder reads more than there is; the servo's own loop works with what it reads."""
        begin_ns = self._clock.now_ns()
        rate = math.radians(degrees_per_s) * COUNTS_PER_RADIAN * 1e-9
        drive = self._servo.drive
        running = True

        def error() -> int:
            return round(rate * (self._clock.now_ns() - begin_ns))

        def follow() -> None:
            drive.shift_encoder(error() if running else 0)
            if running:
                self._clock.schedule(self._clock.now_ns() + DRIFT_STEP_NS, follow)

        undo = self._overlay(lambda reading: reading._replace(position=reading.position + error()))
        follow()

        def end() -> None:
            nonlocal running
            running = False
            undo()

        return end

    def _overlay(self, overlay: Callable[[Reading], Reading]) -> End:
        self._overlays.append(overlay)
        self._servo.drive.sense = self._sense

        def end() -> None:
            self._overlays.remove(overlay)
            if not self._overlays:
                self._servo.drive.sense = self._healthy

        return end

    def _sense(self) -> Reading:
        reading = self._healthy()
        for overlay in self._overlays:
            reading = overlay(reading)
        return reading
