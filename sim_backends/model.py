"""The plant's MuJoCo model: a robot's MJCF with the plant's own actuators and settings."""

import mujoco
import numpy as np

from hil.clock import substeps_per_tick
from hil.description import RobotDescription
from hil.errors import InputError
from hil.interface import Ints
from hil.servo import MotorParameters
from sim_backends.ball import add_ball
from sim_backends.draws import HiddenValues
from sim_backends.gear_train import ROTOR, add_rotor
from sim_backends.platform import add_platform
from sim_backends.uneven_floor import add_feelers

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
    description: RobotDescription,
    rate_hz: int,
    motors: MotorParameters | None,
    hidden: HiddenValues,
) -> mujoco.MjModel:
    """Compile the robot's MJCF as a plant that takes N substeps a tick.

    A servo robot gets one `dcmotor` a joint, fed with the terminal voltage (MuJoCo manual,
    actuator/dcmotor), on a rotor of its own where the joint has backlash; actuators of the MJCF
    itself are dropped, since a backend drives the joints. Raises InputError when the MJCF cannot
    be read or lacks a part that is named.
    """
    _keep_log_off_disk()
    spec = _read(description)
    _require_parts(spec, description)
    for actuator in list(spec.actuators):
        spec.delete(actuator)
    if motors is not None:
        _add_motors(spec, description, motors, hidden)
    _add_support(spec, description.root)
    if description.plant.ball:
        add_ball(spec)
    if description.plant.platform is not None:
        add_platform(spec, description.plant.platform)
    if description.imu is not None:
        spec.add_sensor(
            name=ACCELEROMETER,
            type=mujoco.mjtSensor.mjSENS_ACCELEROMETER,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=description.imu.site,
        )
    if any(hidden.floor_height):
        add_feelers(spec, foot_geoms(description), description.model_path)
    model = _compile(spec, description)
    _configure(model, description, rate_hz, hidden)
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
        ("geom", foot_geoms(description), spec.geoms),
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
    spec: mujoco.MjSpec,
    description: RobotDescription,
    motors: MotorParameters,
    hidden: HiddenValues,
) -> None:
    for j, name in enumerate(description.joint_names):
        gap = float(hidden.backlash[j])
        target = add_rotor(spec, name, gap) if gap > 0.0 else name
        actuator = spec.add_actuator(name=name, target=target, trntype=mujoco.mjtTrn.mjTRN_JOINT)
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


def motor_joints(model: mujoco.MjModel, description: RobotDescription) -> list[int]:
    """Ids of the joints on which the motors act: rotors where there is backlash."""
    names = description.joint_names
    rotors = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name + ROTOR) for name in names]
    joints = [named(model, mujoco.mjtObj.mjOBJ_JOINT, n, description.model_path) for n in names]
    return [j if rotor < 0 else rotor for j, rotor in zip(joints, rotors, strict=True)]


def _configure(
    model: mujoco.MjModel, description: RobotDescription, rate_hz: int, hidden: HiddenValues
) -> None:
    option = model.opt
    option.timestep = 1.0 / (rate_hz * substeps(description, rate_hz))
    # MuJoCo 4.0.0 solves sparse Jacobians wrongly (mujoco issue 3767); robots here are small.
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    if description.plant.gravity is not None:
        option.gravity[:] = (0.0, 0.0, -description.plant.gravity)
    for bit in _DISABLED:
        option.disableflags |= int(bit)
    _set_contacts(model, description)
    _set_joints(model, description, hidden)
    root = named(model, mujoco.mjtObj.mjOBJ_BODY, description.root, description.model_path)
    model.body_mass[root] *= description.plant.mass_scale
    model.body_inertia[root] *= description.plant.mass_scale
    mujoco.mj_setConst(model, mujoco.MjData(model))


def _set_contacts(model: mujoco.MjModel, description: RobotDescription) -> None:
    """Friction and stiffness of everything that feet and floor touch with.

    The larger sliding friction of two geoms counts and their time constants are averaged, so both
    are set on floor and feet alike. A time constant T is a stiffness ∝ 1/T² at the same damping
    ratio (MuJoCo manual, Solver parameters); a negative one is the stiffness itself.
    """
    plant = description.plant
    feet = [
        named(model, mujoco.mjtObj.mjOBJ_GEOM, name, description.model_path)
        for name in foot_geoms(description)
    ]
    touching = np.isin(model.geom_bodyid, model.geom_bodyid[feet])
    touching |= model.body_weldid[model.geom_bodyid] == 0
    model.geom_friction[touching, 0] = plant.floor_friction
    direct = model.geom_solref[:, 0] < 0.0
    model.geom_solref[touching & ~direct, 0] /= np.sqrt(plant.pad_stiffness)
    model.geom_solref[touching & direct, 0] *= plant.pad_stiffness
    model.geom_solref[touching & direct, 1] *= np.sqrt(plant.pad_stiffness)


def _set_joints(model: mujoco.MjModel, description: RobotDescription, hidden: HiddenValues) -> None:
    """Rotor inertia and friction of the gears, on the motor's side of a gap."""
    joints = [
        named(model, mujoco.mjtObj.mjOBJ_JOINT, name, description.model_path)
        for name in description.joint_names
    ]
    outer = model.jnt_dofadr[joints]
    inner = model.jnt_dofadr[motor_joints(model, description)]
    for values, drawn in (
        (model.dof_armature, hidden.armature),
        (model.dof_frictionloss, hidden.joint_friction),
        (model.dof_damping, None),
    ):
        nominal = values[outer]
        values[outer[outer != inner]] = 0.0
        values[inner] = nominal if drawn is None else np.where(np.isnan(drawn), nominal, drawn)
    model.dof_damping[inner] += description.plant.viscous_friction


def selection(addresses: Ints) -> slice | Ints:
    """A slice where the addresses are a run, so that reading them makes a view, not a copy."""
    start = int(addresses[0])
    if np.array_equal(addresses, np.arange(start, start + addresses.size)):
        return slice(start, start + addresses.size)
    return addresses
