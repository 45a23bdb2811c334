"""What one step of the bare simulation costs, beside the walk of a controller."""

from time import perf_counter_ns

import mujoco
import numpy as np

from hil.cycle import TickRecord
from hil.description import RobotDescription


class PhysicsStep:
    """A sink that times one `mj_step` of the robot's own model from the state of every tick.

    Wall time, in the process of the walk and between its ticks, so that a busy machine slows
    both alike.
    """

    def __init__(self, description: RobotDescription, rate_hz: int) -> None:
        self._model = model = mujoco.MjModel.from_xml_path(str(description.model_path))
        self._data = mujoco.MjData(model)
        model.opt.timestep = 1.0 / rate_hz
        joints = [model.joint(name) for name in description.joint_names]
        root = model.body(description.root)
        self._base_qpos = int(model.jnt_qposadr[root.jntadr[0]])
        self._base_dof = int(model.jnt_dofadr[root.jntadr[0]])
        self._qpos = np.array([joint.qposadr[0] for joint in joints])
        self._dofs = np.array([joint.dofadr[0] for joint in joints])
        self._spent_ns = 0
        self._steps = 0

    def put(self, record: TickRecord) -> None:
        """Step from one tick's true state under its torques."""
        truth, data = record.truth, self._data
        if truth is None or record.time_s < 0:
            return
        qpos, dof = self._base_qpos, self._base_dof
        data.qpos[qpos : qpos + 3] = truth.base_position
        data.qpos[qpos + 3 : qpos + 7] = truth.base_orientation
        data.qvel[dof : dof + 3] = truth.base_linear_velocity
        data.qvel[dof + 3 : dof + 6] = truth.base_angular_velocity
        data.qpos[self._qpos] = truth.joint_position
        data.qvel[self._dofs] = truth.joint_velocity
        data.qfrc_applied[self._dofs] = record.command.torque
        begin = perf_counter_ns()
        mujoco.mj_step(self._model, data)
        self._spent_ns += perf_counter_ns() - begin
        self._steps += 1

    @property
    def mean_ms(self) -> float | None:
        """Mean time of a step [ms]; None before the first."""
        return 1e-6 * self._spent_ns / self._steps if self._steps else None
