"""What the body is asked in a tick: on its feet a ground force, in the air places for its feet."""

import math

import numpy as np

from controller.jumping.support_polygon import SupportPolygon
from controller.jumping.whole_body import BodyTask, WholeBody
from controller.walking.rotations import about_y, about_z, rotation_vectors
from hil.description import RobotDescription
from hil.interface import Bools, Estimate, Floats
from hil.smoothstep import smoothstep

TRUNK, POSTURE, FEET = 2.0, 3.0, 6.0
"""Natural frequencies of the trunk's attitude, the free joints and the feet, in √(g/L)."""
CALM = 1.0
"""And of the trunk's attitude while a landing is absorbed: a trunk that is turned upright at once
puts the load on the heels, far behind the knees, which then carry less of the fall."""
LIMP = 0.3
"""How strongly a joint that only follows, such as a toe, keeps its place."""
GIVE = 0.5
"""Share of the body's velocity of descent with which its feet meet the ground. Feet that meet it at
rest have to be drawn up under a body that falls, and it lands on folded legs."""
LEG_PARTS = ("hip", "knee", "ankle")
JOINT_WEIGHT, LEG_WEIGHT, PLACE_WEIGHT = 10.0, 0.1, 0.1
"""How much the posture of the joints and of the root's attitude, of the legs, and the place of the
root matter in the choice among accelerations: legs follow from feet and body."""
GROUND_SLACK, AIR_SLACK, LEVEL_GROUND, LEVEL_AIR = 1.6e-3, 1.6e-2, 0.1, 1.0
"""Slack of the feet's rows, in leg lengths squared, and of the root's attitude, on the ground and
in the air, where legs at the end of their reach must not drag the body with them."""


class BodyTasks:
    """Makes a `BodyTask` of this tick's state; all tracking is PD with damping ratio 1.

    On the ground: force m·(a + g) through the centre of mass, and a moment that turns the body as
    if it were rigid, Θ·(ω_t²·e − 2ω_t·ω) with e the attitude error, Θ its inertia, ω = L/Θ.
    """

    def __init__(self, description: RobotDescription, body: WholeBody, posture: Floats) -> None:
        """`posture`: joint angles that free joints keep [rad], (n,)."""
        robot = body.robot
        self.body, self._posture = body, posture
        nv = robot.model.nv
        self.pace = math.sqrt(body.gravity / robot.leg_length)
        """√(g/L) [1/s]."""
        self._base = robot.base_dof
        self._dofs = robot.dof_addresses
        names = description.joint_names
        self._limp = np.array(["toe" in name for name in names])
        legs = [any(part in name for part in LEG_PARTS) for name in names]
        weight = np.full(nv, JOINT_WEIGHT)
        weight[self._base : self._base + 3] = PLACE_WEIGHT
        weight[self._dofs[legs]] = LEG_WEIGHT
        self.task = BodyTask(nv, weight)
        self._slack = robot.leg_length**2
        self._level, self._trunk, self._turn = np.eye(3), np.eye(3), np.zeros(3)
        self.lean = 0.0
        """λ, of the trunk in the crouch [rad]."""
        self.upright = 0.0
        """Height of the centre of mass above the soles at take-off [m]: lower, the trunk leans."""
        self._inertia = self._rigid_inertia()
        self._errors = np.zeros((3, 3, 3))

    def _rigid_inertia(self) -> float:
        """About a level axis through the centre of mass, of the model's present pose [kg·m²]."""
        robot = self.body.robot
        data, model = robot.data, robot.model
        places = data.xipos[1:] - robot.com
        away = np.square(places[:, 0]) + np.square(places[:, 2])
        return float(model.body_mass[1:] @ away)

    def set_heading(self, heading: float) -> None:
        """Where body and feet face [rad]."""
        self._level[:] = about_z(heading)
        self.set_lean(0.0, 0.0)

    def set_lean(self, pitch: float, rate: float) -> None:
        """Of the trunk, forward positive [rad], and how fast it changes [rad/s]."""
        self._trunk[:] = self._level @ about_y(pitch)
        self._turn[:] = rate * self._level[:, 1]

    def bow(self, depth: float) -> None:
        """Lean the trunk as a body does that crouches: the share of the depth that it has reached.

        With u its share of `depth` below the height of take-off [m], the lean is
        λ·u²·(3 − 2u), so that the trunk is at rest at both ends.
        """
        robot = self.body.robot
        height = float(robot.com[2] - self.body.corners[..., 2].min())
        u = min(max((self.upright - height) / depth, 0.0), 1.0)
        rate = -6.0 * u * (1.0 - u) * float(robot.com_velocity[2]) / depth
        self.set_lean(self.lean * smoothstep(u), self.lean * rate)

    def _posture_task(self, estimate: Estimate) -> Floats:
        """Accelerations towards the posture; the attitude error of the root, in world axes."""
        robot, task = self.body.robot, self.task
        self._errors[0] = self._trunk @ robot.root_rotation.T
        for foot in range(2):
            self._errors[1 + foot] = self._level @ robot.feet[foot].T
        errors = rotation_vectors(self._errors)
        omega = POSTURE * self.pace
        error = self._posture - estimate.joint_position
        error *= omega**2
        error -= 2.0 * omega * estimate.joint_velocity
        error[self._limp] *= LIMP
        task.posture[self._dofs] = error
        turn = robot.root_rotation.T @ errors[0]
        turn *= omega**2
        turn -= 2.0 * omega * (estimate.base_angular_velocity - robot.root_rotation.T @ self._turn)
        task.posture[self._base + 3 : self._base + 6] = turn
        return errors

    def ground(
        self, estimate: Estimate, acceleration: Floats, bearing: Bools, floor: float = 0.0
    ) -> BodyTask:
        """Accelerate the centre of mass [m/s²], (3,), on the feet that bear, (2,).

        A foot that does not is set down on the `floor`, at that height [m], even out of a fall.
        """
        body, task = self.body, self.task
        errors = self._posture_task(estimate)
        mass = body.robot.mass
        task.force[:] = mass * acceleration
        task.force[2] += mass * body.gravity
        omega = (CALM if task.cautious else TRUNK) * self.pace
        task.moment[:] = self._inertia * omega**2 * errors[0]
        task.moment -= 2.0 * omega * body.angular_momentum
        task.bearing[:] = bearing[:, None]
        rate = FEET * self.pace
        feet, velocity = task.foot_acceleration, body.foot_velocity
        feet[:, :3] = rate**2 * errors[1:] - 2.0 * rate * velocity[:, :3]
        feet[:, 3:] = -2.0 * rate * velocity[:, 3:]
        if not bearing.all():
            away = body.corners[..., 2].min(axis=1) - floor
            feet[~bearing, 5] -= rate**2 * away[~bearing] + body.gravity
            if not bearing.any():
                feet[:, 5] += 2.0 * rate * GIVE * float(body.robot.com_velocity[2])
        task.foot_slack = GROUND_SLACK * self._slack
        task.level_slack = LEVEL_GROUND
        return task

    def air(
        self, estimate: Estimate, places: Floats, velocities: Floats, accelerations: Floats
    ) -> BodyTask:
        """Move the ankles along a path [m, m/s, m/s²], (2, 3) each, in the world; feet level."""
        body, task = self.body, self.task
        errors = self._posture_task(estimate)
        task.force[:] = 0.0
        task.bearing[:] = False
        rate = FEET * self.pace
        feet, velocity = task.foot_acceleration, body.foot_velocity
        feet[:, :3] = rate**2 * errors[1:] - 2.0 * rate * velocity[:, :3]
        ankles = np.array(body.robot.ankles)
        feet[:, 3:] = accelerations + rate**2 * (places - ankles)
        feet[:, 3:] += 2.0 * rate * (velocities - velocity[:, 3:])
        task.foot_slack = AIR_SLACK * self._slack
        task.level_slack = LEVEL_AIR
        return task

    def support(self, bearing: Bools) -> SupportPolygon:
        """Hull of the soles that bear, or of both if none does."""
        corners = self.body.corners
        return SupportPolygon.of(corners[bearing if bearing.any() else [True, True]].reshape(-1, 3))
