"""The backend of a robot with servo buses and sensor boards, real or virtual."""

from collections.abc import Mapping
from contextlib import suppress

import numpy as np

from drivers.assembly import (
    BusParts,
    assemble_boards,
    bus_budgets,
    open_bus,
    port_url,
)
from drivers.boards.sensors import BoardSensors
from drivers.calibration import RobotCalibration
from drivers.command_check import require_sound
from drivers.dynamixel.budget import wire_time_ns
from drivers.dynamixel.bus import LEAST_MARGIN_NS, ServoBus
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.port import Port
from drivers.dynamixel.read_plan import BusServo
from drivers.dynamixel.states import ServoStates
from drivers.joint_converter import JointConverter
from hil.description import RobotDescription
from hil.errors import BackendError
from hil.interface import (
    AppliedCommand,
    Clock,
    JointCommand,
    Limit,
    SensorFrame,
    StopMode,
)
from hil.servo import ServoGoals, ServoMapping

REFRESH_ATTEMPTS = 5
"""Reads after arming until every servo answers; a servo that does not is the loop's to judge."""


class BusBackend:
    """Drives a robot over its Dynamixel buses and reads its boards.

    A tick is `read`, which asks all buses, then receives all, then takes what the boards sent; and
    `write`, which maps the command onto registers and sends what changed. Before `arm` and after
    `stop` nothing that `write` is given leaves the computer; the applied command says HELD.
    """

    name = "bus"

    def __init__(
        self,
        description: RobotDescription,
        clock: Clock,
        rate_hz: int,
        port_urls: Mapping[str, str],
        calibration: RobotCalibration,
        mapping: ServoMapping,
    ) -> None:
        self.clock = clock
        self.changes: list[str] = []
        """Servo settings that `open` corrected."""
        self._description = description
        self._rate_hz = rate_hz
        self._port_urls = dict(port_urls)
        self._calibration = calibration
        self._mapping = mapping
        n = len(description.joints)
        self._n = n
        self._states = ServoStates.empty(n)
        self._frame = SensorFrame.empty(n, description.imu is not None)
        self._converter = JointConverter(description, calibration)
        self._parts: list[BusParts] = []
        self._ports: dict[str, Port] = {}
        self._group = BusGroup((), clock)
        self._boards = BoardSensors({}, None)
        self._goals: ServoGoals | None = None
        self._armed = False
        self._powered = False
        self._opened_ns = 0
        self._traffic: dict[str, int] = {}
        self._ticks = 0
        self._saturated = np.zeros(n, dtype=np.int64)
        self._hottest = np.full(n, np.nan)
        self._lowest_voltage = np.full(n, np.nan)

    def open(self) -> None:
        """Connect and check; torque stays as it is found. Raises BackendError or InputError."""
        description = self._description
        for budget in bus_budgets(description):
            budget.check(self._rate_hz)
        self._calibration.check_against(description)
        try:
            self._open_ports()
            self._audit()
        except BaseException:
            self._close_ports()
            raise
        self._opened_ns = self.clock.now_ns()
        self._traffic = {part.name: self._bytes_of(part.port) for part in self._parts}

    def read(self) -> SensorFrame:
        """The frame of this tick, reused by the next call. Raises BackendError."""
        self._require_open()
        frame = self._frame
        frame.time_ns = self.clock.now_ns()
        self._states.valid[:] = False
        self._group.send_reads()
        self._group.receive()
        self._boards.read(self.clock.now_ns(), frame)
        self._converter.convert(self._states, frame)
        np.fmax(self._hottest, frame.joint_temperature, out=self._hottest)
        np.fmin(self._lowest_voltage, frame.joint_voltage, out=self._lowest_voltage)
        return frame

    def arm(self) -> None:
        """Adopt the present position as goal, then enable torque. Raises BackendError."""
        self._require_open()
        goals = self._present_goals()
        self._powered = True
        try:
            for part in self._parts:
                ids = [servo.id for servo in part.servos]
                positions = _by_id(ids, goals.position[list(part.joints)])
                p_gains = _by_id(ids, goals.p_gain[list(part.joints)])
                part.power.prepare(positions, p_gains)
            for part in self._parts:
                part.power.on()
            for part in self._parts:
                part.power.arm_watchdog()
            self._refresh()
        except BaseException:
            self.stop(StopMode.TORQUE_OFF)
            raise
        for bus in self._group.buses:
            bus.forget_written()
        self._goals = goals
        self._armed = True

    def write(self, command: JointCommand) -> AppliedCommand:
        """Send a command; raises InvalidCommandError and sends nothing if it is not sound."""
        require_sound(command, self._description.joint_names)
        goals, applied = self._mapping.map(command, self._frame)
        if not self._armed:
            applied.limit |= int(Limit.HELD)
            return applied
        self._group.write(goals)
        self._goals = goals
        self._ticks += 1
        self._saturated += (applied.limit & int(Limit.SATURATION)) != 0
        return applied

    def stop(self, mode: StopMode) -> bool:
        """End motion; True when the result was read back."""
        self._armed = False
        if mode is StopMode.TORQUE_OFF:
            # Every bus gets its frames before any is waited for.
            for part in self._parts:
                with suppress(BackendError):
                    part.power.send_off()
        verified = [self._stop_bus(part, mode) for part in self._parts]
        done = bool(verified) and all(verified)
        if mode is StopMode.TORQUE_OFF and done:
            self._powered = False
        return done

    def close(self) -> None:
        """Torque off if `arm` switched it on, then release the ports. Safe to call twice."""
        try:
            if self._powered:
                self.stop(StopMode.TORQUE_OFF)
        finally:
            self._close_ports()

    def statistics(self) -> dict[str, float | None]:
        """Counters for the report."""
        counters = [bus.counters for bus in self._group.buses]
        saturated_pct = 100 * self._saturated.max() / self._ticks if self._ticks else np.nan
        return {
            "bus_utilisation_pct": self._utilisation_pct(),
            "bus_crc_errors": float(sum(counter.crc_errors for counter in counters)),
            "bus_timeouts": float(sum(counter.timeouts for counter in counters)),
            "bus_stale_frames": float(sum(counter.stale for counter in counters)),
            "temperature_max_c": _known(np.fmax.reduce(self._hottest)),
            "voltage_min_v": _known(np.fmin.reduce(self._lowest_voltage)),
            "duty_saturation_pct_max": _known(saturated_pct),
        }

    def _require_open(self) -> None:
        if not self._parts:
            raise BackendError(f"{self._description.name}: the bus backend is not open")

    def _open_ports(self) -> None:
        description = self._description
        for name in description.buses:
            url = port_url(self._port_urls, name)
            part = open_bus(description, self.clock, name, url)
            self._ports[name] = part.port
            self._parts.append(part)
        for name, board in description.boards.items():
            self._ports[name] = Port(name, port_url(self._port_urls, name), board.baud)
        tick_ns = 1_000_000_000 // self._rate_hz
        self._boards = assemble_boards(description, self._calibration, self._ports, tick_ns)

    def _audit(self) -> None:
        """Check the servos, then set up the hot path for what they can do."""
        results = {part.name: part.audit() for part in self._parts}
        problems = [problem for result in results.values() for problem in result.problems]
        if problems:
            raise BackendError("; ".join(problems))
        self.changes = [change for result in results.values() for change in result.changes]
        fast = {name: result.fast_reads for name, result in results.items()}
        margins = {}
        for budget in bus_budgets(self._description, fast):
            budget.check(self._rate_hz)
            margins[budget.bus] = max(LEAST_MARGIN_NS, budget.slack_ns(self._rate_hz))
        buses = []
        for part in self._parts:
            part.read_slow(self._states)
            servos = [
                BusServo(servo.id, joint)
                for servo, joint in zip(part.servos, part.joints, strict=True)
            ]
            name = part.name
            buses.append(
                ServoBus(
                    name, part.port, part.timing, servos, self._states, fast[name], margins[name]
                )
            )
        self._group = BusGroup(buses, self.clock)

    def _present_goals(self) -> ServoGoals:
        """Goals at the present positions with the robot's default gains."""
        counts = np.zeros(self._n, dtype=np.int64)
        for part in self._parts:
            found = part.power.present_positions()
            counts[list(part.joints)] = [found[servo.id] for servo in part.servos]
        command = JointCommand.zeros(self._n)
        self._states.position[:] = counts
        self._converter.convert(self._states, self._frame)
        command.position[:] = self._frame.joint_position
        command.stiffness[:] = [joint.stiffness for joint in self._description.joints]
        command.damping[:] = [joint.damping for joint in self._description.joints]
        goals, _ = self._mapping.map(command, self._frame)
        goals.position[:] = counts
        return goals

    def _refresh(self) -> None:
        """Read until every servo was heard: arming took many ticks, and ages count from here."""
        for _ in range(REFRESH_ATTEMPTS):
            self._states.valid[:] = False
            self._group.send_reads()
            self._group.receive()
            if self._states.valid.all():
                return

    def _stop_bus(self, part: BusParts, mode: StopMode) -> bool:
        """Stop one bus; a bus that is lost must not keep the others from stopping."""
        try:
            if mode is StopMode.TORQUE_OFF:
                return part.power.off()
            if self._goals is None:
                return False
            ids = [servo.id for servo in part.servos]
            return part.power.hold(_by_id(ids, self._goals.position[list(part.joints)]))
        except BackendError:
            return False

    def _close_ports(self) -> None:
        for port in self._ports.values():
            port.close()
        self._ports.clear()
        self._parts.clear()
        self._armed = False

    def _bytes_of(self, port: Port) -> int:
        return port.sent_bytes + port.received_bytes

    def _utilisation_pct(self) -> float | None:
        """Share of time from `open` to the last tick in which the busiest bus carried bytes."""
        elapsed_ns = self._frame.time_ns - self._opened_ns
        if not self._group.buses or elapsed_ns <= 0:
            return None
        busy_ns = max(
            wire_time_ns(self._bytes_of(bus.port) - self._traffic[bus.name], bus.port.baud)
            for bus in self._group.buses
        )
        return 100 * busy_ns / elapsed_ns


def _by_id(ids: list[int], values: np.ndarray) -> dict[int, int]:
    return dict(zip(ids, values.tolist(), strict=True))


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
