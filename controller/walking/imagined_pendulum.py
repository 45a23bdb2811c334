"""The pendulum of a steady walk, for a robot that hangs: what its body would do on the ground."""

import math

from controller.walking.heading_frame import Pair
from controller.walking.pendulum_state import PendulumState


class ImaginedPendulum(PendulumState):
    """Place and velocity of the com by the steady walk's own time, not by any measurement.

    With ω of the com's height, period T, speed V and sway w (signed towards the swing side), at
    the time t of a step, from the pivot:

        x = V_x·T/2·sinh ω(t − T/2)/sinh(ωT/2)
        y = V_y·T/2·sinh ω(t − T/2)/sinh(ωT/2) + w/2·cosh ω(t − T/2)/cosh(ωT/2)

    the orbit of the linear inverted pendulum that repeats itself from step to step (Kajita et al.
    2001, The 3D linear inverted pendulum mode).
    """

    def imagine(self, phase: float, speed: Pair, sway: float, ahead: float) -> None:
        """Take the state at a phase of a step; `ahead` is how far the pivot is ahead of the ankle
        [m]. Pairs in the heading frame."""
        model, pendulum = self._model, self.pendulum
        pendulum.omega = omega = math.sqrt(model.gravity / float(model.com[2]))
        period = pendulum.period
        half, time = omega * period / 2.0, omega * period * (min(phase, 1.0) - 0.5)
        odd, odd_rate = math.sinh(time) / math.sinh(half), math.cosh(time) / math.sinh(half)
        even, even_rate = math.cosh(time) / math.cosh(half), math.sinh(time) / math.cosh(half)
        (ahead_x, ahead_y), side = (speed[0] * period / 2, speed[1] * period / 2), sway / 2
        x, y = ahead_x * odd, ahead_y * odd + side * even
        self.velocity = u, v = (
            omega * ahead_x * odd_rate,
            omega * (ahead_y * odd_rate + side * even_rate),
        )
        self.seen = (x + ahead, y)
        self.place = (x + self._lead * u, y + self._lead * v)
        self.capture = (self.place[0] + u / omega, self.place[1] + v / omega)
