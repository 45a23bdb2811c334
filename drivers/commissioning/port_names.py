"""The serial ports of this computer, by names that last, and their latency timers."""

from pathlib import Path

from serial.tools import list_ports

from hil.bringup.facts import FoundPort

BY_ID = Path("/dev/serial/by-id")
SYSFS = Path("/sys")


def found_ports(by_id: Path = BY_ID) -> list[FoundPort]:
    """All serial ports, with the path under `by_id` that leads to each."""
    links = sorted(by_id.iterdir()) if by_id.is_dir() else []
    names = {link.resolve(): str(link) for link in links}
    return [
        FoundPort(port.device, names.get(Path(port.device).resolve()), port.description)
        for port in sorted(list_ports.comports(), key=lambda port: str(port.device))
    ]


def latency_timer_ms(url: str, sysfs: Path = SYSFS) -> int | None:
    """Latency timer of a USB adapter; None for a port without one, as far as can be told."""
    name = Path(url).resolve().name
    path = sysfs / "class" / "tty" / name / "device" / "latency_timer"
    try:
        return int(path.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None
