"""The CSV of `stride study gains`, read back."""

import csv
from pathlib import Path

from pydantic import PositiveInt

from hil.errors import InputError
from hil.joint_gains import GainSet
from hil.validation import Config

COLUMNS = ("rate_hz", "joint_group", "kp_min", "kp_max", "kd_min", "kd_max")


class RateGains(Config):
    """The smallest and largest acceptable gains of one rate."""

    rate_hz: PositiveInt
    smallest: GainSet
    largest: GainSet

    def middle(self, joint: str) -> tuple[float, float]:
        """Mean of both ends: stiffness and damping of a joint."""
        (kp_low, kd_low), (kp_high, kd_high) = self.smallest[joint], self.largest[joint]
        return 0.5 * (kp_low + kp_high), 0.5 * (kd_low + kd_high)


def read_ranges(path: Path) -> tuple[RateGains, ...]:
    """Ranges of all rates for which both ends were found, in the order of the file.

    Raises InputError for what is not such a file.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise InputError(f"--range {path}: cannot be read: {error.strerror}") from error
    missing = [name for name in COLUMNS if not rows or name not in rows[0]]
    if missing:
        raise InputError(f"--range {path}: is no CSV of study gains: no column {missing[0]}")
    found: dict[int, list[dict[str, str]]] = {}
    for row in rows:
        if all(row[name] for name in COLUMNS):
            found.setdefault(int(row["rate_hz"]), []).append(row)
    if not found:
        raise InputError(f"--range {path}: no rate in it has both ends of its range")
    return tuple(
        RateGains(
            rate_hz=rate,
            smallest={row["joint_group"]: (float(row["kp_min"]), float(row["kd_min"]))
                      for row in of_rate},
            largest={row["joint_group"]: (float(row["kp_max"]), float(row["kd_max"]))
                     for row in of_rate},
        )
        for rate, of_rate in found.items()
    )  # fmt: skip
