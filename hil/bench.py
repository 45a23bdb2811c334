"""What a tick costs on this machine, beside the figures the project holds itself to.

Ratios of one run on one machine can be compared with those of another; milliseconds cannot.
"""

import tempfile
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hil.compose import build, measure_hot_path
from hil.cycle import TickRecord
from hil.interface import Floats
from hil.loop import Loop
from hil.recorder import Recorder
from hil.request import RunRequest
from hil.run_folder import make_meta

SEED_STEP_MS = 0.8
"""One controller step, stabilizer included, of seed 000_bd1305a0ae731442."""
LOOP_OVERHEAD_MS = 0.08
DRIVER_RATIO = 0.5
"""Our hot path against the classic read of dynamixel-sdk."""


@dataclass(frozen=True, slots=True)
class Case:
    """A walk to measure, and the figures it is held to."""

    name: str
    request: dict[str, Any]
    step_ms: float
    """Mean controller step."""
    real_time_factor: float


CASES = (
    Case("minibiped, MuJoCo", {"robot": "minibiped", "backend": "mujoco"}, SEED_STEP_MS, 8.0),
    Case("minibiped, dry run", {"robot": "minibiped", "backend": "bus"}, SEED_STEP_MS, 3.0),
    Case("human, explicit PD", {"robot": "human", "pd": "explicit"}, 0.30, 6.0),
    Case("human, implicit PD", {"robot": "human", "pd": "implicit"}, 0.40, 6.0),
)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table."""

    group: str
    name: str
    value: float
    unit: str
    held_to: float
    more_is_better: bool = False

    @property
    def ratio(self) -> float:
        """Measured against held to: at most 1 is good, at least 1 where more is better."""
        return self.value / self.held_to

    @property
    def good(self) -> bool:
        """Whether the figure is held."""
        return self.ratio >= 1 if self.more_is_better else self.ratio <= 1


class Stopwatch:
    """A sink that keeps the controller's and the loop's own share of every tick [ms]."""

    def __init__(self) -> None:
        self._control: list[int] = []
        self._cycle: list[int] = []
        self._overhead: list[int] = []

    def put(self, record: TickRecord) -> None:
        """Take one walking tick."""
        timing = record.timing
        if timing.tick < 0:
            return
        parts = timing.read_ns + timing.estimate_ns + timing.control_ns + timing.write_ns
        parts += timing.truth_ns
        self._control.append(timing.control_ns)
        self._cycle.append(timing.cycle_ns)
        self._overhead.append(timing.cycle_ns - parts)

    @property
    def control_ms(self) -> Floats:
        """Controller's step alone."""
        return np.array(self._control) * 1e-6

    @property
    def cycle_ms(self) -> Floats:
        """Whole tick."""
        return np.array(self._cycle) * 1e-6

    @property
    def overhead_ms(self) -> Floats:
        """Whole tick without read, estimate, step, write and truth: judge, schedule, hand-over."""
        return np.array(self._overhead) * 1e-6


def measure(case: Case, duration_s: float) -> list[Row]:
    """Walk one case in lockstep, recorder included."""
    request = RunRequest.checked(**case.request, rate_hz=300, duration_s=duration_s)
    session = build(request)
    stopwatch = Stopwatch()
    with tempfile.TemporaryDirectory() as folder:
        truth = session.world is not None
        recorder = Recorder(Path(folder), make_meta(session), truth=truth, progress=False)
        with closing(session), recorder:
            session.backend.open()
            outcome = Loop(session, (stopwatch, recorder)).run()
    period_ms = 1e3 / 300
    factor = outcome.clock_ns / outcome.wall_ns
    return [
        Row(case.name, "controller step, mean", _mean(stopwatch.control_ms), "ms", case.step_ms),
        Row(case.name, "whole tick, p99", _p99(stopwatch.cycle_ms), "ms", period_ms),
        Row(
            case.name,
            "loop without its parts, p50",
            float(np.median(stopwatch.overhead_ms)),
            "ms",
            LOOP_OVERHEAD_MS,
        ),
        Row(case.name, "lockstep speed", factor, "× real time", case.real_time_factor, True),
    ]


def measure_driver() -> list[Row]:
    """The servo hot path against the SDK."""
    return [
        Row(
            "driver, CPU",
            f"{row.name} (SDK: {row.sdk_classic_us:.0f}, fast {row.sdk_fast_us:.0f} µs)",
            row.ours_us,
            "µs",
            DRIVER_RATIO * row.sdk_classic_us,
        )
        for row in measure_hot_path()
    ]


def _mean(values: Floats) -> float:
    return float(values.mean())


def _p99(values: Floats) -> float:
    return float(np.percentile(values, 99))
