"""The board itself: its supply and heat (Raspberry Pi), and room for recordings."""

from hil.doctor.machine import Finding, Machine

THROTTLED = {
    0: "under-voltage now",
    1: "speed capped now",
    2: "throttled now",
    3: "at its soft temperature limit now",
    16: "under-voltage since boot",
    17: "speed capped since boot",
    18: "throttled since boot",
    19: "at its soft temperature limit since boot",
}
"""Bits of `vcgencmd get_throttled` (Raspberry Pi documentation, vcgencmd)."""
NOW = 0xF
LEAST_FREE, GOOD_FREE = 100 * 2**20, 2 * 2**30
"""A run of a minute writes some 30 MB [bytes]."""


def throttling(machine: Machine) -> Finding:
    """Whether the board runs slower than it could."""
    said = machine.run(["vcgencmd", "get_throttled"])
    if said is None:
        return Finding("OK", "throttling", "not known: no vcgencmd, so no Raspberry Pi")
    try:
        bits = int(said.partition("=")[2], 0)
    except ValueError:
        return Finding("WARN", "throttling", f"vcgencmd says {said.strip()!r}", "update firmware")
    words = [text for bit, text in THROTTLED.items() if bits >> bit & 1]
    if not words:
        return Finding("OK", "throttling", "none since boot")
    fix = "a supply of 5.1 V and 5 A with a short cable; a heat sink with a fan"
    return Finding("FAIL" if bits & NOW else "WARN", "throttling", ", ".join(words), fix)


def disk(machine: Machine) -> Finding:
    """Whether recordings have room."""
    free = machine.free_bytes(machine.folder)
    text = f"{free / 2**30:.1f} GiB free in {machine.folder}"
    if free >= GOOD_FREE:
        return Finding("OK", "disk", text)
    fix = "delete old runs/, or give --out on another disk"
    return Finding("FAIL" if free < LEAST_FREE else "WARN", "disk", text, fix)
