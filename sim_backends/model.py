"""The plant's MuJoCo model: a robot's MJCF with the plant's own actuators and settings."""

import mujoco
import numpy as np

from hil.clock import substeps_per_tick
from hil.description import RobotDescription
from hil.errors import InputError
from hil.servo import MotorParameters
from sim_backends.ball import add_ball

SUPPORT = "support"
"""Weld between world and root body: the hand that holds the robot."""
ACCELEROMETER = "imu_accelerometer"
_DISABLED = (
    mujoco.mjtDisableBit.mjDSBL_AUTORESET,
    mujoco.mjtDisableBit.mjDSBL_ISLAND,
    mujoco.mjtDisableBit.mjDSBL_MIDPHASE,
)
"""A diverged plant must be reported, not put back to its first pose. One robot is one constraint
island, and bodies of few geoms need no search tree: both only cost time."""
_SUPPORT_SOLREF = (0.005, 1.0)
"""Time constant of the hand [s] and its damping ratio: stiff, but above two substeps."""


def build_model(
    description: RobotDescription, rate_hz: int, motors: MotorParameters | None
) -> mujoco.MjModel:
    """Compile the robot's MJCF as a plant that takes N substeps a tick.

    A servo robot gets one `dcmotor` a joint, fed with the terminal voltage (MuJoCo manual,
    actuator/dcmotor); actuators of the MJCF itself are dropped, since a backend drives the
    joints. Raises InputError when the MJCF cannot be read or lacks a part that is named.
    """
    _keep_log_off_disk()
    spec = _read(description)
    _require_parts(spec, description)
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    if motors is not None:
        _add_motors(spec, description, motors)
    _add_support(spec, description.root)
    if description.plant.ball:
        add_ball(spec)
    if description.imu is not None:
        spec.add_sensor(
            name=ACCELEROMETER,
            type=mujoco.mjtSensor.mjSENS_ACCELEROMETER,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=description.imu.site,
        )
    model = _compile(spec, description)
    _configure(model, description, rate_hz)
    return model


def _keep_log_off_disk() -> None:
    """MuJoCo's warnings would go to MUJOCO_LOG.TXT in the user's folder."""
    log = mujoco.MjLogConfig.get()
    log.logto_file = False
    log.set()


def substeps(description: RobotDescription, rate_hz: int) -> int:
    """Physics substeps a tick: the robot's own number, or enough for 1100 Hz."""
    return description.plant.substeps or substeps_per_tick(rate_hz)


def named(model: mujoco.MjModel, kind: mujoco.mjtObj, name: str, file: object) -> int:
    """Id of a named part of the model; raises InputError that lists the names there are."""
    found = int(mujoco.mj_name2id(model, kind, name))
    if found < 0:
        count = {
            mujoco.mjtObj.mjOBJ_BODY: model.nbody,
            mujoco.mjtObj.mjOBJ_JOINT: model.njnt,
            mujoco.mjtObj.mjOBJ_GEOM: model.ngeom,
            mujoco.mjtObj.mjOBJ_SITE: model.nsite,
        }
        names = [mujoco.mj_id2name(model, kind, i) for i in range(count[kind])]
        what = kind.name.removeprefix("mjOBJ_").lower()
        raise _missing(file, what, name, names)
    return found


def _require_parts(spec: mujoco.MjSpec, description: RobotDescription) -> None:
    """Check what the actuators and the support refer to, before the compiler trips over it."""
    wanted = [
        ("body", [description.root], spec.bodies),
        ("joint", description.joint_names, spec.joints),
        ("site", [description.imu.site] if description.imu is not None else [], spec.sites),
    ]
    for what, names, parts in wanted:
        found = [part.name for part in parts]
        for name in names:
            if name not in found:
                raise _missing(description.model_path, what, name, found)


def _missing(file: object, what: str, name: str, found: list[str]) -> InputError:
    return InputError(f"{file}: no {what} {name!r}; there are: {', '.join(filter(None, found))}")


def foot_geoms(description: RobotDescription) -> list[str]:
    """Names of all soles and separate toes."""
    feet = description.feet.values()
    return [name for foot in feet for name in (foot.sole, foot.toe) if name is not None]


def _read(description: RobotDescription) -> mujoco.MjSpec:
    if not description.model_path.is_file():
        raise InputError(f"{description.file}: model: no such file: {description.model_path}")
    try:
        return mujoco.MjSpec.from_file(str(description.model_path))
    except ValueError as error:
        problem = str(error).replace("\n", " ")
        raise InputError(f"{description.model_path}: is not valid MJCF: {problem}") from error


def _compile(spec: mujoco.MjSpec, description: RobotDescription) -> mujoco.MjModel:
    try:
        return spec.compile()
    except ValueError as error:
        problem = str(error).replace("\n", " ")
        raise InputError(f"{description.model_path}: does not compile: {problem}") from error


def _add_motors(
    spec: mujoco.MjSpec, description: RobotDescription, motors: MotorParameters
) -> None:
    for j, name in enumerate(description.joint_names):
        actuator = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        constant = float(motors.torque_constant[j])
        actuator.set_to_dcmotor(
            motorconst=[constant, constant], resistance=float(motors.resistance[j])
        )


def _add_support(spec: mujoco.MjSpec, root: str) -> None:
    """A weld, not a reset of the root's state: its force is part of the dynamics, so the legs
    feel a body that is really held, and letting go changes nothing but that force."""
    weld = spec.add_equality(
        name=SUPPORT,
        type=mujoco.mjtEq.mjEQ_WELD,
        name1="world",
        name2=root,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        active=False,
    )
    weld.data[:] = 0.0
    weld.data[6] = weld.data[10] = 1.0
    weld.solref = list(_SUPPORT_SOLREF)


def _configure(model: mujoco.MjModel, description: RobotDescription, rate_hz: int) -> None:
    option = model.opt
    option.timestep = 1.0 / (rate_hz * substeps(description, rate_hz))
    # MuJoCo 4.0.0 solves sparse Jacobians wrongly (mujoco issue 3767); robots here are small.
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    for bit in _DISABLED:
        option.disableflags |= int(bit)
    _set_friction(model, description)
    _set_joints(model, description)
    root = named(model, mujoco.mjtObj.mjOBJ_BODY, description.root, description.model_path)
    model.body_mass[root] *= description.plant.mass_scale
    model.body_inertia[root] *= description.plant.mass_scale
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _set_friction(model: mujoco.MjModel, description: RobotDescription) -> None:
    """The larger sliding friction of two geoms counts, so it is set on floor and soles alike."""
    floor = np.flatnonzero(model.body_weldid[model.geom_bodyid] == 0)
    model.geom_friction[floor, 0] = description.plant.floor_friction
    for name in foot_geoms(description):
        geom = named(model, mujoco.mjtObj.mjOBJ_GEOM, name, description.model_path)
        model.geom_friction[geom, 0] = description.plant.floor_friction


def _set_joints(model: mujoco.MjModel, description: RobotDescription) -> None:
    for name in description.joint_names:
        joint = named(model, mujoco.mjtObj.mjOBJ_JOINT, name, description.model_path)
        dof = model.jnt_dofadr[joint]
        if description.plant.armature is not None:
            model.dof_armature[dof] = description.plant.armature
        if description.plant.joint_friction is not None:
            model.dof_frictionloss[dof] = description.plant.joint_friction
