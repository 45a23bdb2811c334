"""What a run is asked to be: the command line's answer to every question, checked once."""

from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, PositiveFloat, PositiveInt, ValidationError, model_validator

from hil.description import RobotDescription
from hil.errors import DescriptionError, InputError
from hil.fault_spec import FaultSpec, check_faults
from hil.jump_order import JumpOrder
from hil.schedule import Schedules
from hil.validation import Config

BackendName = Literal["mujoco", "bus"]
BusName = Literal["virtual", "real"]
EstimatorName = Literal["sensors", "truth"]
Activity = Literal["walk", "stand", "sit", "jump"]
Feet = Literal["carry", "hang", "either", "leap"]
"""Whether the feet carry a walking robot, must hang free, may do either, or leave the ground."""
ViewName = Literal["web", "native"]
PdName = Literal["explicit", "implicit"]
StabilizerSolverName = Literal["cma", "linear", "scan"]
DEFAULT_SOLVER: StabilizerSolverName = "linear"

KEYS = "keys"
"""What `--steer` names besides a gamepad's device file."""

OPTIONS = {"rate_hz": "--rate", "duration_s": "--duration", "overrides": "--set"}
"""Command line options whose name is not that of their field."""


class RunRequest(Config):
    """One run. None means: as the robot's description says (`resolved` fills it in)."""

    robot: str = "minibiped"
    """Name of a shipped robot or a YAML file."""
    activity: Activity = "walk"
    jump: JumpOrder | None = None
    """With the activity `jump`, and only there."""
    hoisted: bool = False
    """Walk in the air: the robot hangs, and its steps end by the clock."""
    backend: BackendName | None = None
    bus: BusName | None = None
    """Only with the bus backend; where the command line is silent, real if live, else virtual."""
    live: bool = False
    """The operator says that real servos may move: the real bus, and nothing else."""
    ports: dict[str, str] = {}
    """Of a real robot, by the names of its buses and boards, instead of the robot file's."""
    rate_hz: PositiveInt | None = Field(default=None, le=2000)
    duration_s: PositiveFloat = 20.0
    """From the first walking tick [s]."""
    seed: int = Field(default=0, ge=0)
    realtime: bool = False
    """Pace a simulated robot by the monotonic clock instead of in lockstep."""
    schedules: Schedules = Schedules()
    faults: tuple[FaultSpec, ...] = ()
    """What goes wrong in a virtual robot."""
    estimator: EstimatorName | None = None
    pd: PdName | None = None
    stabilizer: bool | None = None
    stabilizer_solver: StabilizerSolverName | None = None
    ankle_limit: bool | None = None
    overrides: tuple[str, ...] = ()
    """`KEY=VALUE` changes of the description."""
    out: Path | None = None
    """The run folder itself; none makes `runs/<time>-<robot>/`."""
    report: Path | None = None
    """A second copy of report.json."""
    priority: int | None = Field(default=None, ge=1, le=98)
    """SCHED_FIFO priority of the loop."""
    view: ViewName | None = None
    """Show the run while it goes on."""
    steer: str | None = None
    """`keys`, or the device file of a gamepad, which brings the keys with it."""

    @classmethod
    def checked(cls, **values: Any) -> "RunRequest":
        """A request from a user's values; raises InputError naming the option."""
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            first = error.errors()[0]
            problem = first["msg"].removeprefix("Value error, ")
            if not first["loc"]:
                raise InputError(problem) from error
            names = [part for part in first["loc"] if isinstance(part, str)]
            field = names[1] if names[0] in ("schedules", "jump") and len(names) > 1 else names[0]
            option = OPTIONS.get(field, "--" + field.replace("_", "-"))
            raise InputError(f"{option}: {problem} (got {first['input']!r})") from error

    @property
    def lockstep(self) -> bool:
        """Whether time is the simulation's own: nothing then waits for the wall clock."""
        return not self.realtime and self.bus != "real"

    @property
    def steered(self) -> bool:
        """Whether somebody steers this walk: it then waits for the word to begin."""
        return self.activity == "walk" and (self.view is not None or self.steer is not None)

    @property
    def paced(self) -> bool:
        """Whether virtual time is held back to the wall's, since somebody watches or steers."""
        return self.lockstep and (self.view is not None or self.steer is not None)

    @property
    def feet(self) -> Feet:
        """What the feet of this run do."""
        if self.activity != "walk":
            return "leap" if self.activity == "jump" else "either"
        return "hang" if self.hoisted else "carry"

    @model_validator(mode="before")
    @classmethod
    def _live_is_real(cls, values: Any) -> Any:
        if isinstance(values, dict) and values.get("live") and values.get("bus") is None:
            return {**values, "bus": "real"}
        return values

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.bus == "real" and not self.live:
            raise ValueError("--bus real moves real servos: add --live to say that you mean it")
        if self.live and (self.bus != "real" or self.backend == "mujoco"):
            other = "--backend mujoco" if self.backend == "mujoco" else "--bus virtual"
            raise ValueError(f"--live moves real servos: it does not go with {other}")
        if self.bus is not None and self.backend == "mujoco":
            raise ValueError("--bus belongs to --backend bus, not to --backend mujoco")
        if self.bus == "real" and self.estimator == "truth":
            raise ValueError("--estimator truth needs a simulated robot; a real one has sensors")
        if self.bus == "real" and self.schedules.pushes:
            raise ValueError("--push needs a simulated robot")
        if self.bus == "real" and self.schedules.balls:
            raise ValueError("--ball needs a simulated robot")
        if (self.schedules.density or self.schedules.viscosity) and not self.schedules.water:
            raise ValueError("--density and --viscosity are a liquid's: say how high, --water H")
        if self.bus == "real" and self.schedules.water:
            raise ValueError("--water needs a simulated robot (docs/water.md)")
        if self.ports and not self.live:
            raise ValueError("--port and --ports are a real robot's: add --live to move its servos")
        if (self.activity == "jump") != (self.jump is not None):
            raise ValueError("a jump needs a target, and nothing else has one")
        if self.activity == "jump" and (self.live or self.hoisted):
            raise ValueError("--live: no jump on a real robot; it is for simulated ones")
        if self.hoisted:
            self._check_hoisted()
        if self.faults and (self.bus == "real" or self.backend == "mujoco"):
            other = "a real one" if self.bus == "real" else "--backend mujoco, which has no wires"
            raise ValueError(f"--fault is for a virtual robot behind wires, not for {other}")
        if self.steer is not None and self.steer != KEYS and not self.steer.startswith("/"):
            raise ValueError(
                f"--steer: {self.steer!r} is neither {KEYS} nor a device such as /dev/input/js0"
            )
        if self.priority is not None and self.lockstep:
            raise ValueError("--priority needs --realtime or --live: lockstep has no deadlines")
        return self

    def _check_hoisted(self) -> None:
        """What a robot in the air cannot do."""
        schedules = self.schedules
        given = {"turns": "--turn", "pushes": "--push", "balls": "--ball"}
        for key, option in given.items():
            if getattr(schedules, key):
                raise ValueError(f"{option} needs the ground: it does not go with --hoisted")
        if self.estimator == "truth":
            raise ValueError("--estimator truth knows of no floor under a hoisted robot")

    def resolved(self, description: RobotDescription) -> "RunRequest":
        """This request with the robot's defaults filled in. Raises InputError if they clash."""
        defaults = description.defaults
        backend = self.backend or ("bus" if self.bus is not None else defaults.backend)
        if backend == "bus" and not description.buses:
            raise InputError(f"{description.name} has no servo bus: use --backend mujoco")
        if backend == "bus":
            description.require_servos()
        if self.faults and backend == "mujoco":
            raise InputError(f"--fault needs --backend bus; {description.name} runs on mujoco here")
        check_faults(self.faults, description)
        if self.pd is not None and description.actuation == "servo":
            raise InputError(f"--pd is for torque robots; {description.name} has servos")
        stabilizer = defaults.stabilizer if self.stabilizer is None else self.stabilizer
        if stabilizer and description.actuation == "servo":
            raise InputError(
                f"--stabilizer adds torques, for torque robots; {description.name} has servos"
            )
        if self.stabilizer_solver is not None and not stabilizer:
            raise InputError("--stabilizer-solver needs --stabilizer")
        self._check_rung(description)
        if self.realtime and backend == "mujoco":
            raise InputError("--realtime is for the bus backend; --backend mujoco has no deadlines")
        filled = {
            "backend": backend,
            "bus": (self.bus or "virtual") if backend == "bus" else None,
            "rate_hz": self.rate_hz or defaults.rate_hz,
            "estimator": self.estimator or defaults.estimator,
            "pd": self.pd or defaults.pd,
            "stabilizer": stabilizer,
            "stabilizer_solver": (self.stabilizer_solver or DEFAULT_SOLVER) if stabilizer else None,
            "ankle_limit": defaults.ankle_limit if self.ankle_limit is None else self.ankle_limit,
        }
        return self.model_copy(update=filled)

    def _check_rung(self, description: RobotDescription) -> None:
        what = "--hoisted" if self.hoisted else self.activity
        rung = self.hoisted or self.activity in ("stand", "sit")
        if rung and description.actuation == "torque":
            raise InputError(f"{what} is for robots with servos; {description.name} takes torques")
        if self.activity == "sit" and description.sit is None:
            raise DescriptionError(description.file, "sit", "is missing: no pose to sit in")
