"""The hop of a servo robot: the rehearsed curves as goals, then a soft stand."""

import numpy as np

from controller.jumping.rehearsal import RATE, JumpCurves
from hil.description import RobotDescription
from hil.interface import Estimate, JointCommand, Reference, WalkStatus

RETURN_TIME = 6.5
"""From the take-off pose back to the start pose once the feet carry again, in √(L/g)."""
TUCK_S = 0.12
"""How far back in the push the pose of the flight is [s]."""


class ServoHop:
    """Implements `hil.interface.Controller` for robots of position servos.

    Plays position, velocity and torque of the rehearsal, which the gain mapping turns into shifted
    goals. Then the legs are drawn up to where they were TUCK_S before: legs that only stopped
    would stay on the ground, since their motors turn on longer than the body rises. Begins in the
    start pose, on both feet; the first contact after a flight, or its absence after the time of
    one, leads back to the start pose.
    """

    def __init__(
        self, description: RobotDescription, rate_hz: int, curves: JumpCurves, pace: float
    ) -> None:
        """`pace` is √(g/L) [1/s]."""
        self._curves, self._rate_hz = curves, rate_hz
        self.plan = curves.plan
        self._start = np.array(description.start_position)
        self._limits = np.array([joint.torque_limit for joint in description.joints])
        self._command = JointCommand.zeros(len(description.joints))
        self._command.stiffness[:] = [joint.stiffness for joint in description.joints]
        self._command.damping[:] = [joint.damping for joint in description.joints]
        self._tick = 0
        self._return_ticks = round(RETURN_TIME / pace * rate_hz)
        self._landed_at: int | None = None
        self._was_off = False
        self.torque_ratio = 0.0
        """Largest torque asked for so far, as a share of its joint's stall torque."""
        self.status = WalkStatus(walking=True)

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The goals of this tick."""
        del reference  # The jump was given once and for all.
        curves, command = self._curves, self._command
        row = self._tick * RATE // self._rate_hz
        self._tick += 1
        last = len(curves.position) - 1
        if row < last:
            self.status.steps = int(row >= curves.push_begin)
            command.position[:] = curves.position[row + 1]
            command.velocity[:] = curves.velocity[row + 1]
            command.torque[:] = curves.torque[row]
            asked = float(np.abs(curves.torque[row] / self._limits).max())
            self.torque_ratio = max(self.torque_ratio, asked)
            return command
        self.status.steps = 2
        command.velocity[:] = command.torque[:] = 0.0
        self._watch_feet(estimate, row - last)
        share = 0.0
        if self._landed_at is not None:
            self.status.steps = 3
            share = min((self._tick - self._landed_at) / self._return_ticks, 1.0)
            share *= share * (3.0 - 2.0 * share)
        drawn_up = curves.position[max(curves.push_begin, last - round(TUCK_S * RATE))]
        command.position[:] = drawn_up + share * (self._start - drawn_up)
        return command

    def _watch_feet(self, estimate: Estimate, rows: int) -> None:
        """Note the landing: contact after a flight, or twice the airtime without any news."""
        touching = bool(estimate.contact.any())
        self._was_off = self._was_off or not touching
        overdue = rows > 2.0 * self.plan.path.airtime * RATE
        if self._landed_at is None and ((self._was_off and touching) or overdue):
            self._landed_at = self._tick
