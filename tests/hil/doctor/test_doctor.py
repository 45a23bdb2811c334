"""`stride doctor` on computers that are made of files: what each lacks, and the remedy."""

import json
import resource
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hil.cli.main import app
from hil.doctor.examine import examine
from hil.doctor.machine import Machine

GIB = 2**30


def put(root, path, text=""):
    file = root / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


@pytest.fixture
def good(tmp_path):
    """A computer with nothing wrong."""
    root = tmp_path / "root"
    for core in range(4):
        put(root, f"sys/devices/system/cpu/cpu{core}/cpufreq/scaling_governor", "performance\n")
    put(root, "sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n")
    put(root, "sys/kernel/realtime", "1\n")
    put(root, "usr/lib/x86_64-linux-gnu/libEGL.so.1")
    put(root, "dev/ttyUSB0")
    put(root, "sys/class/tty/ttyUSB0/device/latency_timer", "1\n")
    said = {
        "id -nG": "robo dialout\n",
        "id -un": "robo\n",
        "vcgencmd get_throttled": "throttled=0x0\n",
    }

    def machine(**changes):
        parts = {
            "root": root,
            "run": lambda command: said.get(" ".join(command)),
            "package": {"mujoco": "4.0.0"}.get,
            "limit": lambda _: -1,
            "accessible": lambda _: True,
            "free_bytes": lambda _: 50 * GIB,
            "python": "3.12.1",
            "environment": {},
            "folder": Path("/home/robo"),
        }
        return Machine(**{**parts, **changes})

    machine.root, machine.said = root, said
    return machine


def line(machine, what):
    (found,) = [finding for finding in examine(machine) if finding.what == what]
    return found


def test_a_good_computer_is_all_ok_and_needs_nothing(good):
    findings = examine(good())
    assert {finding.status for finding in findings} == {"OK"}
    assert not any(finding.fix for finding in findings)
    assert line(good(), "kernel").found == "PREEMPT_RT"


@pytest.mark.parametrize(
    ("changes", "what", "status", "fix"),
    [
        ({"python": "3.10.9"}, "python", "FAIL", "3.11"),
        ({"package": lambda _: None}, "mujoco", "FAIL", "pip install"),
        ({"package": lambda _: "3.9.1"}, "mujoco", "FAIL", "4.0.0"),
        ({"accessible": lambda _: False}, "serial ports", "FAIL", "usermod"),
        ({"free_bytes": lambda _: GIB}, "disk", "WARN", "--out"),
        ({"free_bytes": lambda _: GIB // 100}, "disk", "FAIL", "--out"),
        ({"environment": {"MUJOCO_GL": "glfw"}}, "drawing", "WARN", "unset"),
        ({"environment": {"MUJOCO_GL": "osmesa"}}, "drawing", "WARN", "libosmesa6"),
    ],
)  # fmt: skip
def test_what_is_wrong_names_its_remedy(good, changes, what, status, fix):
    found = line(good(**changes), what)
    assert found.status == status
    assert fix in found.fix


@pytest.mark.parametrize(
    ("path", "text", "what", "fix"),
    [
        ("sys/devices/system/cpu/cpu2/cpufreq/scaling_governor", "powersave", "cpu governor",
         "tee /sys/devices"),
        ("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet", "clock source",
         "clocksource=tsc"),
        ("sys/class/tty/ttyUSB0/device/latency_timer", "16", "latency timer ttyUSB0",
         "echo 1 | sudo tee /sys/class/tty/ttyUSB0/device/latency_timer"),
    ],
)  # fmt: skip
def test_what_the_kernel_shows_is_judged(good, path, text, what, fix):
    put(good.root, path, text)
    found = line(good(), what)
    assert found.status == "WARN" and text in found.found and fix in found.fix


@pytest.mark.parametrize(
    ("which", "amount", "what", "fix"),
    [
        (resource.RLIMIT_RTPRIO, 0, "real-time priority", "rtprio 98"),
        (resource.RLIMIT_MEMLOCK, 65536, "locked memory", "memlock unlimited"),
    ],
)
def test_limits_of_the_process_are_judged(good, which, amount, what, fix):
    found = line(good(limit=lambda asked: amount if asked == which else -1), what)
    assert found.status == "WARN" and fix in found.fix


@pytest.mark.parametrize(
    ("said", "status", "says"),
    [
        ("throttled=0x50000", "WARN", "under-voltage since boot, throttled since boot"),
        ("throttled=0x4", "FAIL", "throttled now"),
        ("error", "WARN", "error"),
    ],
)
def test_a_raspberry_pi_tells_of_its_supply(good, said, status, says):
    good.said["vcgencmd get_throttled"] = said
    found = line(good(), "throttling")
    assert found.status == status and says in found.found


def test_a_user_outside_the_group_is_told_before_a_port_is_there(good):
    good.said["id -nG"] = "robo video\n"
    assert "usermod -aG dialout" in line(good(), "serial permission").fix
    good.said["id -un"] = "root\n"
    assert line(good(), "serial permission").status == "OK"


def test_a_bare_computer_has_no_ports_and_no_governor(tmp_path, good):
    machine = good(root=tmp_path / "nothing", run=lambda _: None)
    statuses = {finding.what: finding.status for finding in examine(machine)}
    assert statuses["serial ports"] == statuses["cpu governor"] == statuses["throttling"] == "OK"
    assert statuses["drawing"] == statuses["clock source"] == "WARN"


def test_the_command_reports_this_computer_and_fails_hard_only_for_a_failure(monkeypatch, good):
    result = CliRunner().invoke(app, ["doctor", "--json"])
    findings = json.loads(result.stdout)["findings"]
    assert {"python", "mujoco", "disk", "serial ports"} <= {row["what"] for row in findings}
    assert result.exit_code == int(any(row["status"] == "FAIL" for row in findings))
    monkeypatch.setattr("hil.doctor.machine.Machine", lambda: good(python="3.9.0"))
    failed = CliRunner().invoke(app, ["doctor"])
    assert failed.exit_code == 1 and "FAIL" in failed.stdout and "3.9.0" in failed.stdout
