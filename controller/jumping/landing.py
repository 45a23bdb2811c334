"""Landing and standing: the fall is absorbed, the capture point brought over the feet."""

import math

import numpy as np

from controller.jumping.stage import Kit
from controller.jumping.support_polygon import SupportPolygon
from controller.jumping.whole_body import BodyTask
from hil.interface import Estimate, Floats
from hil.smoothstep import smoothstep

MOST_LIFT, MOST_SINK = 1.8, 0.7
"""Largest acceleration upwards and downwards, in g."""
DRIVE = 1.5
"""How far beyond the capture point the centre of pressure goes, in its distance to the goal."""
ABSORB = 1.6
"""Natural frequency of the spring that takes the fall, in √(g/L)."""
STILL = 0.02
"""Speed below which a body stands still, in √(gL)."""
KEEP_INSIDE = 0.8
"""Part of the support's half that the centre of pressure uses."""


class Absorb:
    """Accelerations of the centre of mass that bring it to rest over its feet.

    Vertical: a spring and damper to a height, of damping ratio 1, a_z = ω²·(z* − z) − 2ω·v_z: a
    body that comes down at v sinks v/(e·ω) below it. Level: of a pendulum of height h under
    g + a_z, with Ω² = (g + a_z)/h, the capture point ξ = x + v/Ω moves away from the centre of
    pressure p at Ω·(ξ − p); p = ξ + k·(ξ − ξ*), kept inside the support, brings it back, and the
    body is accelerated by Ω²·(x − p).
    """

    def __init__(self, gravity: float, rate: float) -> None:
        """`gravity` [m/s²]; `rate` ω [1/s]."""
        self._gravity, self._rate = gravity, rate

    def acceleration(
        self, com: Floats, velocity: Floats, goal: Floats, ground: float, support: SupportPolygon
    ) -> Floats:
        """[m/s²], (3,), to rest at `goal` (3,), whose x and y lie inside the support [m].

        `ground` is the height of the soles [m].
        """
        g, omega = self._gravity, self._rate
        up = omega**2 * float(goal[2] - com[2]) - 2.0 * omega * float(velocity[2])
        up = max(-MOST_SINK * g, min(up, MOST_LIFT * g))
        square = (g + up) / max(float(com[2]) - ground, 1e-3)
        capture = com[:2] + velocity[:2] / math.sqrt(square)
        pressure = capture + DRIVE * (capture - goal[:2])
        pressure = inside(pressure, support)
        level = square * (com[:2] - pressure)
        return np.array((level[0], level[1], up))


def inside(point: Floats, support: SupportPolygon) -> Floats:
    """A point, drawn towards the centre of the support until it lies well inside, (2,) [m]."""
    centre = support.centre
    if support.margin(centre + (point - centre) / KEEP_INSIDE) >= 0.0:
        return point
    share, step = 0.0, 0.5
    for _ in range(10):
        if support.margin(centre + (share + step) * (point - centre) / KEEP_INSIDE) >= 0.0:
            share += step
        step /= 2.0
    return np.asarray(centre + share * (point - centre))


class Stand:
    """Absorbs a landing and stands.

    Begins with a foot on the ground, at any velocity; never over by itself.
    """

    def __init__(
        self, kit: Kit, height: float, rise: float, rise_after: float, floor: float
    ) -> None:
        """Heights of the centre of mass above the soles [m]: at first, and once it has come to
        rest, after so many seconds; of the `floor` [m], until a foot has felt it.
        """
        self._kit, self._low, self._high, self._after = kit, height, rise, rise_after
        self._floor = floor
        self._absorb = Absorb(kit.gravity, ABSORB * kit.tasks.pace)
        self._elapsed = 0.0
        self.over = False

    @property
    def settled(self) -> bool:
        """The body stands at its full height and hardly moves."""
        speed = self._kit.tasks.body.robot.com_velocity
        still = STILL / self._kit.tasks.pace * self._kit.gravity
        return self._elapsed > 3.0 * self._after and float(np.abs(speed).max()) < still

    def task(self, estimate: Estimate) -> BodyTask:
        """Come to rest over the middle of the feet."""
        kit = self._kit
        body = kit.tasks.body
        self._elapsed += kit.dt
        bearing = estimate.contact.copy()
        kit.tasks.task.cautious = True
        kit.tasks.bow(kit.depth)
        share = smoothstep(min(max(self._elapsed / self._after - 1.0, 0.0), 1.0))
        support = kit.tasks.support(bearing)
        ground = self._floor
        if bearing.any():
            ground = float(body.corners[bearing, :, 2].mean())
        height = self._low + share * (self._high - self._low)
        goal = np.append(support.centre, ground + height)
        robot = body.robot
        acceleration = self._absorb.acceleration(
            robot.com, robot.com_velocity, goal, ground, support
        )
        return kit.tasks.ground(estimate, acceleration, bearing, ground)
