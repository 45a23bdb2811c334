"""Which joints of the two legs mirror each other, and with what sign."""

import mujoco
import numpy as np

from hil.description import RobotDescription


def mirrored_pairs(description: RobotDescription) -> list[tuple[str, str, int]]:
    """Left joint, right joint, and the sign with which they are alike in a symmetric pose.

    A turn about the axis a mirrors, in the sagittal plane y = 0, to one about (−a_x, a_y, −a_z):
    the sign is that of its product with the other leg's axis, both in the model's zero pose.
    """
    model = mujoco.MjModel.from_xml_path(str(description.model_path))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    pairs = []
    for left in description.joint_names:
        right = left.replace("left", "right", 1)
        if left.startswith("left_") and right in description.joint_names:
            a, b = (data.xaxis[model.joint(name).id] for name in (left, right))
            sign = 1 if float(np.dot(a * (-1, 1, -1), b)) > 0 else -1
            pairs.append((left, right, sign))
    return pairs
