"""Steering through a run's own doors: its terminal, its socket, the view's pair, a gamepad."""

import os
import pty
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager

import pytest
from hil_fakes import Collector, make_session
from typer.testing import CliRunner

from hil.cli.main import app
from hil.clock import ManualClock
from hil.errors import InputError
from hil.loop import Loop
from hil.pacer import Pacer
from hil.request import RunRequest
from hil.signals import OperatorStop
from hil.steering.helm import Helm
from hil.steering.limits import steer_limits
from hil.steering.steering import Steering
from hil.steering.words import Word
from hil.stop_listener import SOCKET, StopListener
from hil.timing import stopwatch_ns
from hil.view.attendance import attend


def steered(tmp_path, view=None, **request):
    session = make_session(world=True, steer="keys", **request)
    helm = Helm(steer_limits(session.description), 300, dead_man=False, pushes=True)
    sink = Collector()
    listener = StopListener(tmp_path, Steering(helm, None, view))
    loop = Loop(session, (sink,), listener=listener, helm=helm)
    session.backend.open()
    return session, helm, loop, sink


def tell(folder, line):
    with socket.socket(socket.AF_UNIX) as client:
        client.settimeout(5)
        client.connect(str(folder / SOCKET))
        client.sendall(line)
        return client.recv(256)


def at_tick(session, tick, deed):
    """Do something once, in the controller's step of a tick."""
    step = session.controller.step

    def stepped(estimate, reference):
        if session.controller.ticks == tick:
            deed()
        return step(estimate, reference)

    session.controller.step = stepped


def test_a_steered_walk_stands_until_it_is_told_to_begin(tmp_path):
    session, helm, loop, sink = steered(tmp_path)
    read = session.backend.read
    before = []

    def reading():
        if session.backend.reads == 3000:
            before.append(session.controller.ticks)
            helm.post(Word("start"))
        return read()

    session.backend.read = reading
    loop.run()
    assert before == [0] and session.controller.ticks == 300
    assert sink.ticks[-330 - 300 :].count(0) == 1  # T = 0 is still the first walking tick


def test_a_walk_that_nobody_begins_sits_down(tmp_path, monkeypatch):
    monkeypatch.setattr("hil.startup.LONGEST_STAND_S", 2.0)
    session, _, loop, _ = steered(tmp_path)
    loop.run()
    assert [(f.source, f.name, f.reaction) for f in loop.outcome.faults] == [
        ("operator", "never began", "soft_stop")
    ]
    assert session.controller.ticks == 0
    assert len(session.backend.written) > 600


def test_words_on_the_socket_steer_and_are_answered(tmp_path):
    session, helm, loop, _ = steered(tmp_path)
    helm.post(Word("start"))
    answers = []
    at_tick(session, 100, lambda: answers.append(tell(tmp_path, b"speed 0.3\n")))
    at_tick(session, 150, lambda: answers.append(tell(tmp_path, b"speed up\n")))
    loop.run()
    assert answers[0] == b"ok\n"
    assert answers[1].startswith(b"steering: 'speed up' is not of the form 'speed M/S'")
    assert session.controller.references[100][0] == 0.15
    assert session.controller.references[-1][0] == 0.3


def test_a_run_that_is_not_steered_still_knows_two_words_only(tmp_path):
    session = make_session()
    answers = []
    at_tick(session, 50, lambda: answers.append(tell(tmp_path, b"speed 0.3\n")))
    loop = Loop(session, (), listener=StopListener(tmp_path))
    session.backend.open()
    loop.run()
    assert answers == [b"say off or sit\n"]


def test_the_views_messages_steer_push_and_stop_and_its_death_does_nothing(tmp_path):
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    session, helm, loop, _ = steered(tmp_path, view=ours)
    helm.post(Word("start"))
    seen = []

    def send(*lines):
        for line in lines:
            theirs.send(line)
        time.sleep(0.2)  # the listener's thread reads them, not the tick

    at_tick(session, 30, lambda: send(b"speed 0.25", b"torn \xff", b"push 0 3 0 0.1"))
    at_tick(session, 90, theirs.close)
    at_tick(session, 200, lambda: seen.append(session.controller.references[-1][0]))
    loop.run()
    assert seen == [0.25] and (0.0, 3.0, 0.0) in session.world.pushes
    assert loop.outcome.faults == []
    ours.close()


def test_the_views_stop_is_a_software_stop(tmp_path):
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    session, helm, loop, _ = steered(tmp_path, view=ours)
    helm.post(Word("start"))

    def stop():
        theirs.send(b"off")
        time.sleep(5)

    at_tick(session, 60, stop)
    with pytest.raises(OperatorStop, match="view"):
        loop.run()
    assert session.backend.journal[-2:] == ["torque_off", "close"]
    ours.close()
    theirs.close()


LISTENING = """
import fcntl, os, sys, termios, time
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
from pathlib import Path
from hil.stop_listener import StopListener
from hil.steering.steering import Steering

def tell(line):
    os.write(1, line.encode() + b"\\n")  # whole, from whichever thread

class Helm:
    def post(self, word):
        tell(word.line())

def post(name, *, now):
    tell(f"{name} {now}")

with StopListener(Path(sys.argv[1]), Steering(Helm())).listening(post):
    tell("ready")
    time.sleep(60)
"""


@contextmanager
def listening(tmp_path, typed_before=b""):
    """A terminal's master end, the process that listens to it, and the lines that it says."""
    master, slave = pty.openpty()
    os.write(master, typed_before)
    with subprocess.Popen(
        [sys.executable, "-c", LISTENING, str(tmp_path)],
        stdin=slave, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        start_new_session=True, text=True,
    ) as process:  # fmt: skip
        yield master, process, iter(process.stdout.readline, "")
    os.close(master)
    os.close(slave)


def test_arrows_of_the_terminal_steer_and_q_and_space_keep_their_meaning(tmp_path):
    with listening(tmp_path) as (master, process, lines):
        assert next(lines) == "ready\n"
        os.write(master, b"\x1b[A\x1b[D,0\rq\x1b[ ")
        heard = [next(lines).strip() for _ in range(7)]
        process.kill()
        hint = process.communicate()[1]
    assert heard == [
        "faster 0.02", "turn 0.0872665", "sideways 0.02", "halt", "start",
        "key q False", "key space True",
    ]  # fmt: skip
    assert "space: torque off now" in hint and "arrows: speed and turn" in hint


def test_what_was_typed_before_anybody_listened_stops_and_never_steers(tmp_path):
    """A second Enter after the consent must not begin a walk."""
    with listening(tmp_path, b"\n\x1b[A\nq\n") as (master, process, lines):
        heard = ""
        while "key q False" not in heard:
            heard += next(lines)
        os.write(master, b"0")
        while "halt" not in heard:
            heard += next(lines)
        process.kill()
        process.communicate()
    assert "start" not in heard and "faster" not in heard


def test_steering_by_keys_needs_a_terminal():
    with pytest.raises(InputError, match="--steer keys: standard input is no terminal"):
        attend(make_session(steer="keys"))


@pytest.mark.parametrize(
    "options, words",
    [
        (["--steer", "joystick"], "--steer: 'joystick' is neither keys nor a device"),
        (["--steer", "/dev/input/js99"], "--steer /dev/input/js99: cannot be opened"),
        (["--view", "native"], "--view: native needs a display"),
    ],
)
def test_what_cannot_be_is_one_line_and_leaves_no_folder(options, words, tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    folder = tmp_path / "run"
    result = CliRunner().invoke(app, ["walk", *options, "--out", str(folder)])
    assert result.exit_code == 2
    assert words in result.stderr and result.stderr.count("\n") == 1
    assert not folder.exists()


def test_whoever_watches_or_steers_gets_real_time_and_a_wait():
    plain = RunRequest.checked(robot="minibiped")
    watched = RunRequest.checked(robot="minibiped", view="web")
    standing = RunRequest.checked(robot="minibiped", view="web", activity="stand")
    live = RunRequest.checked(robot="minibiped", view="web", live=True)
    assert (plain.paced, plain.steered) == (False, False)
    assert (watched.paced, watched.steered) == (True, True)
    assert (standing.paced, standing.steered) == (True, False)
    assert (live.paced, live.steered) == (False, True)


def test_virtual_time_is_held_back_to_the_walls():
    session = make_session(clock=ManualClock())
    loop = Loop(session, (), pacer=Pacer())
    session.backend.open()
    began = stopwatch_ns()
    loop.run()
    # 1.5 s of start-up, 1 s of walking, 1.1 s of the way down
    assert stopwatch_ns() - began > 3.4e9


def test_a_pacer_does_not_make_up_for_a_pause():
    pacer = Pacer()
    pacer.wait(0)
    time.sleep(0.5)
    began = stopwatch_ns()
    for tick in range(1, 11):
        pacer.wait(tick * 10_000_000)
    assert stopwatch_ns() - began > 0.08e9


def test_words_from_many_threads_are_all_taken():
    session = make_session()
    helm = Helm(steer_limits(session.description), 300, dead_man=False, pushes=False)
    threads = [
        threading.Thread(target=lambda: [helm.post(Word("turn", (0.001,))) for _ in range(50)])
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    from hil.schedule import Operator, Schedules

    operator = Operator(Schedules(), 0.0)
    helm.act(operator, 0.0)
    assert operator.reference(99.0).heading == pytest.approx(0.2)
