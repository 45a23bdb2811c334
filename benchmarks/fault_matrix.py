"""The fault matrix: each fault in a walk of the virtual minibiped, how the robot reacts, and when.

Emulated: the dry run in lockstep at 300 Hz, the nominal robot, walking 0.1 m/s; the fault comes
0.7 s after T = 0, or is there from before the robot is opened. Time counts from the fault to the
tick in which the safety chain decided; then sitting down takes 1.1 s, landing 0.4 s. The rows of
processes and signals are in `process_matrix.py`.

Run: `python benchmarks/fault_matrix.py`
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hil.compose import build
from hil.errors import StrideError
from hil.fault_spec import parse_fault
from hil.interface import Estimate, JointCommand, Reference
from hil.loop import Loop
from hil.request import RunRequest
from hil.session import Session

START_S, DURATION_S = 0.7, 1.6
ENDINGS = ("soft_stop", "land", "torque_off")


REFUSED = "refused"
COMMAND = "command:"
"""Of the pseudo-faults below, which the controller commits."""


@dataclass(frozen=True)
class Row:
    """One fault and what is promised."""

    name: str
    fault: str
    """As `--fault`, without its time, or a fault of the controller."""
    reaction: str | None
    """The first that ends the walk; `refused`: nothing is armed; None: it goes on."""
    source: str = ""
    within_s: float = 0.0
    deaf: bool = False
    """A servo cannot say that its torque is off."""
    walk_s: float = DURATION_S
    group: str = ""
    """Heading under which the page shows it, from this row on."""


ROWS = (
    Row("one answer lost", "servo:left_knee:silent@{}+0.003", None, group="Bus"),
    Row("silent for three ticks", "servo:left_knee:silent@{}+0.01", None),
    Row("silent for 0.1 s", "servo:left_knee:silent@{}+0.1", "soft_stop", "left_knee", 0.025),
    Row("answers two times in three", "servo:left_knee:silent=0.33@{}", "soft_stop",
        "left_knee", 0.3),
    Row("a whole bus silent", "bus:left_leg:drop@{}", "soft_stop", "left_hip_yaw", 0.025,
        deaf=True),
    Row("adapter pulled out", "bus:left_leg:disconnect@{}", "torque_off", "program", 0.005,
        deaf=True),
    Row("1 % of all packets lost", "bus:*:drop=0.01@{}", None),
    Row("1 % of all packets damaged", "bus:*:flip=0.01@{}", None),
    Row("1 % cut off", "bus:*:truncate=0.01@{}", None),
    Row("1 % with garbage before them", "bus:*:garbage=0.01@{}", None),
    Row("1 % late by 4 ms", "bus:*:delay=0.01@{}", None),
    Row("1 % collided with", "bus:*:collide=0.01@{}", None),
    Row("every packet twice", "bus:*:duplicate@{}", None),
    Row("the host's own packets echoed", "bus:*:echo@{}", None),
    Row("its clock stands still", "servo:left_knee:frozen@{}", "soft_stop", "left_knee", 0.06,
        group="Servo"),
    Row("restarts", "servo:left_knee:reboot@{}", "soft_stop", "left_knee", 0.025),
    Row("loses its torque", "servo:left_knee:lost_torque@{}", "any", "left_knee", 0.2),
    Row("electrical shock", "servo:left_knee:alert=electrical_shock@{}", "soft_stop",
        "left_knee", 0.05),
    Row("overload told by the servo", "servo:left_knee:alert=overload@{}", None),
    Row("74 °C", "servo:left_knee:overheat=74@{}", None),
    Row("77 °C", "servo:left_knee:overheat=77@{}", "soft_stop", "left_knee", 0.3),
    Row("8 V for 50 ms", "servo:*:undervoltage=8@{}+0.05", None),
    Row("8 V", "servo:*:undervoltage=8@{}", "soft_stop", "supply", 0.3),
    Row("its bus watchdog trips", "servo:left_knee:watchdog_trip@{}", "any", "left_knee", 0.2),
    Row("its encoder drifts, 60°/s", "servo:left_knee:drift=60@{}", "land", "body", 1.5,
        walk_s=2.4),
    Row("another model", "servo:left_knee:wrong_model", REFUSED, "left_knee",
        group="Before arming"),
    Row("two servos of one id", "servo:left_knee:wrong_id=1", REFUSED, "left_leg"),
    Row("firmware without a watchdog", "servo:left_knee:old_firmware=37", REFUSED, "left_knee"),
    Row("silent from the start", "servo:left_knee:silent", REFUSED, "left_knee"),
    Row("a board silent from the start", "board:left_foot:stale", REFUSED, "left_foot"),
    Row("not a number, once", "command:nan_once@{}", None, group="Command"),
    Row("not a number, twice", "command:nan_twice@{}", "soft_stop", "program", 0.01),
    Row("a goal jumps by 1 rad for a tick", "command:glitch@{}", None),
    Row("the controller raises", "command:raises@{}", "soft_stop", "program", 0.005),
    Row("a foot board silent for 30 ms", "board:left_foot:stale@{}+0.03", None, group="Boards"),
    Row("a foot board silent", "board:left_foot:stale@{}", "soft_stop", "left_foot", 0.06),
    Row("a foot board stuck", "board:left_foot:stuck@{}", "soft_stop", "left_foot", 0.3),
    Row("the IMU silent", "board:imu:stale@{}", "soft_stop", "imu", 0.06),
    Row("the IMU stuck", "board:imu:stuck@{}", "soft_stop", "imu", 0.3),
    Row("the clock of a board jumps", "board:left_foot:clock_jump@{}", None),
    Row("a foot board at half its rate", "board:left_foot:slow=2@{}", None),
    Row("the IMU at half its rate", "board:imu:slow=2@{}", None),
    Row("an open cell", "board:left_foot:open_cell@{}", None),
    Row("a saturated cell", "board:left_foot:saturated@{}", None),
    Row("left and right cells exchanged", "board:left_foot:swapped=cells@{}", "any", "feet", 1.0),
    Row("left and right feet exchanged", "board:left_foot:swapped=feet@{}", "any", "feet", 1.0),
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """What a row's walk did."""

    reaction: str | None
    source: str
    name: str
    after_s: float | None
    torque_off: bool
    """Read back at the end."""


def measure(row: Row) -> Measured:
    """Walk, break, watch."""
    spoilt = row.fault.startswith(COMMAND)
    faults = () if spoilt else (parse_fault(row.fault.format(START_S)),)
    session = build(
        RunRequest.checked(
            duration_s=row.walk_s,
            overrides=("plant.draws=null",),
            schedules={"speed": ((0.0, 0.1),)},
            faults=faults,
        )
    )
    if spoilt:
        _spoil(session, row.fault.removeprefix(COMMAND).partition("@")[0])
    watched = _WatchedStop(session)
    try:
        session.backend.open()
    except StrideError as error:
        session.close()
        return Measured(REFUSED, "", str(error), None, True)
    loop = Loop(session, (), sits=False)
    refusal = ""
    try:
        loop.run()
    except Exception as error:  # a lost port comes out of the loop; the faults tell it
        refusal = str(error)
    if not watched.armed:
        return Measured(REFUSED, "", refusal, None, watched.verified)
    ends = [fault for fault in loop.outcome.faults if fault.reaction in ENDINGS]
    if not ends:
        return Measured(None, "", "", None, watched.verified)
    first = ends[0]
    return Measured(first.reaction, first.source, first.name, first.time_s - START_S,
                    watched.verified)  # fmt: skip


def as_promised(row: Row, found: Measured) -> bool:
    """Whether a row did what it should, when it should."""
    if row.reaction == REFUSED:
        return found.reaction == REFUSED and row.source in found.name
    if found.torque_off == row.deaf:
        return False
    if row.reaction is None or found.after_s is None:
        return found.reaction == row.reaction
    same = row.reaction in ("any", found.reaction) and found.source == row.source
    return same and found.after_s <= row.within_s


Source = Callable[[Estimate, Reference], JointCommand]


def _spoil(session: Session, how: str) -> None:
    """Have the controller commit a mistake after START_S of walking."""
    step: Source = session.controller.step
    first = round(START_S * (session.request.rate_hz or 0))
    ticks = iter(range(10_000_000))
    span = {"nan_once": 1, "nan_twice": 2, "glitch": 1, "raises": 10_000_000}[how]

    def spoilt(estimate: Estimate, reference: Reference) -> JointCommand:
        command, tick = step(estimate, reference), next(ticks)
        if not first <= tick < first + span:
            return command
        if how == "raises":
            raise RuntimeError("a mistake in the controller")
        wrong = np.nan if how.startswith("nan") else command.position[3] + 1.0
        position = command.position.copy()
        position[3] = wrong
        return JointCommand(position, command.velocity, command.stiffness, command.damping,
                            command.torque)  # fmt: skip

    session.controller.step = spoilt  # type: ignore[method-assign]


class _WatchedStop:
    """Remembers whether the last stop was read back, and whether torque was ever on."""

    def __init__(self, session: Session) -> None:
        self.verified = self.armed = False
        self._arm = session.backend.arm
        session.backend.arm = self._note_arming  # type: ignore[method-assign]
        self._stop = session.backend.stop
        session.backend.stop = self  # type: ignore[assignment, method-assign]

    def _note_arming(self) -> None:
        self.armed = True
        self._arm()

    def __call__(self, mode: Any) -> bool:
        self.verified = self._stop(mode)
        return self.verified


def main() -> int:
    """Print the table of docs/safety.md; 1 if a row did not keep its promise."""
    print("| fault | promised | measured | after | torque off read back |")
    print("|---|---|---|---|---|")
    broken = 0
    for row in ROWS:
        found = measure(row)
        broken += not as_promised(row, found)
        promised = "goes on" if row.reaction is None else f"stops within {row.within_s:g} s"
        told, after, off = "goes on", "", "yes" if found.torque_off else "no"
        if found.reaction == REFUSED:
            promised, told, off = "refused", "refused", "never on"
        elif found.reaction is not None and found.after_s is not None:
            told = f"{found.reaction}: {found.source}, {found.name}"
            after = f"{1000 * found.after_s:.0f} ms"
        if row.group:
            print(f"| **{row.group}** | | | | |")
        print(f"| {row.name} | {promised} | {told} | {after} | {off} |", flush=True)
        if not as_promised(row, found):
            sys.stderr.write(f"{row.name}: {found}\n")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
