"""The hop of a servo robot: the rehearsed curves as goals, legs drawn up, then a soft stand."""

import numpy as np

from controller.jumping.hop_rehearsal import HopCurves
from controller.jumping.jump_curves import RATE
from hil.description import RobotDescription
from hil.interface import Estimate, JointCommand, Reference, WalkStatus
from hil.smoothstep import smoothstep

OVERDUE = 2.0
"""A landing that nothing shows is taken to have been after so many airtimes."""


class ServoHop:
    """Implements `hil.interface.Controller` for robots of position servos.

    Plays position, velocity and torque of the rehearsal, which the gain mapping turns into shifted
    goals. At take-off the goals jump to where the legs are drawn up, so that all duty turns the
    motors round: legs that only stopped would stay on the ground, since their motors turn on for
    longer than the body rises. Begins in the start pose, on both feet; the first contact after a
    flight, or its absence after the time of two, leads over a rest back to the start pose.
    """

    def __init__(self, description: RobotDescription, rate_hz: int, curves: HopCurves) -> None:
        self._curves, self._rate_hz = curves, rate_hz
        self.plan = curves.plan
        self._start = np.array(description.start_position)
        self._knees = np.array([name.endswith("knee") for name in description.joint_names])
        self._limits = np.array([joint.torque_limit for joint in description.joints])
        self._command = JointCommand.zeros(len(description.joints))
        self._command.stiffness[:] = [joint.stiffness for joint in description.joints]
        self._command.damping[:] = [joint.damping for joint in description.joints]
        self._tick = 0
        self._landed_at: int | None = None
        self._was_off = False
        self.torque_ratio = 0.0
        """Largest torque asked for so far, as a share of its joint's stall torque."""
        self.status = WalkStatus(walking=True)

    def step(self, estimate: Estimate, reference: Reference) -> JointCommand:
        """The goals of this tick."""
        del reference  # The jump was given once and for all.
        row = self._tick * RATE // self._rate_hz
        self._tick += 1
        left = len(self._curves.position) - 1 - row
        if left > 0:
            return self._push(row, left)
        return self._fly(estimate, -left)

    def _push(self, row: int, left: int) -> JointCommand:
        curves, command = self._curves, self._command
        self.status.steps = int(row >= curves.push_begin)
        command.position[:] = curves.position[row + 1]
        command.velocity[:] = curves.velocity[row + 1]
        command.torque[:] = curves.torque[row + 1]
        asked = float(np.abs(command.torque / self._limits).max())
        self.torque_ratio = max(self.torque_ratio, asked)
        if left <= curves.ahead:
            command.position[self._knees] = curves.drawn_up[self._knees]
            command.velocity[self._knees] = command.torque[self._knees] = 0.0
        return command

    def _fly(self, estimate: Estimate, rows: int) -> JointCommand:
        """Legs drawn up `rows` after take-off, and once landed on the way back to the start."""
        curves, command = self._curves, self._command
        self.status.steps = 2
        command.velocity[:] = command.torque[:] = 0.0
        self._watch_feet(estimate, rows)
        command.position[:] = curves.drawn_up
        if self._landed_at is not None:
            self.status.steps = 3
            self._rise((self._tick - self._landed_at) * RATE / self._rate_hz)
        return command

    def _rise(self, steps: float) -> None:
        """From drawn up legs to the rest of the landing, and from there to the start pose."""
        curves, position = self._curves, self._command.position
        share = smoothstep(min(steps / curves.landing_steps, 1.0))
        position += share * (curves.landed - position)
        later = min(max(steps - curves.landing_steps, 0.0) / curves.return_steps, 1.0)
        position += smoothstep(later) * (self._start - position)

    def _watch_feet(self, estimate: Estimate, rows: int) -> None:
        """Note the landing: contact after a flight, or none of both for too long."""
        touching = bool(estimate.contact.any())
        self._was_off = self._was_off or not touching
        overdue = rows > OVERDUE * self.plan.path.airtime * RATE
        if self._landed_at is None and ((self._was_off and touching) or overdue):
            self._landed_at = self._tick
