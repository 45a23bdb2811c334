"""The guardian, with real processes and real signals."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from drivers.guardian import Guardian

MAKER = """
import os, signal, sys, threading, time
from drivers.guardian import Guardian

def off():
    with open(sys.argv[1], "w") as stream:
        stream.write("off")

signal.signal(signal.SIGINT, signal.default_int_handler)
guardian = Guardian(off, 0.4)
guardian.start()
if sys.argv[2] == "beats":
    threading.Thread(target=lambda: [guardian.beat() or time.sleep(0.01) for _ in range(6000)],
                     daemon=True).start()
print("ready", guardian._child, flush=True)
end = sys.stdin.readline().strip()
if end == "close":
    guardian.close()
elif end == "take over":
    guardian.take_over()
    guardian.close()
    time.sleep(60)
elif end == "die":
    os.kill(guardian._child, signal.SIGKILL)
    while guardian.alive():
        time.sleep(0.001)
    print("noticed", flush=True)
elif end == "crash":
    os.abort()
else:
    time.sleep(60)
"""


@pytest.fixture
def maker(tmp_path, request):
    mark = tmp_path / "mark"
    command = [sys.executable, "-c", MAKER, str(mark), getattr(request, "param", "beats")]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True
    )
    process.mark = mark
    process.guardian = int(process.stdout.readline().split()[1])
    yield process
    process.kill()
    process.wait()
    process.stdin.close()
    process.stdout.close()


def end(process, word):
    process.stdin.write(word + "\n")
    process.stdin.flush()


def gone(process_id):
    """Whether a process has ended; an orphan is reaped by somebody else, a moment later."""
    for _ in range(2000):
        try:
            with Path(f"/proc/{process_id}/stat").open() as stream:
                if stream.read().rpartition(")")[2].split()[0] == "Z":
                    return True
        except FileNotFoundError:
            return True
        time.sleep(0.01)
    return False


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, "crash"])
def test_whatever_ends_the_maker_torque_goes_off(maker, how):
    if how == "crash":
        end(maker, how)
    else:
        maker.send_signal(how)
    assert gone(maker.guardian)
    assert maker.mark.read_text() == "off"


def test_a_signal_to_the_whole_group_leaves_the_guardian_to_act(maker):
    os.killpg(maker.pid, signal.SIGINT)
    assert gone(maker.guardian)
    assert maker.mark.read_text() == "off"


@pytest.mark.parametrize("maker", ["hangs"], indirect=True)
def test_a_maker_that_hangs_is_killed_before_torque_goes_off(maker):
    assert maker.wait(30) == -signal.SIGKILL
    assert gone(maker.guardian)
    assert maker.mark.read_text() == "off"


def test_a_maker_that_was_suspended_is_killed_too(maker):
    maker.send_signal(signal.SIGSTOP)
    assert maker.wait(30) == -signal.SIGKILL
    assert gone(maker.guardian)
    assert maker.mark.read_text() == "off"


def test_a_guardian_whose_maker_gives_up_acts_at_once_and_lets_it_live(maker):
    end(maker, "take over")
    assert gone(maker.guardian)
    assert maker.mark.read_text() == "off"
    assert maker.poll() is None


def test_a_guardian_sent_home_does_nothing(maker):
    end(maker, "close")
    assert maker.wait(10) == 0
    assert gone(maker.guardian)
    assert not maker.mark.exists()


def test_the_maker_notices_that_its_guardian_died(maker):
    end(maker, "die")
    assert maker.stdout.readline() == "noticed\n"
    assert maker.wait(10) == 0
    assert not maker.mark.exists()


def test_it_can_start_again_after_it_was_closed(tmp_path):
    guardian = Guardian(lambda: None)
    assert not guardian.alive()
    for _ in range(2):
        guardian.start()
        guardian.start()
        assert guardian.alive()
        guardian.close()
        guardian.close()
        assert not guardian.alive()
