"""What is true of one virtual servo, for whoever compares it with what was identified."""

import mujoco
import numpy as np

from sim_backends.plant import Plant


def hidden_servo(plant: Plant, joint: int) -> dict[str, float]:
    """Constants of a joint's servo as the seed drew them, by name, in SI.

    Raises IndexError for a joint that is not there; empty for a torque robot.
    """
    servos, hidden = plant.servos, plant.hidden
    if servos is None:
        return {}
    rotor = plant.rotor_dof(joint)
    return {
        "torque_constant": float(servos.motors.torque_constant[joint]),
        "resistance": float(servos.motors.resistance[joint]),
        "gain_divisor": float(servos.motors.gain_divisor[joint]),
        "armature": float(plant.model.dof_armature[rotor]),
        "friction": float(plant.model.dof_frictionloss[rotor]),
        "viscous": float(plant.model.dof_damping[rotor]),
        "backlash": float(hidden.backlash[joint]),
    }


def joint_inertia(plant: Plant, joint: int) -> float:
    """Inertia at a joint with all others locked, rotor included [kg·m²]."""
    model, data = plant.model, plant.data
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    name = plant.description.joint_names[joint]
    own = int(model.joint(name).dofadr[0])
    rotor = plant.rotor_dof(joint)
    return float(full[own, own] + (full[rotor, rotor] if rotor != own else 0.0))
