"""The backend of a robot with servo buses and sensor boards, real or virtual."""

from collections.abc import Mapping

import numpy as np

from drivers.assembly import (
    BusParts,
    assemble_boards,
    bus_budgets,
    open_bus,
    port_url,
    require_bus_speeds,
)
from drivers.boards.sensors import BoardSensors
from drivers.bus_start import start_buses
from drivers.bus_statistics import BusStatistics
from drivers.calibration import RobotCalibration
from drivers.command_check import require_sound
from drivers.dynamixel.bus_group import BusGroup
from drivers.dynamixel.control_table import OperatingMode
from drivers.dynamixel.port import Port
from drivers.dynamixel.power import BusPower
from drivers.dynamixel.states import ServoStates
from drivers.guardian import Guardian
from drivers.joint_converter import JointConverter
from drivers.torque_off import send_off, switch_off
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
        *,
        guarded: bool = False,
    ) -> None:
        """`guarded`: while torque is on, a second process waits for this one's end, to switch
        torque off then. For real time only: a virtual clock has one process.
        """
        self.clock = clock
        self.changes: list[str] = []
        """Servo settings that `open` corrected, and what is wrong with an adapter."""
        self._description = description
        self._rate_hz = rate_hz
        self.port_urls = dict(port_urls)
        """By the names of buses and boards."""
        self.calibration = calibration
        """Of this robot."""
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
        self._guarded = guarded
        self._guardian = Guardian(lambda: switch_off(self._powers(), clock))
        self._goals: ServoGoals | None = None
        self._armed = False
        self._powered = False
        self._compute_ns = 1000 * description.timing.compute_us
        self._read_ns = 0
        self._statistics = BusStatistics(n)

    @property
    def goals(self) -> ServoGoals | None:
        """Registers of the last write; none before `arm`."""
        return self._goals

    def open(self) -> None:
        """Connect and check; torque stays as it is found. Raises BackendError or InputError.

        In real time it then listens for a second to what the gyro says of a body at rest.
        """
        description = self._description
        require_bus_speeds(description)
        for budget in bus_budgets(description):
            budget.check(self._rate_hz)
        self.calibration.require_whole(description)
        try:
            self._open_ports()
            self._start()
            if self._guarded and not self._boards.renew_bias(self.clock):
                self.changes.append("the torso moved: its gyro keeps the calibrated bias")
        except BaseException:
            self._close_ports()
            raise
        self._statistics.begin(self._group.buses, self.clock.now_ns())

    def read(self) -> SensorFrame:
        """The frame of this tick, reused by the next call. Raises BackendError."""
        self._require_open()
        frame = self._frame
        frame.time_ns = self.clock.now_ns()
        self._guardian.beat()
        self._states.valid[:] = False
        self._group.send_reads()
        self._group.receive()
        self._read_ns = self.clock.now_ns()
        self._boards.read(self._read_ns, frame)
        self._converter.convert(self._states, frame)
        self._statistics.take_frame(frame)
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
                part.power.prepare(positions, p_gains, self._currents(part, goals))
            if self._guarded:
                self._guardian.start()
            for part in self._parts:
                part.power.on()
            for part in self._parts:
                part.power.arm_watchdog()
            self._refresh()
        except BaseException:
            self.stop(StopMode.TORQUE_OFF)
            raise
        self._group.arm(True)
        self._goals = goals
        self._armed = True

    def write(self, command: JointCommand) -> AppliedCommand:
        """Send a command; raises InvalidCommandError and sends nothing if it is not sound."""
        require_sound(command, self._description.joint_names)
        goals, applied = self._mapping.map(command, self._frame)
        spare_ns = self._spare_ns()
        if not self._armed:
            self._group.write(None, spare_ns)
            applied.limit |= int(Limit.HELD)
            return applied
        self._group.write(goals, spare_ns)
        self._goals = goals
        self._statistics.take_command(applied)
        return applied

    def stop(self, mode: StopMode) -> bool:
        """End motion; True when the result was read back."""
        self._armed = False
        self._group.arm(False)
        if mode is StopMode.TORQUE_OFF:
            send_off(self._powers(), self.clock)
        verified = [self._stop_bus(part, mode) for part in self._parts]
        done = bool(verified) and all(verified)
        if mode is StopMode.TORQUE_OFF and done:
            self._powered = False
            self._guardian.close()
        return done

    def guardian_lost(self) -> bool:
        """Whether torque is on and the guardian that should watch over it is gone."""
        return self._powered and self._guarded and not self._guardian.alive()

    def close(self) -> None:
        """Torque off if `arm` switched it on, then release the ports. Safe to call twice."""
        try:
            if self._powered:
                self.stop(StopMode.TORQUE_OFF)
        finally:
            self._close_ports()
            if self._powered:
                self._guardian.take_over()

    def statistics(self) -> dict[str, float | None]:
        """Counters for the report."""
        return self._statistics.report()

    def _powers(self) -> list[BusPower]:
        return [part.power for part in self._parts]

    def _spare_ns(self) -> int:
        """Time from when the goals leave to the next tick [ns].

        On a virtual clock computing takes no time, and a virtual host lets the goals go when it
        should be done.
        """
        leave_ns = max(self.clock.now_ns(), self._read_ns + self._compute_ns)
        return self._frame.time_ns + 1_000_000_000 // self._rate_hz - leave_ns

    def _require_open(self) -> None:
        if not self._parts:
            raise BackendError(f"{self._description.name}: the bus backend is not open")

    def _open_ports(self) -> None:
        description = self._description
        for name in description.buses:
            url = port_url(self.port_urls, name)
            part = open_bus(description, self.clock, name, url)
            self._ports[name] = part.port
            self._parts.append(part)
        for name, board in description.boards.items():
            self._ports[name] = Port(name, port_url(self.port_urls, name), board.baud)
        tick_ns = 1_000_000_000 // self._rate_hz
        self._boards = assemble_boards(description, self.calibration, self._ports, tick_ns)

    def _start(self) -> None:
        """Check the servos, then set up the hot path for what they can do."""
        started = start_buses(
            self._description, self._parts, self._states, self.clock, self._rate_hz
        )
        self.changes = started.changes
        self._group = started.group

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
        self._guardian.beat()
        try:
            if mode is StopMode.TORQUE_OFF:
                return part.power.off()
            if self._goals is None:
                return False
            ids = [servo.id for servo in part.servos]
            positions = _by_id(ids, self._goals.position[list(part.joints)])
            return part.power.hold(positions, self._currents(part, self._goals))
        except BackendError:
            return False

    def _currents(self, part: BusParts, goals: ServoGoals) -> dict[int, int] | None:
        """Goal Currents of servos that are to rest: limits stay, goals are none."""
        if goals.current is None:
            return None
        return {
            servo.id: 0 if servo.mode is OperatingMode.CURRENT else int(goals.current[joint])
            for servo, joint in zip(part.servos, part.joints, strict=True)
        }

    def _close_ports(self) -> None:
        for port in self._ports.values():
            port.close()
        self._ports.clear()
        self._parts.clear()
        self._armed = False


def _by_id(ids: list[int], values: np.ndarray) -> dict[int, int]:
    return dict(zip(ids, values.tolist(), strict=True))
