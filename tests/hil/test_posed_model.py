"""A model at a recorded pose: base and joints are where they were told to be."""

import numpy as np

from hil.posed_model import PosedModel
from hil.robot_files import load_robot


def test_a_pose_moves_the_base_and_the_joints_that_it_names():
    minibiped = load_robot("minibiped")
    body, pose = PosedModel(minibiped), np.array(minibiped.start_position)
    sole = body.model.geom(minibiped.feet["left"].sole).id
    body.place(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), pose)
    foot = body.data.geom_xpos[sole].copy()
    half = np.sqrt(0.5)
    body.place(np.array([1.0, 2.0, 0.5]), np.array([half, 0.0, 0.0, half]), pose)
    turned = (1.0 - foot[1], 2.0 + foot[0], 0.5 + foot[2])
    np.testing.assert_allclose(body.data.geom_xpos[sole], turned, atol=1e-12)
    pose[minibiped.joint_names.index("left_knee")] += 0.3
    body.place(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), pose)
    assert body.data.geom_xpos[sole, 0] < foot[0] - 0.01
