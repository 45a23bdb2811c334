"""The camera of the web viewer, as it goes to the browsers."""

import mujoco
import pytest
from mujoco.studio.web import state_payload

from hil.view.inner_server import WebPicture

BALL = """<mujoco><worldbody><body><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"""


@pytest.fixture
def picture():
    picture = WebPicture("ball", mujoco.MjModel.from_xml_string(BALL))
    picture.camera.type, picture.camera.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, 1
    yield picture
    picture.close()


def test_the_centre_goes_with_the_body_and_undoes_no_mouse(picture, monkeypatch):
    sent = []
    serialize = state_payload.serialize_state_payload

    def noted(*arguments):
        sent.append((arguments[3].lookat[0], arguments[-1].camera_generation))
        return serialize(*arguments)

    monkeypatch.setattr(state_payload, "serialize_state_payload", noted)
    for x in (0.0, 0.5, 1.0):
        picture.data.qpos[0] = x
        mujoco.mj_forward(picture.model, picture.data)
        picture.publish()
    assert sent == [(0.0, 0), (0.5, 0), (1.0, 0)]
