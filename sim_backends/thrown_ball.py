"""A ball thrown at the trunk of the plant's robot."""

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats
from sim_backends.ball import BALL, COLLISION_BIT, ball_radius
from sim_backends.model import named

FLIGHT_S = 0.1
"""Shortest time between throw and impact [s]."""
CLEARANCE = 4.0
"""Shortest way flown, in radii."""


class ThrownBall:
    """The ball of one plant.

    It touches the trunk and the floor alone: an arm in its way, or a ball that lies between the
    feet afterwards, would be another experiment.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, description: RobotDescription
    ) -> None:
        """`model` has a ball (`add_ball`). Raises InputError when the trunk body is missing."""
        self._model, self._data = model, data
        file, body = description.model_path, mujoco.mjtObj.mjOBJ_BODY
        self._body = named(model, body, BALL, file)
        self._geom = named(model, mujoco.mjtObj.mjOBJ_GEOM, BALL, file)
        self._trunk = named(model, body, description.trunk or description.root, file)
        joint = int(model.body_jntadr[self._body])
        q, v = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        self._place = data.qpos[q : q + 3]
        self._speed = data.qvel[v : v + 6]
        static = model.body_weldid[model.geom_bodyid] == 0
        touched = static | (model.geom_bodyid == self._trunk)
        model.geom_conaffinity[touched] |= COLLISION_BIT
        model.geom_conaffinity[self._geom] = 0

    def throw(self, mass: float, velocity: Floats) -> None:
        """Let a ball of `mass` [kg] hit the centre of mass of the trunk at `velocity` [m/s], (3,).

        It starts so far back that it is free of the robot, with the vertical speed that
        gravity takes away again on the way.
        """
        model, radius = self._model, ball_radius(mass)
        model.body_gravcomp[self._body] = 0.0
        model.body_mass[self._body] = mass
        model.body_inertia[self._body] = 0.4 * mass * radius**2
        model.geom_size[self._geom, 0] = model.geom_rbound[self._geom] = radius
        model.geom_aabb[self._geom, 3:] = radius
        mujoco.mj_setConst(model, mujoco.MjData(model))
        flight = max(FLIGHT_S, CLEARANCE * radius / float(np.linalg.norm(velocity)))
        gravity = model.opt.gravity
        self._place[:] = self._data.xipos[self._trunk] - velocity * flight
        self._place += (self._trunk_velocity() + 0.5 * gravity * flight) * flight
        self._speed[:3] = velocity - gravity * flight
        self._speed[3:] = 0.0

    def _trunk_velocity(self) -> Floats:
        velocity = np.empty(6)
        mujoco.mj_objectVelocity(
            self._model, self._data, mujoco.mjtObj.mjOBJ_BODY, self._trunk, velocity, 0
        )
        return velocity[3:]
