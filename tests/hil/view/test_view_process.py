"""The view of a real run, looked at by a client of its stream; and a view that is killed."""

import json
import os
import re
import signal
import time
from pathlib import Path

import pytest
from view_runs import WAIT_S, Run
from websockets.sync.client import connect

from hil.recording import read_recording


@pytest.fixture
def run(tmp_path):
    runs = []

    def begin(*options):
        runs.append(Run(tmp_path / "run", *options))
        runs[-1].address = runs[-1].said(r"watch: http://(\S*?)/\s")
        runs[-1].await_socket()
        return runs[-1]

    yield begin
    for one in runs:
        one.kill()


def listening_addresses(pid):
    """Local addresses of the TCP sockets on which a process listens (proc(5), net/tcp)."""
    inodes = set()
    for entry in Path(f"/proc/{pid}/fd").iterdir():
        target = str(entry.readlink())
        inodes.update(re.findall(r"socket:\[(\d+)\]", target))
    found = []
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/{pid}/net/{table}").read_text().splitlines()[1:]:
            parts = line.split()
            if parts[3] == "0A" and parts[9] in inodes:
                found.append(parts[1].split(":")[0])
    return found


def test_a_spectator_sees_the_run_and_the_run_ends_the_view(run):
    walk = run("--backend", "mujoco", "--duration", "1.5")
    pid = walk.view_pid()
    assert set(listening_addresses(pid)) == {"0100007F"}
    scenes = []
    with connect(f"ws://{walk.address}/state?sid=spectator", open_timeout=20) as scene:
        assert walk.tell(b"start\n") == b"ok\n"
        assert walk.tell(b"speed 0.22\n") == b"ok\n"
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            message = scene.recv(timeout=10)
            if isinstance(message, bytes):
                scenes.append(message)
                scene.send("state_ack")
        with pytest.raises(Exception, match="the run is over"):
            while True:
                scene.recv(timeout=WAIT_S)
    assert len(set(scenes)) > 5  # it moves
    assert walk.end() == 0
    assert not Path(f"/proc/{pid}").exists()
    report = json.loads((walk.folder / "report.json").read_text())
    assert report["real_time_factor"] < 1.1  # held back to the wall's time
    ticks = read_recording(walk.folder).rows
    assert ticks["reference"]["speed"][-1] == pytest.approx(0.22)
    assert (ticks["timing"]["tick"] == 0).sum() == 1


def test_a_view_that_is_killed_harms_nobody(run):
    walk = run("--backend", "mujoco", "--duration", "1")
    pid = walk.view_pid()
    os.kill(pid, signal.SIGKILL)
    walk.tell(b"start\n")
    assert walk.end() == 0
    assert json.loads((walk.folder / "report.json").read_text())["faults"] == []


def test_a_view_that_stands_still_holds_up_nobody(run):
    walk = run("--backend", "mujoco", "--duration", "1")
    os.kill(walk.view_pid(), signal.SIGSTOP)
    walk.tell(b"start\n")
    assert walk.end() == 0


def test_when_the_run_is_killed_the_view_ends_by_itself(run):
    walk = run("--backend", "mujoco")
    pid = walk.view_pid()
    walk.kill()
    end = time.monotonic() + 20
    while Path(f"/proc/{pid}").exists() and time.monotonic() < end:
        time.sleep(0.1)
    assert not Path(f"/proc/{pid}").exists()
