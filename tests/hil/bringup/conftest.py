"""Virtual robots behind their ports, on the virtual clock, for commands run in this process."""

import shutil
from contextlib import nullcontext
from types import SimpleNamespace

import pytest
import yaml
from typer.testing import CliRunner

from drivers.assembly import expected_servos
from drivers.dynamixel.control_table import Register
from hil.cli.main import app
from hil.miswire import parse_miswires
from hil.robot_files import find_robot_file, load_robot
from sim_backends.plant import Plant
from sim_backends.virtual.hand import Hand
from sim_backends.virtual.miswiring import built_wrongly, mount_wrongly, plug_wrongly
from sim_backends.virtual.motors import nominal_motors
from sim_backends.virtual.robot import VirtualRobot

RATE = 300
CLOCKED = ("calibrating", "check", "jog", "monitor", "relax", "scan", "setup")


class Workbench:
    """A virtual robot at rest, and the command line that knows its ports."""

    def __init__(self, robot):
        self.robot = robot
        self.description = robot.description

    def url(self, name):
        return self.robot.port_urls[name]

    def ports(self, **instead):
        """`--port` options; a name may be given another one's port, or None for no port."""
        names = {name: name for name in self.robot.port_urls} | instead
        return [
            word
            for name, other in names.items()
            if other is not None
            for word in ("--port", f"{name}={self.url(other)}")
        ]

    def calibrate(self, what, *arguments, file="minibiped"):
        """`stride calibrate` with the virtual robot's own hand."""
        command = ("calibrate", what, file, *self.ports(), "--ports", self.ports_file)
        return self.stride(*command, "--by-hand-of-emulator", *arguments)

    def stride(self, *arguments, stdin=""):
        return CliRunner().invoke(app, list(map(str, arguments)), input=stdin)

    def silence_all_but(self, *joints):
        for joint in self.robot.servos:
            if joint not in joints:
                self.robot.inject(f"servo:{joint}:silent")

    def registers(self, joint):
        return self.robot.servos[joint].registers

    def servo(self, joint):
        return self.robot.servos[joint]


@pytest.fixture
def make_bench(monkeypatch, tmp_path):
    benches = []

    def make(*overrides, file="minibiped", miswire=()):
        described = load_robot(file, ("plant.draws=null", "plant.substeps=2", *overrides))
        wrong = parse_miswires(miswire, described)
        description = built_wrongly(described, wrong)
        plant = Plant(description, RATE, 0, nominal_motors(description))
        robot = VirtualRobot(description, plant, 0, RATE)
        robot.start()
        mount_wrongly(robot, wrong)
        plug_wrongly(robot.port_urls, wrong)
        for bus in description.buses:
            for servo in expected_servos(description, bus):
                robot.servos[servo.joint].registers[Register.SHUTDOWN] = int(servo.shutdown)
        for module in CLOCKED:
            monkeypatch.setattr(f"hil.bringup.{module}.MonotonicClock", lambda: robot.clock)
        benches.append(robot)
        workbench = Workbench(robot)
        workbench.ports_file = tmp_path / "ports.json"
        workbench.ports_file.write_text('{"control": "here"}', encoding="utf-8")
        hand = Hand(robot)
        world = SimpleNamespace(do_by_hand=lambda request: hand.do(request)["seconds"])
        monkeypatch.setattr("hil.compose.virtual_hand", lambda _: nullcontext(world))
        return workbench

    yield make
    for robot in benches:
        robot.close()


@pytest.fixture
def calibrated(make_bench, tmp_path):
    """A robot whose file names a calibration, true but for what a test changes."""

    def make(miswire=(), **changes):
        folder = tmp_path / "robot"
        shutil.copytree(find_robot_file("minibiped").parent, folder)
        file = folder / "minibiped.yaml"
        file.write_text(file.read_text(encoding="utf-8") + "\ncalibration: mine.yaml\n")
        bench = make_bench(file=str(file), miswire=miswire)
        content = {
            "robot": "minibiped",
            "provenance": {"date": "2026-01-02", "method": "ideal"},
            **bench.robot.calibration_data,
            **changes,
        }
        (folder / "mine.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
        bench.file, bench.path = str(file), folder / "mine.yaml"
        return bench

    return make


@pytest.fixture
def bench(make_bench):
    return make_bench()
