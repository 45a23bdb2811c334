"""Prediction of the stance foot's corner forces for extra torques of one tick.

Seed 000_bd1305a0ae731442, section 3.1: a sample is evaluated by one step of the simulated model.
The forces of that step do not depend on its integration, so only accelerations are computed.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.selection import selection
from controller.walking.stabilizer.reduced_models import ReducedModel
from controller.walking.stabilizer.sample_box import Sample
from hil.description import RobotDescription
from hil.interface import SIDES, Floats

TOE = 4
"""Place of the toe after the four corners in a foot's forces."""
_DISABLED = (
    mujoco.mjtDisableBit.mjDSBL_ISLAND,
    mujoco.mjtDisableBit.mjDSBL_MIDPHASE,
    mujoco.mjtDisableBit.mjDSBL_SENSOR,
)
"""Not needed for contact forces, and they cost time."""
_START = int(mujoco.mjtStage.mjSTAGE_NONE)
_KEEP_STATE = int(mujoco.mjtStage.mjSTAGE_VEL)
"""Skips what depends on positions and velocities only."""


@dataclass(frozen=True, slots=True)
class _Foot:
    """Where a foot's contacts are found, and which degrees of freedom load it."""

    sole: int
    toe: int
    centre: Floats
    axes: Floats
    dofs: list[int]
    """Of ankle pitch, ankle roll and knee."""


class ResponseModel:
    """An MjModel and MjData of its own that answer: which forces, if these torques were added?

    `place` copies the state of the robot model and applies the tick's joint torques; `forces`
    then redoes only the acceleration stage (`mj_forwardSkip`) for a sample. With the true state
    and torques, the whole robot's forces are those of the plant's next step.
    """

    def __init__(
        self, robot: RobotModel, description: RobotDescription, reduced: ReducedModel, dt: float
    ) -> None:
        self._robot, self._reduced = robot, reduced
        self.model = model = reduced.model
        # Elliptic cones have the normal force in one row, whatever the plant uses.
        model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        model.opt.timestep = dt
        for bit in _DISABLED:
            model.opt.disableflags |= int(bit)
        self.data = data = mujoco.MjData(model)
        self._index_state()
        names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, j) for j in range(model.njnt)]
        shared = [name for name in description.joint_names if name in names]
        joints = [description.joint_names.index(name) for name in shared]
        self._joints = selection(np.array(joints))
        self._dofs = selection(np.array([model.joint(name).dofadr[0] for name in shared]))
        self._feet = [self._foot(description, side) for side in SIDES if f"{side}_knee" in names]
        self._sides = [i for i, side in enumerate(SIDES) if f"{side}_knee" in names]
        self._qpos, self._qvel, self._applied = data.qpos, data.qvel, data.qfrc_applied
        self._acceleration, self._first_guess = data.qacc, data.qacc_warmstart
        self._whole_qpos, self._whole_qvel = robot.data.qpos, robot.data.qvel
        masses = robot.model.body_mass[reduced.removed]
        self._weights = masses / max(float(masses.sum()), 1e-12)
        self._removed_weight = float(masses.sum()) * robot.gravity
        self.dofs: list[int] = []
        """Degrees of freedom of the sample's joints."""
        self.rows: list[tuple[int, int, int]] = []
        """Of each contact of the stance foot: first constraint row, corner or `TOE`, contact."""

    def _index_state(self) -> None:
        """Where the state of the kept bodies is in the whole model."""
        whole, kept = self._robot.model, self._reduced.kept
        positions: list[int] = []
        velocities: list[int] = []
        for body in kept:
            for joint in np.flatnonzero(whole.jnt_bodyid == body):
                free = whole.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE
                first = int(whole.jnt_qposadr[joint])
                positions += range(first, first + (7 if free else 1))
                first = int(whole.jnt_dofadr[joint])
                velocities += range(first, first + (6 if free else 1))
        self._positions = selection(np.array(positions))
        self._velocities = selection(np.array(velocities))

    def _foot(self, description: RobotDescription, side: str) -> _Foot:
        model, data = self.model, self.data
        foot = description.feet[side]  # type: ignore[index]
        sole = model.geom(foot.sole).id
        joints = [f"{side}_ankle_pitch", f"{side}_ankle_roll", f"{side}_knee"]
        return _Foot(
            sole,
            -1 if foot.toe is None else model.geom(foot.toe).id,
            data.geom_xpos[sole],
            data.xmat[model.geom_bodyid[sole]],
            [int(model.joint(name).dofadr[0]) for name in joints],
        )

    def place(self, torques: Floats, stance: int) -> list[float]:
        """Adopt the robot model's state; forces [N] of corners and toe under the joint torques.

        `torques` [N·m], shape (n,), in description order.
        """
        self._qpos[:] = self._whole_qpos[self._positions]
        self._qvel[:] = self._whole_qvel[self._velocities]
        self._applied[self._dofs] = torques[self._joints]
        foot = self._feet[self._sides.index(stance)]
        self.dofs = foot.dofs
        self._base = self._applied[foot.dofs].tolist()
        if self._removed_weight:
            self._hang_weight()
        self._first_guess[:] = self._acceleration  # of the last sample: saves iterations
        mujoco.mj_forwardSkip(self.model, self.data, _START, 1)
        self._find_contacts(foot)
        return self._read()

    def forces(self, sample: Sample) -> list[float]:
        """Forces [N] of corners and toe, with the sample added to the torques of `place`."""
        applied, base = self._applied, self._base
        for dof, own, extra in zip(self.dofs, base, sample, strict=True):
            applied[dof] = own + extra
        self._first_guess[:] = self._acceleration
        mujoco.mj_forwardSkip(self.model, self.data, _KEEP_STATE, 1)
        return self._read()

    def _hang_weight(self) -> None:
        """The weight of the missing bodies, at their centre of mass, as force and moment."""
        centre = self._weights @ self._robot.data.xipos[self._reduced.removed]
        carrier = int(self._reduced.kept[self._reduced.carrier])
        dx, dy, _ = (centre - self._robot.data.xipos[carrier]).tolist()
        weight = self._removed_weight
        wrench = (0.0, 0.0, -weight, -dy * weight, dx * weight, 0.0)
        self.data.xfrc_applied[self._reduced.carrier] = wrench

    def _find_contacts(self, foot: _Foot) -> None:
        """Contacts between the foot and the floor; they stay the same within a tick."""
        self.rows = []
        contact = self.data.contact
        points, addresses = contact.pos.tolist(), contact.efc_address.tolist()
        centre, axes = foot.centre.tolist(), foot.axes.tolist()
        for i, pair in enumerate(contact.geom.tolist()):
            if addresses[i] < 0:
                continue
            if foot.sole in pair:
                self.rows.append((addresses[i], _corner(points[i], centre, axes), i))
            elif foot.toe in pair:
                self.rows.append((addresses[i], TOE, i))

    def _read(self) -> list[float]:
        forces = [0.0] * 5
        rows: list[float] = self.data.efc_force.tolist()
        for row, place, _ in self.rows:
            forces[place] += rows[row]
        return forces


def _corner(point: list[float], centre: list[float], axes: list[float]) -> int:
    """Index of the corner in whose quadrant of the sole a point lies."""
    dx, dy, dz = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
    rear = axes[0] * dx + axes[3] * dy + axes[6] * dz < 0.0
    right = axes[1] * dx + axes[4] * dy + axes[7] * dz < 0.0
    return 2 * rear + right
