"""A plant whose body is carried along a recorded motion, with recorded loads under its feet."""

import mujoco
import numpy as np

from hil.body_motion import BodyMotion, foot_load
from hil.description import RobotDescription
from hil.interface import Floats
from hil.servo import MotorParameters
from sim_backends.model import SUPPORT, named
from sim_backends.plant import Plant

IMPEDANCE = 0.99
"""Share of the weld's acceleration that is the weld's own."""
TIME_CONSTANT = 0.005
"""Of the weld [s]: six substeps."""


class CarriedPlant(Plant):
    """The joints move as their servos make them; the body and the loads are given.

    The hand that holds the root body (a weld) follows the motion x(t) without lag: its law
    ẍ = k·(x_hand − x) − b·ẋ tracks where x_hand = x(t) + (b·ẋ(t) + ẍ(t))/k, with
    b = 2/(d·T) and k = 1/(d·T)² for its impedance d and time constant T (MuJoCo manual, Solver
    parameters). The floor touches nothing: corner forces act along the normal of each sole and
    the horizontal force in the middle of its pressure. Load cells measure what was put on.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        seed: int,
        motors: MotorParameters,
        motion: BodyMotion,
    ) -> None:
        """`motion` has a row a tick."""
        self._loads_now = [0.0] * 8
        super().__init__(description, rate_hz, seed, motors)
        self._motion = motion
        self._begun: int | None = None
        model = self.model
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self._weld = named(model, mujoco.mjtObj.mjOBJ_EQUALITY, SUPPORT, description.model_path)
        model.eq_solref[self._weld] = TIME_CONSTANT, 1.0
        model.eq_solimp[self._weld, :2] = IMPEDANCE
        feet = (description.feet["left"], description.feet["right"])
        self._feet = [self._id(mujoco.mjtObj.mjOBJ_BODY, foot.body) for foot in feet]
        self._soles = [self._id(mujoco.mjtObj.mjOBJ_GEOM, foot.sole) for foot in feet]

    def begin(self, measured: Floats) -> None:
        """Take the pose in which the encoders show `measured` [rad], (n,); the motion begins."""
        angles = measured - self.hidden.joint_zero
        self._qpos[self._angles] = angles
        self._qpos[self._rotor_angles] = angles
        self._qvel[:] = 0.0
        self._position[:] = self._motion.position[0]
        self._orientation[:] = self._motion.orientation[0]
        self._begun = self.substep_index
        self.set_support(True)
        mujoco.mj_forward(self.model, self.data)
        self.drive()

    def substep(self) -> None:
        """One substep of the physics; at the first of a tick the hand moves on."""
        if self._begun is not None:
            done = self.substep_index - self._begun
            if done % self.substeps == 0:
                self._carry(min(done // self.substeps, len(self._motion.position) - 1))
        super().substep()

    def corner_forces(self) -> list[float]:
        """Normal forces that are put on the corners of both feet [N], left foot first."""
        return self._loads_now

    def _carry(self, tick: int) -> None:
        """Where the hand must be in the middle of a tick, and what presses on the feet."""
        motion, model = self._motion, self.model
        half = 0.5 / self.rate_hz
        lead = 2.0 * IMPEDANCE * TIME_CONSTANT
        bend = (IMPEDANCE * TIME_CONSTANT) ** 2
        speed = motion.velocity[tick] + half * motion.acceleration[tick]
        position = motion.position[tick] + half * motion.velocity[tick]
        hand = position + lead * speed + bend * motion.acceleration[tick]
        spin = motion.spin[tick] + half * motion.spin_rate[tick]
        turn = half * motion.spin[tick] + lead * spin + bend * motion.spin_rate[tick]
        orientation = motion.orientation[tick].copy()
        mujoco.mju_quatIntegrate(orientation, turn, 1.0)
        model.eq_data[self._weld, 3:6] = hand
        model.eq_data[self._weld, 6:10] = orientation
        self._loads_now = motion.corners[tick].ravel().tolist()
        for foot in (0, 1):
            self._press(foot, motion.corners[tick, foot], motion.shear[tick, foot])

    def _press(self, foot: int, corners: Floats, shear: Floats) -> None:
        data, body, sole = self.data, self._feet[foot], self._soles[foot]
        axes, centre = data.xmat[body].reshape(3, 3), data.geom_xpos[sole]
        force, point = foot_load(corners, shear, axes, centre, self.model.geom_size[sole])
        data.xfrc_applied[body, :3] = force
        data.xfrc_applied[body, 3:] = np.cross(point - data.xipos[body], force)
