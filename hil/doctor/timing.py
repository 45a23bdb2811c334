"""What makes ticks late: frequency governors, clocks, priorities, memory that is paged out."""

import resource

from hil.doctor.machine import Finding, Machine

GOOD_CLOCKS = ("tsc", "arch_sys_counter", "kvm-clock", "arch_timer")
"""Clock sources that are read in nanoseconds, without leaving user space."""
PRIORITY = 50
"""What `--priority` is usually given (1 to 98)."""
LEAST_LOCKED = 64 * 2**20
"""Memory that a process of a run may lock at least [bytes]."""
LIMITS = "/etc/security/limits.d/stride.conf"


def governor(machine: Machine) -> Finding:
    """Whether cores run at full speed when a tick begins."""
    found = {
        machine.read(str(path.relative_to(machine.root)))
        for path in machine.find("sys/devices/system/cpu/cpu[0-9]*/cpufreq/scaling_governor")
    }
    names = sorted(name for name in found if name)
    if not names:
        return Finding("OK", "cpu governor", "none (fixed speed, or a virtual machine)")
    if names == ["performance"]:
        return Finding("OK", "cpu governor", "performance")
    return Finding(
        "WARN", "cpu governor", f"{', '.join(names)}: a core that sleeps wakes up slowly",
        "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor",
    )  # fmt: skip


def clock_source(machine: Machine) -> Finding:
    """Whether time is read quickly."""
    name = machine.read("sys/devices/system/clocksource/clocksource0/current_clocksource")
    if name is None:
        return Finding("WARN", "clock source", "not known", "is /sys mounted?")
    if name in GOOD_CLOCKS:
        return Finding("OK", "clock source", name)
    return Finding(
        "WARN", "clock source", f"{name} is slow to read",
        "boot with clocksource=tsc, if the kernel's log does not call tsc unstable",
    )  # fmt: skip


def priority(machine: Machine) -> Finding:
    """Whether a run may ask for a real-time priority (`--priority`)."""
    most = machine.limit(resource.RLIMIT_RTPRIO)
    if most < 0 or most >= PRIORITY:
        return Finding("OK", "real-time priority", "unlimited" if most < 0 else f"up to {most}")
    return Finding(
        "WARN", "real-time priority", f"up to {most}: --priority {PRIORITY} is refused",
        f"echo '@dialout - rtprio 98' | sudo tee -a {LIMITS}, then log in again",
    )  # fmt: skip


def locked_memory(machine: Machine) -> Finding:
    """Whether a run may keep its memory from being paged out."""
    most = machine.limit(resource.RLIMIT_MEMLOCK)
    if most < 0 or most >= LEAST_LOCKED:
        text = "unlimited" if most < 0 else f"{most // 2**20} MiB"
        return Finding("OK", "locked memory", text)
    return Finding(
        "WARN", "locked memory", f"{most // 2**10} KiB may be locked",
        f"echo '@dialout - memlock unlimited' | sudo tee -a {LIMITS}, then log in again",
    )  # fmt: skip


def kernel(machine: Machine) -> Finding:
    """Whether the kernel is made for short latencies."""
    if machine.read("sys/kernel/realtime") == "1":
        return Finding("OK", "kernel", "PREEMPT_RT")
    return Finding("OK", "kernel", "no PREEMPT_RT: soft real time, late ticks are counted")
