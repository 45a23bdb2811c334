"""Serial ports: which there are, whether they open, how long their adapter waits."""

from pathlib import Path

from hil.doctor.machine import Finding, Machine

GROUP_FIX = "sudo usermod -aG dialout $USER, then log in again"
LATENCY_MS = 1
"""What a servo bus needs; FTDI's drivers begin with 16 (FTDI AN232B-04)."""


def ports(machine: Machine) -> list[Finding]:
    """One line for all ports, and one for each adapter that waits too long."""
    found = machine.find("dev/ttyUSB*", "dev/ttyACM*")
    if not found:
        return [Finding("OK", "serial ports", "none plugged in (a dry run needs none)")]
    closed = [path.name for path in found if not machine.accessible(path)]
    names = ", ".join(path.name for path in found)
    if closed:
        return [
            Finding("FAIL", "serial ports", f"no permission: {', '.join(closed)}", GROUP_FIX),
            *_latencies(machine, found),
        ]
    return [Finding("OK", "serial ports", names), *_latencies(machine, found)]


def _latencies(machine: Machine, found: list[Path]) -> list[Finding]:
    lines = []
    for path in found:
        text = machine.read(f"sys/class/tty/{path.name}/device/latency_timer")
        if text is None or not text.isdigit():
            continue
        what = f"latency timer {path.name}"
        if int(text) <= LATENCY_MS:
            lines.append(Finding("OK", what, f"{text} ms"))
            continue
        file = f"/sys/class/tty/{path.name}/device/latency_timer"
        lines.append(
            Finding(
                "WARN", what, f"{text} ms: a read of the servos waits that long",
                f"echo {LATENCY_MS} | sudo tee {file}; for good, a udev rule (docs/doctor.md)",
            )
        )  # fmt: skip
    return lines


def dialout(machine: Machine) -> Finding:
    """Whether this user may open serial ports when one is plugged in."""
    listed = machine.run(["id", "-nG"])
    if listed is None:
        return Finding("WARN", "serial permission", "groups are not known (no `id`)", GROUP_FIX)
    groups = listed.split()
    user = (machine.run(["id", "-un"]) or "").strip()
    if user == "root":
        return Finding("OK", "serial permission", "root may open every port")
    for group in ("dialout", "uucp"):
        if group in groups:
            return Finding("OK", "serial permission", f"{user} is in group {group}")
    return Finding("WARN", "serial permission", f"{user} is not in group dialout", GROUP_FIX)
