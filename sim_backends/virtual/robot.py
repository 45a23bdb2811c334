"""A whole virtual robot: its servos and boards on serial lines, moved by a plant."""

from collections.abc import Callable
from itertools import count
from typing import Any

import numpy as np

from hil.description import RobotDescription
from hil.errors import InputError
from hil.fault_spec import FaultSpec, parse_fault
from sim_backends.latency import held_ns
from sim_backends.plant import Plant
from sim_backends.sensor_models import CellErrors, ImuErrors, dead_cells
from sim_backends.virtual import protocol_virtual
from sim_backends.virtual.adapter import UsbAdapter
from sim_backends.virtual.boards import FrameMaker, InertialUnit, LoadCells, SensorBoard
from sim_backends.virtual.bus import ServoBus
from sim_backends.virtual.clock import VirtualClock
from sim_backends.virtual.host_port import Device, HostPort
from sim_backends.virtual.host_timing import HostTiming
from sim_backends.virtual.injector import Injector
from sim_backends.virtual.journal import Journal
from sim_backends.virtual.motors import Motor, MotorBank, servo_models
from sim_backends.virtual.register_file import RegisterFile
from sim_backends.virtual.servo import EmulatedServo

_keys = count()


class VirtualRobot:
    """Every bus and board of a description, emulated on one plant and one virtual clock.

    `start` makes the lines available to pyserial under `port_urls`. A seed draws the boards'
    zeros, scales and clocks, the sensors' biases and noise, and the jitter of transfers.
    """

    def __init__(
        self,
        description: RobotDescription,
        plant: Plant,
        seed: int,
        rate_hz: int,
        host_now_ns: Callable[[], int] | None = None,
    ) -> None:
        """`host_now_ns`: time of a host that runs in real time, on the axis of the virtual clock;
        without it the host lives on the virtual clock, and its compute time is modelled.

        Raises InputError for a robot without servos, or a plant made for another rate.
        """
        if plant.rate_hz != rate_hz:
            raise InputError(f"plant made for {plant.rate_hz} Hz, loop at {rate_hz} Hz")
        self.description = description
        self.world = plant
        """Ground truth and disturbances."""
        self.clock = VirtualClock(plant)
        names = (*description.buses, *description.boards)
        self.ports = {name: HostPort(name, self.clock) for name in names}
        """The host's ends of all lines, by the names of buses and boards."""
        key = f"{description.name}-{next(_keys)}"
        self.port_urls = {name: f"{protocol_virtual.SCHEME}{key}/{name}" for name in names}
        # Other streams than those of the plant and of the MuJoCo backend's sensors.
        wires, sensors = (np.random.default_rng((seed, stream)) for stream in (2, 3))
        self.servos = _make_servos(description, plant, self.clock)
        """By joint name."""
        ports = [self.ports[name] for name in description.buses]
        if host_now_ns is None:
            compute_ns = 1000 * description.timing.compute_us
            host = HostTiming(compute_ns, ports, self.clock.now_ns)
        else:
            host = HostTiming(0, ports, host_now_ns)
        self._buses = buses = self._make_buses(wires, host)
        self.cells = {
            side: LoadCells(
                plant,
                index,
                CellErrors(description.noise, sensors, 4, dead_cells(description, side)),
                sensors,
            )
            for index, side in enumerate(("left", "right"))
        }
        self.imu = InertialUnit(
            plant, ImuErrors(description.noise, sensors, plant.hidden.pitch_bias)
        )
        lines: dict[str, ServoBus | SensorBoard] = {**buses, **self._make_boards(sensors)}
        self.devices: dict[str, Device] = {**lines}
        """What hangs on each line."""
        self.faults = Injector(description, self.clock, seed, self.servos, lines, self.ports)
        """What goes wrong, and when."""

    def _make_buses(self, random: np.random.Generator, host: HostTiming) -> dict[str, ServoBus]:
        description = self.description
        buses = {}
        for name, bus in description.buses.items():
            joints = [joint.name for joint in description.joints if joint.bus == name]
            adapter = UsbAdapter(
                bus, description.timing, description.noise, random, self.ports[name]
            )
            servos = [self.servos[joint] for joint in joints]
            buses[name] = ServoBus(servos, adapter, host, self.clock)
        return buses

    def _make_boards(self, random: np.random.Generator) -> dict[str, SensorBoard]:
        description = self.description
        sources: dict[str, FrameMaker] = {
            foot.board: self.cells[side].frame
            for side, foot in description.feet.items()
            if foot.board is not None
        }
        if description.imu is not None:
            sources[description.imu.board] = self.imu.frame
        return {
            name: SensorBoard(
                description, description.boards[name], self.clock, random, self.ports[name],
                source, held_ns(description, description.boards[name]),
            )
            for name, source in sources.items()
        }  # fmt: skip

    @property
    def calibration_data(self) -> dict[str, Any]:
        """What an ideal calibration holds, but for the zero errors of `description.noise`:
        `feet` (side to zero [counts] and scale [N/count] of each corner) and `joint_offsets`."""
        feet = self.description.feet
        return {
            "feet": {s: self.cells[s].calibration() for s in feet if feet[s].board is not None},
            "joint_offsets": dict.fromkeys(self.description.joint_names, 0.0),
        }

    def inject(self, fault: str | FaultSpec) -> None:
        """Have something go wrong; T counts from now. Raises InputError."""
        spec = parse_fault(fault) if isinstance(fault, str) else fault
        self.faults.inject(spec, self.clock.now_ns())

    def journal(self, now_ns: Callable[[], int]) -> Journal:
        """Begin to write down what buses hear and servos do; times by `now_ns`."""
        return Journal(self.servos, self._buses, now_ns)

    def start(self) -> None:
        """Make the lines available to `serial.serial_for_url`."""
        for name, url in self.port_urls.items():
            protocol_virtual.register(url, self.ports[name], self.devices[name])

    def close(self) -> None:
        """Take the lines away; safe to call twice."""
        for url in self.port_urls.values():
            protocol_virtual.unregister(url)


def _make_servos(
    description: RobotDescription, plant: Plant, clock: VirtualClock
) -> dict[str, EmulatedServo]:
    models = servo_models(description)
    if plant.servos is None:
        raise InputError(f"{description.file}: the plant of {description.name} has no motors")
    bank = MotorBank(plant, plant.servos, models)
    servos = {}
    for index, (joint, model) in enumerate(zip(description.joints, models, strict=True)):
        if joint.bus is not None and joint.id is not None:
            registers = RegisterFile(model, joint.id, description.buses[joint.bus].baud)
            servos[joint.name] = EmulatedServo(registers, Motor(bank, index), clock.now_ns)
    return servos
