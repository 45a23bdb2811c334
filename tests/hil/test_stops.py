"""The operator's ways to stop a run: signals, keys, the socket of the run folder, `stride stop`."""

import os
import pty
import signal
import socket
import stat
import subprocess
import sys
import termios
import threading
import time

import pytest
from hil_fakes import Collector, make_session
from typer.testing import CliRunner

from hil.cli.main import app
from hil.loop import Loop
from hil.signals import OperatorStop, StopSignals
from hil.stop_listener import SOCKET, StopListener, ask_to_stop

STOP_AT = 50


def run(session, folder=None, during=lambda: None):
    """A run in whose controller something happens in tick STOP_AT."""
    step = session.controller.step

    def stepped(estimate, reference):
        if session.controller.ticks == STOP_AT:
            during()
        return step(estimate, reference)

    session.controller.step = stepped
    loop = Loop(session, (Collector(),), listener=None if folder is None else StopListener(folder))
    session.backend.open()
    return loop


def faults(loop):
    return [(fault.source, fault.name, fault.reaction) for fault in loop.outcome.faults]


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTSTP])
def test_a_closed_terminal_and_ctrl_z_sit_down_too(number):
    session = make_session()
    loop = run(session, during=lambda: os.kill(os.getpid(), number))
    with pytest.raises(SystemExit) as caught:
        loop.run()
    assert caught.value.code == 128 + number
    assert faults(loop) == [("operator", signal.Signals(number).name, "soft_stop")]
    sitting = session.description.sit.joints["left_knee"]
    assert session.backend.written[-1][3] == pytest.approx(sitting)


def test_sigquit_does_not_wait_for_a_controller_that_hangs_and_catches_everything():
    session = make_session()

    def hang():
        os.kill(os.getpid(), signal.SIGQUIT)
        while True:
            pass

    def careless():
        try:
            hang()
        except Exception:
            pytest.fail("a software stop is no Exception")

    loop = run(session, during=careless)
    with pytest.raises(OperatorStop, match="SIGQUIT") as caught:
        loop.run()
    assert caught.value.exit_code == 128 + signal.SIGQUIT
    assert faults(loop) == [("operator", "SIGQUIT", "torque_off")]
    assert len(session.backend.written) == 450 + STOP_AT
    assert session.backend.journal[-2:] == ["torque_off", "close"]


def test_a_software_stop_that_a_controller_swallows_counts_at_the_end_of_the_tick():
    session = make_session()

    def swallow():
        try:
            os.kill(os.getpid(), signal.SIGQUIT)
            time.sleep(1)
        except BaseException:
            return

    loop = run(session, during=swallow)
    with pytest.raises(OperatorStop):
        loop.run()
    assert faults(loop) == [("operator", "SIGQUIT", "torque_off")]
    assert len(session.backend.written) == 450 + STOP_AT + 1


def test_hammering_on_ctrl_c_does_not_keep_torque_from_going_off():
    session = make_session()
    stop = session.backend.stop

    def hammered(mode):
        for _ in range(5):
            os.kill(os.getpid(), signal.SIGINT)
        return stop(mode)

    session.backend.stop = hammered
    loop = run(session, during=lambda: [os.kill(os.getpid(), signal.SIGINT) for _ in range(3)])
    with pytest.raises(KeyboardInterrupt):
        loop.run()
    assert session.backend.journal[-2:] == ["torque_off", "close"]


@pytest.mark.parametrize(
    ("word", "reaction", "extra"), [("off", "torque_off", 0), ("sit", "soft_stop", 1)]
)
def test_a_word_on_the_socket_stops_the_run(tmp_path, word, reaction, extra):
    session = make_session()
    loop = run(session, tmp_path, during=lambda: ask_to_stop(tmp_path, word))
    with pytest.raises(OperatorStop, match="socket") as caught:
        loop.run()
    assert caught.value.exit_code == 1
    assert faults(loop) == [("operator", "socket", reaction)]
    sat = round(1.1 * 300) * extra
    assert len(session.backend.written) == pytest.approx(450 + STOP_AT + extra + sat, abs=1)
    assert not (tmp_path / SOCKET).exists()


def test_the_socket_is_its_users_alone_and_knows_no_other_word(tmp_path):
    deep = tmp_path / ("x" * 100) / ("y" * 100)  # longer than a socket's address may be
    deep.mkdir(parents=True)
    found = []

    def look():
        mode = (deep / SOCKET).stat().st_mode
        found.append((stat.S_ISSOCK(mode), stat.S_IMODE(mode)))
        ask_to_stop(deep, "please")

    before = threading.active_count()
    loop = run(make_session(), deep, during=look)
    assert loop.run().faults == []
    assert found == [(True, 0o600)]
    assert threading.active_count() == before


def test_a_client_that_says_nothing_stops_nobody_and_keeps_nobody_waiting(tmp_path):
    clients = []

    def connect():
        for _ in range(3):
            client = socket.socket(socket.AF_UNIX)
            client.connect(str(tmp_path / SOCKET))
            clients.append(client)
        ask_to_stop(tmp_path, "sit")

    loop = run(make_session(), tmp_path, during=connect)
    with pytest.raises(OperatorStop):
        loop.run()
    assert faults(loop) == [("operator", "socket", "soft_stop")]
    for client in clients:
        client.close()


def test_a_request_from_a_thread_finds_a_run_that_is_over_or_not_in_the_main_thread():
    signals = StopSignals()
    signals.post("socket", now=True)  # nobody to interrupt: noted
    assert signals.first() == "socket"
    with pytest.raises(OperatorStop):
        signals.check()


LISTENING = """
import sys, time
from pathlib import Path
from hil.stop_listener import StopListener

def post(name, *, now):
    print(name, now, flush=True)

with StopListener(Path(sys.argv[1])).listening(post):
    print("ready", flush=True)
    used = time.process_time()
    time.sleep(float(sys.argv[2]))
print("used", time.process_time() - used, flush=True)
"""


@pytest.fixture
def terminal():
    master, slave = pty.openpty()
    yield master, slave
    os.close(master)
    os.close(slave)


def listening(terminal, tmp_path, before="", seconds="60"):
    code = f"import fcntl, os, termios\nfcntl.ioctl(0, termios.TIOCSCTTY, 0)\n{before}\n{LISTENING}"
    return subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path), seconds],
        stdin=terminal[1], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        start_new_session=True, text=True,
    )  # fmt: skip


def test_keys_of_the_terminal_are_heard_one_by_one(terminal, tmp_path):
    with listening(terminal, tmp_path) as process:
        assert process.stdout.readline() == "ready\n"
        os.write(terminal[0], b"xq")
        assert process.stdout.readline() == "key q False\n"
        os.write(terminal[0], b" ")
        assert process.stdout.readline() == "key space True\n"
        process.kill()
        assert "space: torque off now" in process.communicate()[1]


def test_the_terminal_is_as_it_was_afterwards(terminal, tmp_path):
    before = termios.tcgetattr(terminal[0])
    with listening(terminal, tmp_path, seconds="0.2") as process:
        assert process.stdout.readline() == "ready\n"
        assert termios.tcgetattr(terminal[0])[3] & termios.ICANON == 0
        assert process.wait(30) == 0
    assert termios.tcgetattr(terminal[0]) == before


def test_a_run_in_the_background_leaves_the_terminals_keys_to_others(terminal, tmp_path):
    background = "if os.fork() == 0:\n    os.setpgid(0, 0)\nelse:\n    os.wait(); os._exit(0)"
    with listening(terminal, tmp_path, background, "0.5") as process:
        assert process.stdout.readline() == "ready\n"
        os.write(terminal[0], b" ")
        assert process.wait(30) == 0
        assert process.stdout.readline().startswith("used")


def test_a_terminal_that_is_gone_does_not_keep_the_thread_busy(tmp_path):
    master, slave = pty.openpty()
    deaf = "import signal\nsignal.signal(signal.SIGHUP, signal.SIG_IGN)"
    with listening((master, slave), tmp_path, deaf, "1.0") as process:
        os.close(slave)
        assert process.stdout.readline() == "ready\n"
        os.close(master)
        assert process.wait(30) == 0
        assert float(process.stdout.readline().split()[1]) < 0.1  # of a second of a busy thread


def test_stride_stop_finds_the_newest_run_that_listens(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    older, newer, dead = (tmp_path / "runs" / name for name in ("1-a", "2-b", "3-c"))
    for folder in (older, newer, dead):
        folder.mkdir(parents=True)
    with socket.socket(socket.AF_UNIX) as left_over:
        left_over.bind(str(dead / SOCKET))
    heard = []

    def hearing(who):
        return lambda name, *, now: heard.append((who, name, now))

    with (
        StopListener(older).listening(hearing("older")),
        StopListener(newer).listening(hearing("newer")),
    ):
        assert CliRunner().invoke(app, ["stop"]).exit_code == 0
        assert CliRunner().invoke(app, ["stop", "runs/1-a", "--sit"]).exit_code == 0
    assert heard == [("newer", "socket", True), ("older", "socket", False)]
    result = CliRunner().invoke(app, ["stop"])
    assert result.exit_code == 2
    assert "no run listens in runs/: cut the servo power if the robot moves" in result.output
