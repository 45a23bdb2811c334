"""The servos of a plant: put together from what its description and its seed say."""

import mujoco
import numpy as np

from hil.description import RobotDescription
from hil.interface import Floats, Ints
from hil.servo import COUNTS_PER_RADIAN, JOINT_MODES, MotorParameters
from hil.twin import Supply
from sim_backends.draws import HiddenValues
from sim_backends.gear_friction import GearFriction
from sim_backends.pack_supply import PackSupply
from sim_backends.servo_firmware import senses_supply
from sim_backends.servo_physics import MotorPort, ServoPhysics


def make_servos(
    description: RobotDescription,
    supply: Supply,
    motors: MotorParameters,
    hidden: HiddenValues,
    encoder_phase: Floats,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    rotor_dofs: slice | Ints,
) -> ServoPhysics:
    """Servos on the dcmotors of a model, torque off.

    `motors` has this robot's true constants; `encoder_phase` is where in a count each encoder's
    zero lies, (n,) [counts].
    """
    zero = motors.direction * hidden.joint_zero * COUNTS_PER_RADIAN
    servos = ServoPhysics(
        motors,
        PackSupply(supply.voltage, hidden.supply_resistance, supply.current_limit),
        model.opt.timestep,
        MotorPort(model.actuator_gainprm[:, 0], data.ctrl),
        encoder_phase + zero,
        [senses_supply(joint.servo or "") for joint in description.joints],
    )
    for firmware, joint in zip(servos.firmware, description.joints, strict=True):
        firmware.mode = JOINT_MODES[joint.mode]
    plant = description.plant
    if plant.stribeck_friction or plant.load_friction:
        limits = model.dof_frictionloss
        servos.friction = GearFriction(plant, motors.torque_constant, limits, rotor_dofs)
    return servos


def encoder_phase(seed: int, n: int) -> Floats:
    """Where in a count the encoders of the robot `seed` have their zeros, (n,) [counts]."""
    return np.random.default_rng(seed).uniform(-0.5, 0.5, n)
