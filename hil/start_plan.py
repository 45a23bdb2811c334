"""What happens between arming and T = 0: which pose, how slowly, and on whose feet."""

from dataclasses import dataclass

from hil.description import RobotDescription
from hil.request import RunRequest

RAMP_S = 1.0
"""Time from the present pose to the start pose of a simulated walk."""
SLOW_RAMP_S = 2.0
"""The same where somebody stands beside it: time to see what goes wrong, and to reach a switch."""
SIT_RAMP_S = 3.0
"""Time from the present pose to the sitting one."""
HOLD_S = 0.5
"""Time in which the present pose is held before anything moves: a joint that does not hold shows
here."""
SETTLE_S = 0.5
"""Time on the robot's own feet before T = 0."""
WAIT_S = 60.0
"""Longest time until a real robot that is to walk stands on its feet: somebody lowers it."""
LONGEST_START_S = HOLD_S + SIT_RAMP_S + SETTLE_S
"""No start takes longer, but for the wait."""


@dataclass(frozen=True, slots=True)
class StartPlan:
    """The stages of a start, in this order; times in s."""

    pose: tuple[float, ...]
    """Where the ramp leads [rad], in joint order."""
    hold_s: float
    """The present pose is held."""
    ramp_s: float
    """Every joint moves to `pose`."""
    wait_s: float
    """At most so long the feet may take to carry the weight; 0 does not look."""
    settle_s: float
    """`pose` is held until T = 0."""
    supported: bool
    """A simulated body is held until the ramp is over, as a hand would."""

    def ticks(self, rate_hz: int) -> tuple[int, int, int, int]:
        """Hold, ramp, wait and settle at a control rate [Hz]."""
        hold, ramp, wait, settle = (
            round(time * rate_hz) for time in (self.hold_s, self.ramp_s, self.wait_s, self.settle_s)
        )
        return hold, ramp, wait, settle


def start_plan(request: RunRequest, description: RobotDescription) -> StartPlan:
    """The plan of a run. Simulated walks start as fast as they can; all others slowly."""
    pose = description.start_position
    if request.activity == "sit":
        return StartPlan(sit_position(description), HOLD_S, SIT_RAMP_S, 0.0, SETTLE_S, False)
    if request.activity in ("walk", "jump") and not request.live:
        return StartPlan(pose, 0.0, RAMP_S, 0.0, SETTLE_S, True)
    boards = [foot.board for foot in description.feet.values()]
    waits = request.activity == "walk" and not request.hoisted and None not in boards
    return StartPlan(pose, HOLD_S, SLOW_RAMP_S, WAIT_S if waits else 0.0, SETTLE_S, True)


def sit_position(description: RobotDescription) -> tuple[float, ...]:
    """The sitting pose in joint order [rad]; joints that it does not name go to 0."""
    joints = {} if description.sit is None else description.sit.joints
    return tuple(joints.get(name, 0.0) for name in description.joint_names)
