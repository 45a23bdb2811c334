"""The backend without wires: the interface straight on the MuJoCo plant."""

import math
from collections import deque

import numpy as np

from hil.description import RobotDescription
from hil.errors import BackendError, InputError, InvalidCommandError
from hil.interface import AppliedCommand, JointCommand, Limit, SensorFrame, StopMode
from hil.servo import JOINT_MODES, ServoGoals, ServoMapping, ServoMode
from sim_backends.latency import command_latency_ns
from sim_backends.plant import Plant
from sim_backends.plant_clock import PlantClock
from sim_backends.plant_sensors import PlantSensors

_FIELDS = ("position", "velocity", "stiffness", "damping", "torque")
BUS_KEYS = ("bus_utilisation_pct", "bus_crc_errors", "bus_timeouts", "bus_stale_frames")


class MujocoBackend:
    """Implements `hil.interface.Backend` on a plant, in virtual time.

    A servo robot's commands pass the same gain mapping and servo physics as on the bus, and act
    at the first grid point after `command_latency_ns`. A torque robot takes `command.torque` at
    once, clamped to each joint's limit, for the whole tick. Time passes in `clock.sleep_until_ns`.
    """

    name = "mujoco"
    changes = ()
    """A plant has nothing to correct."""

    def __init__(
        self,
        description: RobotDescription,
        plant: Plant,
        mapping: ServoMapping | None,
        rate_hz: int,
        seed: int = 0,
    ) -> None:
        """Raises InputError if plant, mapping and rate do not fit each other."""
        if (mapping is None) != (plant.servos is None):
            raise InputError(
                f"{description.file}: a {description.actuation} robot takes "
                f"{'no' if mapping is not None else 'a'} servo mapping"
            )
        if plant.rate_hz != rate_hz:
            raise InputError(f"plant made for {plant.rate_hz} Hz, loop at {rate_hz} Hz")
        n = len(description.joints)
        self._description = description
        self._names = description.joint_names
        self._plant = plant
        self._mapping = mapping
        self._sensors = PlantSensors(plant, seed)
        self.clock: PlantClock = PlantClock(plant, self._apply_pending, self._sensors.after_substep)
        self._latency_ns = command_latency_ns(description)
        self._torque_limit = np.array([joint.torque_limit for joint in description.joints])
        self._frame = SensorFrame.empty(n, description.imu is not None)
        self._applied = AppliedCommand.zeros(n)
        self._hold = JointCommand.zeros(n)
        self._torque = np.zeros(n)
        self._pending: deque[tuple[int, ServoGoals]] = deque()
        self._armed = False
        self._open = False
        self._set_modes()

    def _set_modes(self) -> None:
        """Put every servo into the mode that its joint is driven in."""
        if self._plant.servos is not None:
            for firmware, joint in zip(
                self._plant.servos.firmware, self._description.joints, strict=True
            ):
                firmware.mode = JOINT_MODES[joint.mode]
            self._plant.servos.refresh()

    def open(self) -> None:
        """Begin; torque stays off."""
        self._open = True

    def read(self) -> SensorFrame:
        """The frame of this moment; reused. Raises BackendError if not open."""
        self._require_open()
        self._sensors.fill(self._frame, self.clock.now_ns(), self._torque)
        return self._frame

    def arm(self) -> None:
        """Adopt the present position as goal, then enable torque. Raises BackendError."""
        frame = self.read()
        if self._mapping is not None and self._plant.servos is not None:
            hold = self._hold
            hold.position[:] = frame.joint_position
            hold.stiffness[:] = [joint.stiffness for joint in self._description.joints]
            hold.damping[:] = [joint.damping for joint in self._description.joints]
            goals, _ = self._mapping.map(hold, frame)
            self._pending.clear()
            self._plant.servos.set_goals(goals)
        self._enable(True)

    def _enable(self, on: bool) -> None:
        servos = self._plant.servos
        if servos is not None:
            for servo in range(servos.enabled.size):
                servos.set_enabled(servo, on)
        else:
            self._torque[:] = 0.0
            self._plant.set_torque(self._torque)
        self._armed = on

    def write(self, command: JointCommand) -> AppliedCommand:
        """Command every joint; the returned object is reused. HELD before `arm` and after `stop`.

        Raises InvalidCommandError, with nothing applied, if a number is not finite, and
        BackendError if not open.
        """
        self._require_open()
        require_finite(command, self._names)
        if self._mapping is not None:
            goals, applied = self._mapping.map(command, self._frame)
            if not self._armed:
                applied.limit |= int(Limit.HELD)
                return applied
            due_ns = self._frame.time_ns + self._latency_ns
            self._pending.append((due_ns, _copied(goals)))
            return applied
        return self._apply_torque(command)

    def _apply_torque(self, command: JointCommand) -> AppliedCommand:
        applied, limit = self._applied, self._torque_limit
        np.minimum(command.torque, limit, out=applied.torque)
        np.maximum(applied.torque, -limit, out=applied.torque)
        np.not_equal(applied.torque, command.torque, out=applied.limit, casting="unsafe")
        applied.limit *= int(Limit.TORQUE)
        applied.position[:] = command.position
        applied.velocity[:] = command.velocity
        if self._armed:
            self._torque[:] = applied.torque
            self._plant.set_torque(self._torque)
        else:
            applied.limit |= int(Limit.HELD)
        return applied

    def _apply_pending(self, grid_ns: int) -> None:
        """Let goals act that have arrived by the grid point to come."""
        while self._pending and self._pending[0][0] <= grid_ns:
            _, goals = self._pending.popleft()
            if self._plant.servos is not None:
                self._plant.servos.set_goals(goals)

    def stop(self, mode: StopMode) -> bool:
        """End motion at once.

        Soft: servos hold their last goals; a torque robot has none to hold, its torques end.
        """
        self._pending.clear()
        if mode is StopMode.TORQUE_OFF or self._plant.servos is None:
            self._enable(False)
        else:
            self._rest()
        self._armed = False
        return True

    def _rest(self) -> None:
        """A servo in current mode has no place to hold: no current."""
        if self._plant.servos is not None:
            for firmware in self._plant.servos.firmware:
                if firmware.mode == ServoMode.CURRENT:
                    firmware.goal_current = 0.0

    def close(self) -> None:
        """Torque off, and no more reading or writing."""
        if self._open:
            self.stop(StopMode.TORQUE_OFF)
        self._open = False

    def statistics(self) -> dict[str, float | None]:
        """Servo figures of a servo robot; None for the bus, which is not there."""
        return {**dict.fromkeys(BUS_KEYS), **self._plant.figures()}

    def _require_open(self) -> None:
        if not self._open:
            raise BackendError(f"{self._description.name}: the MuJoCo backend is not open")


def _copied(goals: ServoGoals) -> ServoGoals:
    """The mapping reuses its goals, and slow buses hold them for more than a tick."""
    current = None if goals.current is None else goals.current.copy()
    return ServoGoals(
        goals.position.copy(),
        goals.p_gain.copy(),
        goals.d_gain.copy(),
        goals.pwm_limit.copy(),
        current,
    )


def require_finite(command: JointCommand, names: tuple[str, ...]) -> None:
    """Raise InvalidCommandError, naming the joints, unless every number is there and finite."""
    arrays = (
        command.position, command.velocity, command.stiffness, command.damping, command.torque
    )  # fmt: skip
    sizes = [array.size for array in arrays]
    if sizes != [len(names)] * len(arrays):
        shapes = {name: a.shape for name, a in zip(_FIELDS, arrays, strict=True)}
        raise InvalidCommandError(f"{len(names)} joints, but the command has shapes {shapes}")
    if all(all(map(math.isfinite, array.tolist())) for array in arrays):
        return
    bad = [
        f"joint {name}: commanded {field} is {value}"
        for field, array in zip(_FIELDS, arrays, strict=True)
        for name, value in zip(names, array, strict=True)
        if not np.isfinite(value)
    ]
    raise InvalidCommandError("; ".join(bad))
