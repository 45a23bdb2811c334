"""What bring-up procedures find, as plain data: the seam between the drivers and the command line.

Angles are in degrees here: these are figures for a person's eyes, not for a controller.
"""

from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True, slots=True)
class FoundPort:
    """One serial port of this computer."""

    device: str
    by_id: str | None
    """Path that stays the same when adapters are plugged in another order; none without one."""
    description: str


@dataclass(frozen=True, slots=True)
class FoundServo:
    """One servo that answered."""

    port: str
    baud: int
    id: int
    number: int
    """Model number."""
    model: str | None
    """None for a number that is not known."""
    firmware: int
    lacks: tuple[str, ...]
    """Features that the driver would use and this servo has not."""


@dataclass(slots=True)
class PortSearch:
    """What was heard on one port."""

    port: str
    servos: list[FoundServo] = field(default_factory=list)
    suspicious: list[str] = field(default_factory=list)
    """Answers that cannot be trusted, one sentence each."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that a check found."""

    severity: Literal["problem", "remark"]
    """A problem keeps the robot from being armed, a remark does not."""
    where: str
    what: str
    advice: str = ""


@dataclass(slots=True)
class Inspection:
    """All findings of a check, and on how much it looked."""

    findings: list[Finding] = field(default_factory=list)
    looked_at: int = 0
    """Questions that were asked."""

    @property
    def problems(self) -> list[Finding]:
        """What keeps the robot from being armed."""
        return [finding for finding in self.findings if finding.severity == "problem"]

    def expect(self, good: bool, where: str, what: str, advice: str = "") -> bool:
        """Ask a question; a wrong answer is a problem. Returns the answer."""
        self.looked_at += 1
        if not good:
            self.findings.append(Finding("problem", where, what, advice))
        return good

    def remark(self, where: str, what: str, advice: str = "") -> None:
        """Note something that keeps nobody from anything."""
        self.findings.append(Finding("remark", where, what, advice))


@dataclass(frozen=True, slots=True)
class SettingChange:
    """One register that is to be changed."""

    register: str
    found: int
    wanted: int
    why: str


@dataclass(frozen=True, slots=True)
class ServoPlan:
    """What setting up one servo takes."""

    joint: str
    bus: str
    id: int
    """At which it answers now."""
    baud: int
    """At which it answers now [bit/s]."""
    changes: tuple[SettingChange, ...]
    problem: str = ""
    """Why it cannot be set up; then there are no changes."""


@dataclass(frozen=True, slots=True)
class RelaxedServo:
    """A servo after it was told to switch torque off."""

    where: str
    off: bool
    """Read back."""


@dataclass(slots=True)
class Relaxation:
    """What became of a robot or a port that was told to switch torque off."""

    servos: list[RelaxedServo] = field(default_factory=list)
    not_reached: dict[str, str] = field(default_factory=dict)
    """Why a bus could not be told, or asked, by name."""

    @property
    def complete(self) -> bool:
        """Whether servos answered, all of them off, and no bus was left out."""
        off = bool(self.servos) and all(servo.off for servo in self.servos)
        return off and not self.not_reached


@dataclass(frozen=True, slots=True)
class JogSample:
    """One look at a servo that is being moved."""

    time_s: float
    goal_deg: float
    """From where it stood at first, as the others."""
    position_deg: float
    planned_deg: float
    """What the servo's own profile asks for."""
    velocity_dps: float
    duty_pct: float
    current_a: float | None
    """None for a model that does not measure it."""
    voltage_v: float
    temperature_c: int


@dataclass(frozen=True, slots=True)
class JointReading:
    """What a joint's servo says now."""

    joint: str
    bus: str
    id: int
    position_deg: float | None
    """None for a servo that never answered, as the others."""
    velocity_dps: float | None = None
    temperature_c: int | None = None
    voltage_v: float | None = None
    torque_on: bool | None = None
    error: str = ""
    """Hardware errors by name."""
    age_ms: float | None = None
    """Since it answered last."""


@dataclass(frozen=True, slots=True)
class BoardReading:
    """What a sensor board says now."""

    board: str
    kind: Literal["foot", "imu"]
    values: dict[str, float]
    """By name; none before the first frame."""
    unit: str = ""
    invalid: tuple[str, ...] = ()
    """Values that the board itself marks as invalid."""
    age_ms: float | None = None


@dataclass(frozen=True, slots=True)
class RobotReading:
    """Everything that a robot says now."""

    joints: tuple[JointReading, ...]
    boards: tuple[BoardReading, ...]


@dataclass(frozen=True, slots=True)
class WatchdogTrip:
    """How long a bus has to be silent until a servo's watchdog stops it."""

    joint: str
    nominal_ms: float
    longest_quiet_ms: float
    """The longest silence that it bore."""
    shortest_trip_ms: float
    """The shortest silence that stopped it."""
    torque_stays: bool
    """Whether torque was still on after it stopped."""
    trials: int
