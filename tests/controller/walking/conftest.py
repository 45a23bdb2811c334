"""The human, its model and states of it, shared by the tests of the torque controller."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from controller.estimation.truth import TruthEstimator
from controller.robot_model import RobotModel
from controller.walking.joint_groups import JointGroups
from controller.walking.torque_config import TorqueWalkingConfig
from controller.walking.torque_walker import TorqueWalker
from hil.interface import Reference, SensorFrame
from hil.robot_files import load_robot
from hil.validation import validate
from sim_backends.plant import Plant


@pytest.fixture(scope="session")
def human():
    return load_robot("human")


@pytest.fixture(scope="session")
def human_config(human):
    return validate(TorqueWalkingConfig, human.walking, human.file, "walking")


def body_state(description, joints=None, rates=None):
    """A state of the robot in the air: upright, at rest, in the start pose."""
    n = len(description.joints)
    return SimpleNamespace(
        base_position=np.array([0.1, -0.2, 1.035]),
        base_orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        base_linear_velocity=np.zeros(3),
        base_angular_velocity=np.zeros(3),
        joint_position=np.array(description.start_position if joints is None else joints),
        joint_velocity=np.zeros(n) if rates is None else rates,
    )


def random_state(description, seed, speed=1.0):
    """A tilted, moving state with bent joints."""
    rng = np.random.default_rng(seed)
    n = len(description.joints)
    state = body_state(description, rng.uniform(-0.4, 0.4, n), speed * rng.normal(size=n))
    quaternion = np.array([1.0, *rng.uniform(-0.2, 0.2, 3)])
    state.base_orientation = quaternion / np.linalg.norm(quaternion)
    state.base_linear_velocity = speed * rng.normal(size=3)
    state.base_angular_velocity = speed * rng.normal(size=3)
    return state


@pytest.fixture
def placed(human):
    """Model and groups of the human in a fixed random pose at rest, and MuJoCo's view of it."""
    robot = RobotModel(human)
    robot.set_state(random_state(human, seed=3, speed=0.0))
    reference = mujoco.MjData(robot.model)
    reference.qpos[:] = robot.data.qpos
    reference.qvel[:] = robot.data.qvel
    mujoco.mj_forward(robot.model, reference)
    return SimpleNamespace(
        robot=robot, groups=JointGroups(human, robot), reference=reference, model=robot.model
    )


class HumanWalk:
    """The human on the simulated plant, with true states; `walk` returns what it did."""

    def __init__(self, rate=300, pd="explicit", ankle_limit=True, speed=0.5, overrides=()):
        self.description = load_robot("human", tuple(overrides))
        self.rate = rate
        lateral = self.description.start.lateral_velocity
        self.plant = Plant(self.description, rate, initial_velocity=(speed, lateral))
        self.estimator = TruthEstimator(self.description, self.plant.truth)
        self.walker = TorqueWalker(self.description, rate, pd, ankle_limit, speed)
        self.reference = Reference(speed=speed)
        self.frame = SensorFrame.empty(len(self.description.joints), imu_present=False)
        self.limit = np.array([joint.torque_limit for joint in self.description.joints])
        self.time = 0.0
        self.velocity = []
        """COM velocity, forward and left in the world [m/s], a row a tick."""

    def tick(self):
        estimate = self.estimator.update(self.frame)
        self.velocity.append(estimate.com_velocity[:2].copy())
        torque = self.walker.step(estimate, self.reference).torque
        self.plant.set_torque(np.clip(torque, -self.limit, self.limit))
        self.plant.step()
        self.time += 1.0 / self.rate
        return estimate

    def walk(self, seconds):
        """Tick until then or until the fall."""
        end = self.time + seconds
        while self.time < end and not self.fell:
            self.tick()
        return self

    @property
    def fell(self):
        return self.plant.truth().base_position[2] < 0.75

    @property
    def steps(self):
        return self.walker.status.steps

    def mean_velocity(self, seconds):
        """Over the last seconds."""
        return np.mean(self.velocity[-round(seconds * self.rate) :], axis=0)

    @property
    def yaw(self):
        w, x, y, z = self.plant.truth().base_orientation
        return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
