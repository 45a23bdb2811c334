"""In the air: where the feet go while the body flies on its parabola."""

import math

import numpy as np

from controller.jumping.body_tasks import GIVE
from controller.jumping.jump_plan import JumpPlan
from controller.jumping.stage import Kit
from controller.jumping.whole_body import BodyTask
from hil.interface import Estimate, Floats

TUCK_SHARE = 0.4
"""Part of the flight after which the feet are drawn up highest."""
OVERDUE = 1.5
"""A flight that lasts longer than so many of its times has missed the ground."""


def time_to_fall(height: float, speed: float, gravity: float) -> float:
    """Time until a thrown body, `height` [m] above its goal and rising at `speed` [m/s], is there.

    0 if it never is.
    """
    square = speed * speed + 2.0 * gravity * height
    return (speed + math.sqrt(square)) / gravity if square > 0.0 else 0.0


class FootFlight:
    """One foot's way relative to the centre of mass: drawn up first, then put down.

    Two cubics, each from where the foot is to a goal that may move: in the first `tuck_share` of
    the flight to the tuck, a place on the line from start to landing, raised; then to the
    landing, which is reached with the ground's own velocity, that is minus the body's. Each tick
    integrates a = 6·(p* − p)/t² − 2·(2v + v*)/t, the cubic's first acceleration.
    """

    def __init__(self, position: Floats, velocity: Floats, airtime: float, dt: float) -> None:
        """Position [m] and velocity [m/s] relative to the centre of mass, (3,) each."""
        self.position, self.velocity = position.copy(), velocity.copy()
        self.acceleration = np.zeros(3)
        self._dt, self._airtime = dt, airtime

    def step(self, goal: Floats, goal_velocity: Floats, time_left: float) -> None:
        """One tick towards a goal that is reached after `time_left` [s]."""
        t = max(time_left, 4.0 * self._dt)
        self.acceleration[:] = 6.0 * (goal - self.position) / t**2
        self.acceleration -= 2.0 * (2.0 * self.velocity + goal_velocity) / t
        self.position += self._dt * (self.velocity + 0.5 * self._dt * self.acceleration)
        self.velocity += self._dt * self.acceleration


class Flight:
    """In the air: tuck, then the feet go to where they shall land.

    Begins when the push is over, with the feet still on the ground; over with the first contact
    after they have left it, of both or of one for two ticks, or when the time of the landing is
    long past.
    """

    def __init__(self, kit: Kit, plan: JumpPlan, tuck: float, down: float, stance: Floats) -> None:
        """`tuck`: how high the feet are drawn up [m]; `down` height of the centre of mass above
        the soles at touch-down [m]; `stance`: the ankles from the soles' centre as they shall
        land [m], (2, 3), however they left the ground.
        """
        self._kit, self._plan, self._tuck = kit, plan, tuck
        self._elapsed = 0.0
        self._left_ground = self._touched = False
        body = kit.tasks.body
        com, velocity = body.robot.com, body.robot.com_velocity
        ankles = np.array(body.robot.ankles)
        self._start = ankles
        self._goals = stance + plan.landing_feet
        self._drop = ankles[:, 2] - com[2]
        self._down = float(plan.landing_feet[2]) + down
        self._airtime = plan.path.airtime
        self._feet = [FootFlight(ankle - com, -velocity, self._airtime, kit.dt) for ankle in ankles]
        self.over = False

    def task(self, estimate: Estimate) -> BodyTask:
        """Draw the feet up, then put them down where they shall land."""
        kit, robot = self._kit, self._kit.tasks.body.robot
        kit.tasks.set_lean(0.0, 0.0)
        self._elapsed += kit.dt
        com, velocity = robot.com, robot.com_velocity
        fall = time_to_fall(float(com[2]) - self._down, float(velocity[2]), kit.gravity)
        touching = bool(estimate.contact.any())
        self._left_ground = self._left_ground or not touching
        # One foot that brushes an edge is free again within a tick, and no landing.
        landed = self._left_ground and touching and (self._touched or bool(estimate.contact.all()))
        self._touched = touching
        self.over = landed or (fall <= 0.0 and self._elapsed > OVERDUE * self._airtime)
        self._advance(com, velocity, fall)
        places = np.array([foot.position for foot in self._feet]) + com
        velocities = np.array([foot.velocity for foot in self._feet]) + velocity
        accelerations = np.array([foot.acceleration for foot in self._feet])
        accelerations[:, 2] -= kit.gravity
        return kit.tasks.air(estimate, places, velocities, accelerations)

    def _advance(self, com: Floats, velocity: Floats, fall: float) -> None:
        """One tick of both feet; in the first part of the flight to the tuck, then to the landing.

        Goals are relative to where the centre of mass will be by then.
        """
        g, airtime = self._kit.gravity, self._airtime
        to_tuck = TUCK_SHARE * airtime - self._elapsed
        for foot, flight in enumerate(self._feet):
            if to_tuck > 0.0:
                place = 0.5 * (self._start[foot] + self._goals[foot])
                middle = com + velocity * to_tuck
                relative = place - middle
                relative[2] = self._drop[foot] + self._tuck
                speed = np.append(0.5 * (self._goals[foot] - self._start[foot])[:2] / airtime, 0.0)
                speed[:2] -= velocity[:2]
                flight.step(relative, speed, to_tuck)
            else:
                there = com + velocity * fall
                there[2] -= 0.5 * g * fall**2
                end = velocity.copy()
                end[2] -= g * fall
                flight.step(self._goals[foot] - there, -GIVE * end, fall)
