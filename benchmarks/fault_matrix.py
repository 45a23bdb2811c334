"""The fault matrix: each fault in a walk of the virtual minibiped, how the robot reacts, and when.

Emulated: the dry run in lockstep at 300 Hz, the nominal robot, walking 0.1 m/s; the fault comes
0.7 s after T = 0. Time counts from the fault to the tick in which the safety chain decided; then
sitting down takes 1.1 s, landing 0.4 s.

Run: `python benchmarks/fault_matrix.py`
"""

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from hil.compose import build
from hil.fault_spec import parse_fault
from hil.loop import Loop
from hil.request import RunRequest
from hil.session import Session

START_S, DURATION_S = 0.7, 1.6
ENDINGS = ("soft_stop", "land", "torque_off")


@dataclass(frozen=True)
class Row:
    """One fault and what is promised."""

    name: str
    fault: str
    """As `--fault`, without its time."""
    reaction: str | None
    """The first that ends the walk; None: it goes on."""
    source: str = ""
    within_s: float = 0.0


ROWS = (
    Row("one answer lost", "servo:left_knee:silent@{}+0.003", None),
    Row("silent for three ticks", "servo:left_knee:silent@{}+0.01", None),
    Row("silent for 0.1 s", "servo:left_knee:silent@{}+0.1", "soft_stop", "left_knee", 0.025),
    Row("answers two times in three", "servo:left_knee:silent=0.33@{}", "soft_stop",
        "left_knee", 0.3),
    Row("its clock stands still", "servo:left_knee:frozen@{}", "soft_stop", "left_knee", 0.06),
    Row("restarts", "servo:left_knee:reboot@{}", "soft_stop", "left_knee", 0.025),
    Row("loses its torque", "servo:left_knee:lost_torque@{}", "any", "left_knee", 0.2),
    Row("electrical shock", "servo:left_knee:alert=electrical_shock@{}", "soft_stop",
        "left_knee", 0.05),
    Row("overload told by the servo", "servo:left_knee:alert=overload@{}", None),
    Row("74 °C", "servo:left_knee:overheat=74@{}", None),
    Row("77 °C", "servo:left_knee:overheat=77@{}", "soft_stop", "left_knee", 0.3),
    Row("its bus watchdog trips", "servo:left_knee:watchdog_trip@{}", "any", "left_knee", 0.2),
    Row("1 % of all packets lost", "bus:*:drop=0.01@{}", None),
    Row("1 % of all packets damaged", "bus:*:flip=0.01@{}", None),
    Row("adapter pulled out", "bus:left_leg:disconnect@{}", "torque_off", "program", 0.005),
    Row("a foot board silent for 30 ms", "board:left_foot:stale@{}+0.03", None),
    Row("a foot board silent", "board:left_foot:stale@{}", "soft_stop", "left_foot", 0.06),
    Row("a foot board stuck", "board:left_foot:stuck@{}", "soft_stop", "left_foot", 0.3),
    Row("the IMU silent", "board:imu:stale@{}", "soft_stop", "imu", 0.06),
    Row("the IMU stuck", "board:imu:stuck@{}", "soft_stop", "imu", 0.3),
    Row("the clock of a board jumps", "board:left_foot:clock_jump@{}", None),
    Row("an open cell", "board:left_foot:open_cell@{}", None),
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
    session = build(
        RunRequest.checked(
            duration_s=DURATION_S,
            overrides=("plant.draws=null",),
            schedules={"speed": ((0.0, 0.1),)},
            faults=(parse_fault(row.fault.format(START_S)),),
        )
    )
    session.backend.open()
    watched = _WatchedStop(session)
    loop = Loop(session, (), sits=False)
    with suppress(Exception):  # a lost port comes out of the loop; the faults tell it
        loop.run()
    ends = [fault for fault in loop.outcome.faults if fault.reaction in ENDINGS]
    if not ends:
        return Measured(None, "", "", None, watched.verified)
    first = ends[0]
    return Measured(first.reaction, first.source, first.name, first.time_s - START_S,
                    watched.verified)  # fmt: skip


class _WatchedStop:
    """Remembers whether the last stop was read back."""

    def __init__(self, session: Session) -> None:
        self.verified = False
        self._stop = session.backend.stop
        session.backend.stop = self  # type: ignore[assignment, method-assign]

    def __call__(self, mode: Any) -> bool:
        self.verified = self._stop(mode)
        return self.verified


def main() -> None:
    """Print the table of docs/safety.md."""
    print("| fault | promised | measured | after | torque off read back |")
    print("|---|---|---|---|---|")
    for row in ROWS:
        found = measure(row)
        promised = "goes on" if row.reaction is None else f"stops within {row.within_s:g} s"
        told = "goes on"
        after = ""
        if found.reaction is not None and found.after_s is not None:
            told = f"{found.reaction}: {found.source}, {found.name}"
            after = f"{1000 * found.after_s:.0f} ms"
        off = "yes" if found.torque_off else "no"
        print(f"| {row.name} | {promised} | {told} | {after} | {off} |")


if __name__ == "__main__":
    main()
