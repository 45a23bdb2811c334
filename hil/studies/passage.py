"""A walk for a search: the same parts and results as `stride walk`, with less around each tick."""

from dataclasses import dataclass

import numpy as np

from hil.compose import build_robot
from hil.description import RobotDescription
from hil.errors import BackendError, InvalidCommandError
from hil.interface import Estimate, Floats
from hil.request import RunRequest
from hil.schedule import Operator
from hil.session import Session
from hil.studies.walks import walk_session
from hil.timing import TickSchedule

UPRIGHT = (0.8, 1.2)
"""A body whose root is outside these shares of its first height has fallen, or flies."""


@dataclass(frozen=True, slots=True)
class Passage:
    """What a search wants to know of a walk, over T ticks."""

    time_s: Floats
    """Shape (T,) [s]."""
    base_position: Floats
    """(T, 3) [m]"""
    base_orientation: Floats
    """(T, 4), base to world, (w, x, y, z)."""
    joint_position: Floats
    """(T, n) [rad]"""
    com_velocity: Floats
    """(T, 3) [m/s]"""
    heading: Floats
    """Heading that the controller tracked [rad], (T,)."""
    stopped_s: float | None
    """When it fell, or could not go on [s]; none for a walk that came to its end."""


def pass_by(request: RunRequest, description: RobotDescription) -> Passage:
    """Walk a robot by a resolved request. A fall is a result, and so is a diverged simulation."""
    session = build_robot(request, description)
    if description.start.moving and session.request.estimator == "truth":
        return _straight_on(session)
    walked = walk_session(session)
    trace = walked.trace
    return Passage(
        trace.time_s,
        trace.base_position,
        trace.base_orientation,
        trace.joint_position,
        trace.com_velocity,
        trace.heading,
        walked.stopped_s,
    )


def _straight_on(session: Session) -> Passage:
    """Ticks without supervisor, recorder and timing, for robots that start on the move."""
    request, backend = session.request, session.backend
    rate_hz = request.rate_hz or session.description.defaults.rate_hz
    operator = Operator(request.schedules, session.description.defaults.speed)
    log = _Log(len(session.description.joints), round(request.duration_s * rate_hz))
    fallen = False
    try:
        backend.open()
        backend.arm()
        schedule = TickSchedule(backend.clock, rate_hz)
        while log.rows < log.ticks and not fallen:
            time_s = schedule.wait() / rate_hz
            estimate = session.estimator.update(backend.read())
            command = session.controller.step(estimate, operator.reference(time_s))
            backend.write(command)
            fallen = log.put(time_s, estimate, session.controller.status.heading)
            schedule.finish()
    except (BackendError, InvalidCommandError):
        fallen = True  # thrown by its own torques out of what can be simulated
    finally:
        session.close()
    return log.passage(fallen)


class _Log:
    """The rows of a passage."""

    def __init__(self, joints: int, ticks: int) -> None:
        self.ticks, self.rows = ticks, 0
        self._columns: dict[str, Floats] = {
            "time_s": np.zeros(ticks),
            "base_position": np.zeros((ticks, 3)),
            "base_orientation": np.zeros((ticks, 4)),
            "joint_position": np.zeros((ticks, joints)),
            "com_velocity": np.zeros((ticks, 3)),
            "heading": np.zeros(ticks),
        }

    def put(self, time_s: float, estimate: Estimate, heading: float) -> bool:
        """Keep a tick; whether the body has fallen."""
        columns, row = self._columns, self.rows
        columns["time_s"][row] = time_s
        columns["base_position"][row] = estimate.base_position
        columns["base_orientation"][row] = estimate.base_orientation
        columns["joint_position"][row] = estimate.joint_position
        columns["com_velocity"][row] = estimate.com_velocity
        columns["heading"][row] = heading
        self.rows += 1
        heights = columns["base_position"][:, 2]
        low, high = UPRIGHT
        return not low < heights[row] / heights[0] < high

    def passage(self, fallen: bool) -> Passage:
        """What was kept."""
        columns = {name: column[: self.rows] for name, column in self._columns.items()}
        stopped_s = float(columns["time_s"][-1]) if fallen else None
        return Passage(**columns, stopped_s=stopped_s)
