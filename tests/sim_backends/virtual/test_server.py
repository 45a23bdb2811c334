"""The virtual robot as a process: ports, independent clients, control socket, clean ends."""

import itertools
import json
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import serial
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, PortHandler, Protocol2PacketHandler

from drivers.boards.frames import FrameReader
from hil.errors import BackendError, InputError
from hil.fault_spec import parse_fault
from hil.robot_files import load_robot
from hil.servo import COUNTS_PER_RADIAN
from sim_backends.plant import Plant
from sim_backends.virtual.remote import RemoteWorld, ServerProcess

pytestmark = [pytest.mark.pty, pytest.mark.usefixtures("patient_sdk")]

COMMAND = [sys.executable, "-m", "sim_backends.virtual.server", "minibiped", "--json"]


@pytest.fixture
def server():
    process = ServerProcess("minibiped", 300, 0, ("plant.draws=null",))
    yield process
    process.close()


@pytest.fixture
def world(server):
    made = RemoteWorld(server.control)
    yield made
    made.close()


def answered(call, attempts=5):
    """What a call of the SDK returns once it is answered: a busy machine may miss its time.

    The late answer must not be taken for that to the next request.
    """
    for _ in range(attempts):
        result = call()
        if (result[-2] if isinstance(result, tuple) else result) == COMM_SUCCESS:
            return result
        time.sleep(0.5)
    return result


def test_the_sdk_s_own_port_talks_to_it(server, world):
    port = PortHandler(server.port_urls["left_leg"])
    port.setBaudRate(4_000_000)
    sdk = Protocol2PacketHandler()
    try:
        assert answered(lambda: sdk.ping(port, 1)) == (1020, COMM_SUCCESS, 0)
        assert answered(lambda: sdk.write2ByteTxRx(port, 1, 84, 640)) == (COMM_SUCCESS, 0)
        assert answered(lambda: sdk.read2ByteTxRx(port, 1, 84)) == (640, COMM_SUCCESS, 0)
        reader = GroupSyncRead(port, sdk, 132, 4)
        for servo_id in range(1, 7):
            reader.addParam(servo_id)
        assert answered(reader.txRxPacket) == COMM_SUCCESS
        knee = 2048 + world.truth().joint_position[3] * COUNTS_PER_RADIAN
        assert reader.getData(4, 132, 4) == pytest.approx(knee, abs=60)  # Without torque it sinks.
        port.setBaudRate(1_000_000)
        assert sdk.ping(port, 1)[1] != COMM_SUCCESS
    finally:
        port.closePort()


def test_boards_stream_and_lose_what_nobody_reads(server):
    time.sleep(0.1)
    with serial.Serial(server.port_urls["imu"], 921600, timeout=0.5) as port:
        frames = FrameReader().feed(port.read(500))
    assert len(frames) >= 10
    steps = [b.sequence - a.sequence for a, b in itertools.pairwise(frames)]
    assert steps == [1] * len(steps)


def test_the_remote_world_is_the_robot_s(world):
    truth = world.truth()
    first_ns, height = truth.time_ns, truth.base_position[2]
    assert abs(time.monotonic_ns() - first_ns) < 1_000_000_000
    assert height == pytest.approx(0.228, abs=0.01)
    assert set(world.calibration_data["feet"]) == {"left", "right"}
    world.set_push(np.array([0.0, 0.0, 60.0]))
    world.set_support(False)
    time.sleep(0.3)
    truth = world.truth()
    assert truth.time_ns > first_ns
    assert truth.base_position[2] > height + 0.1


def test_the_remote_world_can_be_flooded(world):
    """Two metres of a liquid as heavy as mercury lift the robot off its feet."""
    height = world.truth().base_position[2]
    world.set_support(False)
    world.set_medium(2.0, 13_600.0, 1.0)
    give_up = time.monotonic() + 10.0
    while world.truth().base_position[2] < height + 0.1:
        assert time.monotonic() < give_up, "it stays on the floor"
        time.sleep(0.05)


def test_virtual_time_keeps_up_with_real_time(world):
    first, start = world.truth().time_ns, time.monotonic_ns()
    time.sleep(0.5)
    elapsed = time.monotonic_ns() - start
    assert world.truth().time_ns - first == pytest.approx(elapsed, rel=0.2)


@pytest.mark.parametrize(
    ("request_line", "message"),
    [
        (b"nonsense", "JSON"),
        (b'{"do": "fly"}', "fly"),
        (b'{"do": "push", "force": [1, NaN, 0]}', "finite"),
        (b'{"do": "push"}', "force"),
    ],
)
def test_bad_requests_are_answered_not_obeyed(server, request_line, message):
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(str(server.control))
        client.sendall(request_line + b"\n")
        answer = json.loads(client.makefile().readline())
    assert not answer["ok"]
    assert message in answer["error"]


def ask(control, **request):
    """Answer of a control socket."""
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(str(control))
        client.sendall(json.dumps(request).encode() + b"\n")
        return json.loads(client.makefile().readline())


def test_faults_are_injected_live_and_bad_ones_are_told(server):
    port = PortHandler(server.port_urls["left_leg"])
    port.setBaudRate(4_000_000)
    sdk = Protocol2PacketHandler()
    assert answered(lambda: sdk.ping(port, 4))[1] == COMM_SUCCESS
    assert ask(server.control, do="inject", fault="servo:left_knee:silent@0+0.5")["ok"]
    assert sdk.ping(port, 4)[1] != COMM_SUCCESS
    time.sleep(0.6)
    assert answered(lambda: sdk.ping(port, 4))[1] == COMM_SUCCESS
    refused = ask(server.control, do="inject", fault="servo:left_toe:silent")
    assert "unknown joint" in refused["error"]
    assert "left_knee" in refused["error"]
    port.closePort()


def test_a_plan_begins_when_the_run_says_that_it_walks(server, world):
    port = PortHandler(server.port_urls["left_leg"])
    port.setBaudRate(4_000_000)
    sdk = Protocol2PacketHandler()
    world.plan_faults([parse_fault("servo:left_knee:silent@0.2")])
    time.sleep(0.3)
    assert answered(lambda: sdk.ping(port, 4))[1] == COMM_SUCCESS
    world.begin_faults(time.monotonic_ns())
    time.sleep(0.4)
    assert sdk.ping(port, 4)[1] != COMM_SUCCESS
    with pytest.raises(BackendError, match="unknown joint"):
        world.plan_faults([parse_fault("servo:left_toe:silent")])
    port.closePort()


def test_a_pulled_adapter_ends_in_an_error_of_the_port(server):
    with serial.Serial(server.port_urls["imu"], 921600, timeout=0.5) as port:
        assert port.read(100)
        assert ask(server.control, do="inject", fault="board:imu:disconnect")["ok"]
        with pytest.raises((serial.SerialException, OSError)):
            for _ in range(100):
                port.read(1000)
                port.write(b"x")
    assert ask(server.control, do="figures")["ok"]


def wait_for_end(process, folder):
    assert process.wait(10) == 0
    assert not folder.exists()


def start(stdin):
    process = subprocess.Popen(COMMAND, stdin=stdin, stdout=subprocess.PIPE)
    ready = json.loads(process.stdout.readline())
    assert set(ready) == {"buses", "boards", "control"}
    assert all(Path(port).exists() for port in ready["buses"].values())
    return process, Path(ready["control"]).parent


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_end_it_cleanly(number):
    process, folder = start(subprocess.DEVNULL)
    process.send_signal(number)
    wait_for_end(process, folder)


def test_a_closed_pipe_ends_it_so_it_dies_with_its_parent():
    process, folder = start(subprocess.PIPE)
    process.stdin.close()
    wait_for_end(process, folder)


def test_a_quit_request_ends_it():
    process, folder = start(subprocess.DEVNULL)
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(str(folder / "control"))
        client.sendall(b'{"do": "quit"}\n')
        assert json.loads(client.makefile().readline())["ok"]
    wait_for_end(process, folder)


def test_figures_of_the_servos_come_over_the_control_socket(world):
    figures = world.figures()
    assert figures["voltage_min_v"] == pytest.approx(12.0, abs=0.1)
    assert figures["energy_wh"] >= 0.0
    assert set(figures) == {*Plant(load_robot("human"), 300).figures()}


def test_a_closed_client_leaves_nothing_behind(server):
    server.close()
    server.close()
    assert not server.control.exists()
    assert not any(Path(port).exists() for port in server.port_urls.values())
    with pytest.raises(BackendError, match="control socket"):
        RemoteWorld(server.control)


@pytest.mark.parametrize(
    ("robot", "overrides", "message"),
    [
        ("nobody", (), "unknown robot 'nobody'; valid:"),
        ("human", (), "human has no servos to emulate"),
        ("minibiped", ("supply.volts=12",), "unknown --set key"),
    ],
)
def test_bad_input_is_told_by_whoever_starts_it(robot, overrides, message):
    with pytest.raises(InputError, match=message):
        ServerProcess(robot, 300, 0, overrides)
