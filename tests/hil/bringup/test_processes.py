"""The commands as processes, on the terminals of a virtual robot in a process of its own."""

import json
import os
import pty
import signal
import subprocess
import sys
import time

import pytest

from drivers.commissioning.line import ServoLine
from drivers.dynamixel.control_table import Register
from drivers.dynamixel.port import Port
from hil.clock import MonotonicClock
from hil.errors import BackendError
from sim_backends.virtual.remote import ServerProcess

STRIDE = [sys.executable, "-c", "from hil.cli.main import main; main()"]
PATIENCE_S = 60.0
LIGHT = ("plant.draws=null", "plant.substeps=1")
"""Coarse physics: a busy machine must keep up with real time."""
pytestmark = pytest.mark.pty


@pytest.fixture(scope="module")
def robot():
    made = ServerProcess("minibiped", 300, 0, LIGHT)
    yield made
    made.close()


@pytest.fixture
def jogging(robot, tmp_path):
    """`stride jog` in a process, its torque on; what the servo says afterwards."""
    port = robot.port_urls["left_leg"]
    words = ["jog", port, "--id", "1", "--baud", "4000000", "--degrees", "2", "--speed", "2"]
    process = subprocess.Popen(
        [*STRIDE, *words, "--yes", "--out", str(tmp_path / "run")],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    deadline = time.monotonic() + PATIENCE_S
    while not (tmp_path / "run").exists():
        assert process.poll() is None and time.monotonic() < deadline, process.communicate()
        time.sleep(0.05)
    time.sleep(1.5)  # The folder is made just before torque goes on.
    yield process
    process.kill()
    process.communicate()


def torque_of(port):
    """Torque Enable of id 1, once the port is free."""
    deadline = time.monotonic() + PATIENCE_S
    while True:
        try:
            line = ServoLine(Port("test", port, 4_000_000), MonotonicClock())
            break
        except ValueError:
            assert time.monotonic() < deadline
            time.sleep(0.1)
    try:
        return line.client.read(1, Register.TORQUE_ENABLE)
    except BackendError:
        return line.client.read(1, Register.TORQUE_ENABLE)  # A busy machine answered late.
    finally:
        line.close()


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -9)]
)
def test_however_a_jog_ends_torque_is_off(robot, jogging, number, code):
    assert jogging.poll() is None
    jogging.send_signal(number)
    assert jogging.wait(PATIENCE_S) == code
    time.sleep(0.3)
    assert torque_of(robot.port_urls["left_leg"]) == 0


def test_a_person_who_says_no_is_obeyed(robot):
    """`relax` on a terminal: the question is asked there, and no is an answer."""
    master, slave = pty.openpty()
    words = ["relax", robot.port_urls["left_leg"]]
    with subprocess.Popen(
        [*STRIDE, *words], stdin=slave, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        os.write(master, b"n\n")
        _, errors = process.communicate(timeout=PATIENCE_S)
    os.close(master)
    os.close(slave)
    assert process.returncode == 1
    assert b"will go limp and fall if nobody holds it" in errors
    assert errors.decode().endswith("stride: nothing was done\n")


def test_what_emulate_prints_is_what_ports_takes(robot, tmp_path):
    names = ("left_leg", "right_leg")
    buses = {name: robot.port_urls[name] for name in names}
    boards = {name: url for name, url in robot.port_urls.items() if name not in names}
    ports = tmp_path / "ports.json"
    ports.write_text(json.dumps({"buses": buses, "boards": boards, "control": "x"}))
    words = ["monitor", "--ports", str(ports), "--json", "--duration", "1"]
    result = subprocess.run(
        [*STRIDE, *words], capture_output=True, text=True, timeout=PATIENCE_S, check=True
    )
    last = json.loads(result.stdout.splitlines()[-1])
    assert len(last["joints"]) == 12
    assert any(joint["position_deg"] is not None for joint in last["joints"])


def test_a_calibration_that_is_broken_off_leaves_the_file_as_it_was(robot, tmp_path):
    ports, out = tmp_path / "ports.json", tmp_path / "mine.yaml"
    ports.write_text(json.dumps({"buses": robot.port_urls}), encoding="utf-8")
    old = "robot: minibiped\nprovenance: {date: 2026-01-02, method: by hand}\n"
    out.write_text(old, encoding="utf-8")
    process = subprocess.Popen(
        [*STRIDE, "calibrate", "imu", "--ports", str(ports), "--out", str(out)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout.readline().endswith("and still [Enter]\n")
        process.stdin.write("\n")
        process.stdin.flush()
        assert process.stdout.readline().startswith("Tilt the torso forward")
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE_S) == 130
    finally:
        process.kill()
        process.communicate()
    assert out.read_text(encoding="utf-8") == old
    assert sorted(tmp_path.iterdir()) == [out, ports]
