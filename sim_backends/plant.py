"""The simulated body: one MuJoCo model stepped on an integer-nanosecond grid."""

from dataclasses import replace

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.errors import BackendError, InputError
from hil.interface import Floats, Truth
from hil.servo import MotorParameters
from sim_backends.draws import hidden_values
from sim_backends.foot_loads import FootLoads, rise_to_ground
from sim_backends.model import (
    ACCELEROMETER,
    build_model,
    motor_joints,
    named,
    selection,
    substeps,
)
from sim_backends.plant_servos import encoder_phase, make_servos
from sim_backends.servo_figures import SERVO_KEYS
from sim_backends.servo_physics import ServoPhysics
from sim_backends.servo_protection import OVERLOAD
from sim_backends.support import HOIST, Support
from sim_backends.thrown_ball import ThrownBall
from sim_backends.uneven_floor import UnevenFloor
from sim_backends.water.immersion import Immersion

DIVERGED_SPEED = 1e5
"""Norm of all velocities that no robot reaches [rad/s, m/s]."""


class Plant:
    """Ground truth: the robot, its floor and, for a servo robot, its motors.

    Substep i runs from i·10⁹ // (rate·N) ns to the next grid point with what stood when it began:
    goals and torques written between two grid points act from the second one on. At first the
    robot is in its start pose with its lowest sole point on the floor. Implements
    `hil.interface.World`. The seed draws what the robot hides, and where in a count each
    encoder's zero lies.
    """

    def __init__(
        self,
        description: RobotDescription,
        rate_hz: int,
        seed: int = 0,
        motors: MotorParameters | None = None,
        initial_velocity: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """`initial_velocity`: of the root body, (x, y) [m/s]. Raises InputError."""
        if (motors is None) != (description.actuation == "torque"):
            raise InputError(
                f"{description.file}: the plant of a {description.actuation} robot "
                f"takes {'no ' if motors is not None else ''}motor parameters"
            )
        self.description = description
        self.rate_hz = rate_hz
        self.substeps = substeps(description, rate_hz)
        """Physics substeps a tick, N."""
        self.substep_index = 0
        self.hidden = hidden_values(description, seed)
        """What the seed drew; sensors never show it."""
        self.motors = motors
        """Constants that the data sheets have, not those of this robot."""
        if motors is not None:
            motors = replace(
                motors, torque_constant=motors.torque_constant * self.hidden.torque_constant_scale
            )
        self.model = build_model(description, rate_hz, motors, self.hidden)
        self.data = mujoco.MjData(self.model)
        self._find_root()
        self._find_joints()
        self._find_imu()
        self._floor: UnevenFloor | None = None
        if any(self.hidden.floor_height):
            self._floor = UnevenFloor(self.model, self.data, self.hidden.floor_height, seed)
        self._loads = FootLoads(self.model, self.data, description)
        self._loads_index = 0
        self._corners, self._toes = [0.0] * 8, [0.0] * 2
        self._ball: ThrownBall | None = None
        if description.plant.ball:
            self._ball = ThrownBall(self.model, self.data, description)
        self.immersion = Immersion(description, self.model, self.data, self._root)
        self._support = Support(self.model, self.data, self._position, self._orientation)
        self._set_start_pose(initial_velocity)
        if description.plant.hoist:
            self.hoist()
        n = len(description.joints)
        self._truth = Truth(0, *(np.zeros(k) for k in (3, 4, 3, 3, n, n, 3, 3, (2, 4), 2)))
        self.servos: ServoPhysics | None = None
        """Motors of a servo robot."""
        if motors is not None and description.supply is not None:
            self.servos = make_servos(
                description, description.supply, motors, self.hidden, encoder_phase(seed, n),
                self.model, self.data, self._rotor_dofs,
            )  # fmt: skip
            self.servos.delay_goals(self.substeps * description.plant.latency_ticks)
            if not description.safety.overload_ends_torque:
                self.servos.protection.shutdown &= ~OVERLOAD
            self.drive()

    def drive(self) -> None:
        """Let the servos act on the state as it is now."""
        if self.servos is not None:
            velocity = self._qvel[self._dofs]
            self.servos.drive(self._qpos[self._angles], velocity, self._qvel[self._rotor_dofs])

    def _id(self, kind: mujoco.mjtObj, name: str) -> int:
        return named(self.model, kind, name, self.description.model_path)

    def _find_root(self) -> None:
        model, name = self.model, self.description.root
        self._root = self._id(mujoco.mjtObj.mjOBJ_BODY, name)
        free = model.body_jntadr[self._root]
        if free < 0 or model.jnt_type[free] != mujoco.mjtJoint.mjJNT_FREE:
            raise InputError(f"{self.description.model_path}: root body {name!r} has no free joint")
        q, v = int(model.jnt_qposadr[free]), int(model.jnt_dofadr[free])
        self._qpos, self._qvel = self.data.qpos, self.data.qvel
        self._position: Floats = self._qpos[q : q + 3]
        self._orientation: Floats = self._qpos[q + 3 : q + 7]
        self._linear: Floats = self._qvel[v : v + 3]
        self._angular: Floats = self._qvel[v + 3 : v + 6]
        self._com = self.data.subtree_com[self._root]
        self._com_velocity = self.data.subtree_linvel[self._root]

    def _find_joints(self) -> None:
        description, model = self.description, self.model
        joints = [self._id(mujoco.mjtObj.mjOBJ_JOINT, name) for name in description.joint_names]
        self._dofs = selection(model.jnt_dofadr[joints])
        self._angles = selection(model.jnt_qposadr[joints])
        rotors = motor_joints(model, description)
        self._rotor_dofs = selection(model.jnt_dofadr[rotors])
        self._rotor_angles = selection(model.jnt_qposadr[rotors])

    def _find_imu(self) -> None:
        imu = self.description.imu
        if imu is None:
            return
        site = self._id(mujoco.mjtObj.mjOBJ_SITE, imu.site)
        if self.model.site_bodyid[site] != self._root:
            raise InputError(
                f"{self.description.model_path}: site {imu.site!r} of the imu must "
                f"be in {self.description.root!r}"
            )
        matrix = np.empty(9)
        mujoco.mju_quat2Mat(matrix, self.model.site_quat[site])
        self._site_axes = matrix.reshape(3, 3)
        sensor = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_SENSOR, ACCELEROMETER)
        address = int(self.model.sensor_adr[sensor])
        self._accelerometer = self.data.sensordata[address : address + 3]

    def _set_start_pose(self, velocity: tuple[float, float]) -> None:
        self.data.qpos[self._angles] = self.description.start_position
        self.data.qpos[self._rotor_angles] = self.description.start_position
        self._orientation[:] = (1.0, 0.0, 0.0, 0.0)
        mujoco.mj_kinematics(self.model, self.data)
        if self._floor is not None:
            self._position[2] -= self._floor.place()
        else:
            self._position[2] += rise_to_ground(self.model, self.data, self.description)
        self._linear[:2] = velocity
        self.set_support(not self.description.start.moving)
        mujoco.mj_forward(self.model, self.data)

    # Stepping --------------------------------------------------------------------------------

    @property
    def time_ns(self) -> int:
        """Time of the last grid point [ns], from 0 at the start."""
        return self.grid_time_ns(self.substep_index)

    def grid_time_ns(self, index: int) -> int:
        """Time at which substep `index` begins [ns]."""
        return index * 1_000_000_000 // (self.rate_hz * self.substeps)

    def step(self) -> None:
        """One tick: N substeps. Raises BackendError when the simulation diverges."""
        for _ in range(self.substeps):
            self.substep()

    def substep(self) -> None:
        """One substep of the physics. Raises BackendError when the simulation diverges."""
        self.immersion.step()
        self.substep_index += 1
        if not self._qvel.dot(self._qvel) < DIVERGED_SPEED**2:
            raise BackendError(
                f"{self.description.name}: the simulation diverged at {self.time_ns * 1e-9:.3f} s"
            )
        if self._floor is not None and self.substep_index % self.substeps == 0:
            self._floor.follow()
        self.drive()

    def set_torque(self, torque: Floats) -> None:
        """Joint torques of a torque robot [N·m], (n,), until set again."""
        self.data.qfrc_applied[self._dofs] = torque

    # What is true now ------------------------------------------------------------------------

    @property
    def joint_position(self) -> Floats:
        """[rad], shape (n,); changes with the next substep."""
        position: Floats = self._qpos[self._angles]
        return position

    @property
    def joint_velocity(self) -> Floats:
        """[rad/s], shape (n,); changes with the next substep."""
        velocity: Floats = self._qvel[self._dofs]
        return velocity

    @property
    def orientation(self) -> Floats:
        """Of the root body, base to world (w, x, y, z); changes with the next substep."""
        return self._orientation

    @property
    def angular_velocity(self) -> Floats:
        """Of the root body in its own axes [rad/s], (3,); changes with the next substep."""
        return self._angular

    def specific_force(self) -> Floats:
        """What an ideal accelerometer at the imu site feels, in base axes [m/s²], shape (3,).

        Mean of the last substep, as the contact forces are.
        """
        force: Floats = self._site_axes @ self._accelerometer
        return force

    def foot_force(self) -> Floats:
        """Normal corner forces of the last substep [N], shape (2, 4)."""
        return np.array(self.corner_forces()).reshape(2, 4)

    def corner_forces(self) -> list[float]:
        """Normal forces of the last substep [N] at the corners of both feet, left foot first."""
        if self._loads_index != self.substep_index:
            self._corners, self._toes = self._loads.read()
            self._loads_index = self.substep_index
        return self._corners

    def truth(self) -> Truth:
        """State at the last grid point; the returned object is reused.

        Loads are those of the substep that led there; everything else is of the new state, for
        which the positions are computed afresh, since mj_step leaves those of the state before.
        """
        model, data, truth = self.model, self.data, self._truth
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_subtreeVel(model, data)
        truth.time_ns = self.time_ns
        truth.base_position[:] = self._position
        truth.base_orientation[:] = self._orientation
        truth.base_linear_velocity[:] = self._linear
        truth.base_angular_velocity[:] = self._angular
        truth.joint_position[:] = self.joint_position
        truth.joint_velocity[:] = self.joint_velocity
        truth.com[:] = self._com
        truth.com_velocity[:] = self._com_velocity
        truth.foot_force.ravel()[:] = self.corner_forces()
        truth.toe_force[:] = self._toes
        return truth

    def figures(self) -> dict[str, float | None]:
        """Figures of the servos since the start, by report key; None for a torque robot."""
        if self.servos is None:
            return dict.fromkeys(SERVO_KEYS)
        return self.servos.totals().figures()

    # Disturbances ----------------------------------------------------------------------------

    def set_push(self, force: Floats) -> None:
        """Force at the centre of mass of the root body, world axes [N], until set again."""
        self.data.xfrc_applied[self._root, :3] = force

    def throw_ball(self, mass: float, velocity: Floats) -> None:
        """Throw a ball at the trunk, to hit it at a world velocity [m/s]. Raises BackendError."""
        if self._ball is None:
            raise BackendError(f"{self.description.name}: no ball to throw: set plant.ball=true")
        self._ball.throw(mass, velocity)

    def set_medium(self, level: float, density: float, viscosity: float) -> None:
        """As `Immersion.set_medium`: a liquid [m, kg/m³, factor]; level 0 is dry land."""
        self.immersion.set_medium(level, density, viscosity)

    def set_support(self, supported: bool) -> None:
        """Hold the root body where it is, or let it go; one that hangs stays where it is."""
        self._support.set(supported)

    def rotor_dof(self, joint: int) -> int:
        """Degree of freedom of a joint's rotor: the joint's own where there is no backlash."""
        return int(np.arange(self.model.nv)[self._rotor_dofs][joint])

    def hoist(self, height: float = HOIST) -> None:
        """Lift the root body [m] and hold it there for good: the feet hang free."""
        self._support.hoist(height)
