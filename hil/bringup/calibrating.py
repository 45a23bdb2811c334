"""What all calibrations share: a limp robot that is watched, a person who is told what to do."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from hil import __version__
from hil.bringup.deed import Deed
from hil.bringup.dialogue import Dialogue
from hil.bringup.facts import Inspection
from hil.bringup.moment import Moment
from hil.clock import MonotonicClock
from hil.compose import commissioning
from hil.description import RobotDescription
from hil.errors import InputError, StrideError
from hil.interface import Clock
from hil.run_folder import git_commit
from hil.signals import StopSignals

LOOK_NS = 20_000_000
"""Between two looks while somebody is busy with the robot [ns]."""
STILL_RAD = np.radians(1.0)
"""A joint that moves less is held still: three counts are 0.26°."""
STILL_GYRO = np.radians(5.0)
"""Standard deviation of a gyro on a robot that is held still [rad/s] (assumed)."""
STILL_S = 0.7
"""How long one has to hold still [s]."""
PATIENCE_S = 4.0
"""How long one may fidget before one is told [s]."""


class RefusedError(StrideError):
    """A calibration that cannot be right: nothing was written. The findings say why."""

    def __init__(self, inspection: Inspection) -> None:
        self.inspection = inspection
        said = "; ".join(f"{one.where}: {one.what}" for one in inspection.problems)
        super().__init__(f"{said}; nothing was written")


@dataclass(slots=True)
class Calibrating:
    """One robot on its open ports, one person, one file."""

    description: RobotDescription
    sampler: commissioning.RobotSampler
    dialogue: Dialogue
    file: commissioning.CalibrationFile
    clock: Clock
    signals: StopSignals
    inspection: Inspection = field(default_factory=Inspection)
    """Problems, which refuse the calibration, and remarks."""

    @property
    def joints(self) -> list[str]:
        """Joints that answer, in the robot file's order."""
        return [name for name in self.description.joint_names if name in self.sampler.images]

    def require_limp(self) -> None:
        """Raises RefusedError where torque is on, or a servo is not as `setup` leaves it."""
        for joint, why in self.sampler.not_limp():
            self.inspection.expect(False, joint, why)
        self.settle()

    def settle(self) -> None:
        """Raises RefusedError with all problems found until now."""
        if self.inspection.problems:
            raise RefusedError(self.inspection)

    def pause(self) -> None:
        """Until the next look. Raises what a signal means."""
        self.signals.check()
        self.sampler.let_boards_talk()
        self.clock.sleep_until_ns(self.clock.now_ns() + LOOK_NS)

    def wait(self, text: str, *deeds: Deed, look: Callable[[], bool] = lambda: False) -> None:
        """Until Enter, or until `look` is content; it looks as often as it can."""
        self.dialogue.ask(text, *deeds)
        while not look() and not self.dialogue.answered():
            self.pause()

    def still(self, seconds: float = STILL_S) -> Moment:
        """A moment in which nothing moved; tells what moves while there is none."""
        told_ns = self.clock.now_ns() + round(PATIENCE_S * 1e9)
        while True:
            self.signals.check()
            moment = self.sampler.watch(seconds)
            restless = _restless(moment)
            if not restless:
                return moment
            if self.clock.now_ns() > told_ns:
                self.dialogue.say(f"still moving: {', '.join(restless)}; hold still")
                told_ns = self.clock.now_ns() + round(PATIENCE_S * 1e9)


def _restless(moment: Moment) -> list[str]:
    moving = [joint for joint, unrest in moment.unrest.items() if unrest > STILL_RAD]
    turning = moment.imu is not None and moment.imu.unrest > STILL_GYRO
    return [*moving, "torso"] if turning else moving


def software() -> str:
    """Version and commit that calibrate."""
    commit = git_commit()
    return f"stridebridge {__version__}" + (f" ({commit})" if commit else "")


@contextmanager
def calibrating(
    description: RobotDescription,
    ports: dict[str, str],
    out: Path | None,
    dialogue: Dialogue,
    *,
    boards: bool = True,
) -> Iterator[Calibrating]:
    """A robot whose torque is off, on open ports. Raises InputError, RefusedError, BackendError."""
    if description.actuation != "servo":
        raise InputError(f"{description.name} has no servos to calibrate")
    clock, signals = MonotonicClock(), StopSignals()
    file = commissioning.CalibrationFile(description, out, software())
    with (
        signals.caught(),
        commissioning.RobotBench(description, ports, clock, boards=boards) as bench,
    ):
        bench.require_bus()
        sampler = commissioning.RobotSampler(bench)
        work = Calibrating(description, sampler, dialogue, file, clock, signals)
        if not work.joints:
            raise InputError(f"{description.name}: no servo answers: is the supply on?")
        work.require_limp()
        yield work
