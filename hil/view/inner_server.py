"""Studio's web viewer behind a socket that nobody else on the machine can open."""

import logging
import shutil
import socket
import tempfile
import zlib
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco.studio import launch_thread, ux, viewer_protocol
from mujoco.studio.dear_imgui import dear_imgui as imgui
from mujoco.studio.implot import implot
from mujoco.studio.web import client_camera, headless_ui, state_payload, web_server

logging.getLogger("WebServer").setLevel(logging.WARNING)  # the terminal is the run's
SIGNATURE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
ASSETS = Path(mujoco.__file__).parent / "studio" / "assets"


class WebPicture(viewer_protocol.Viewer):  # type: ignore[misc]  # Studio is not typed
    """A Studio viewer whose pictures are made in browsers.

    Studio's own `WebViewer` binds every interface. This one gives the same server a Unix socket in
    a folder of its user alone (0700), `address`, for `hil.view.gate` to stand before.
    """

    def __init__(self, title: str, model: Any) -> None:
        endpoint, _ = launch_thread.make_thread_endpoints()
        super().__init__(viewer_protocol.ViewerConfig(title=title), endpoint, model=model)
        self._folder = Path(tempfile.mkdtemp(prefix="stride-view-"))
        self.address = self._folder / "http"
        self._http = socket.socket(socket.AF_UNIX)
        self._http.bind(str(self.address))
        self._bridge = web_server.bind_loopback_socket()
        self._ui = headless_ui.HeadlessUi(title, self._bridge.getsockname()[1], str(ASSETS))
        use_contexts(self._ui.get_context(), self._ui.get_implot_context())
        bundle = state_payload.serialize_model_bundle(self.model)
        self._crc32 = zlib.crc32(bundle)
        self._server = web_server.WebServer(self._http, self._bridge, mjb_data=bundle)
        self._server.start()
        self._client_camera = client_camera.ClientCameraSync()

    def prepare_next_frame(self) -> bool:
        """Whether a browser shows the panels; returns at its pace, or after a short wait."""
        frame = bool(self._ui.new_frame())
        camera = self._server.take_client_camera()
        if camera is not None:
            self._client_camera.apply(self.camera, camera)
        return frame

    def sync(self) -> None:
        """Send the panels and the scene to the browsers."""
        self.publish()
        self._ui.end_frame()

    def publish(self) -> None:
        """Send the scene alone, for those who only watch."""
        self._follow()
        state = np.empty(mujoco.mj_stateSize(self.model, SIGNATURE))
        mujoco.mj_getState(self.model, self.data, state, SIGNATURE)
        io = imgui.GetIO()
        inputs = state_payload.ViewerInputState(
            mouse_focus=not io.WantCaptureMouse,
            camera_index=self.camera_index,
            keyboard_focus=not io.WantCaptureKeyboard,
            camera_generation=self._client_camera.update_generation(self.camera),
        )
        payload = state_payload.serialize_state_payload(
            self._crc32,
            SIGNATURE,
            state.tobytes(),
            self.camera,
            self.perturb,
            self.vis_options,
            self.model,
            list(self.render_flags.flags),
            self.extra_geoms[: state_payload.MAX_EXTRA_GEOMS],
            inputs,
        )
        self._server.update_state(payload)

    def _follow(self) -> None:
        """Keep the camera's centre at the tracked body, for browsers that come later.

        A browser moves its own tracking camera by what the body moves, from the centre it was given
        first: without this that is where the robot stood when the view began. Those who are there
        are not to take it for a change by the viewer, which would undo what their mouse did.
        """
        sync = self._client_camera
        generation = sync.generation
        self.camera.lookat[:] = self.data.subtree_com[self.camera.trackbodyid]
        sync.update_generation(self.camera)
        sync.generation = generation

    def close(self) -> None:
        """Tell the browsers why, and stop serving."""
        self._server.stop(self.exit_reason)
        self._http.close()
        self._bridge.close()
        shutil.rmtree(self._folder, ignore_errors=True)
        super().close()

    def get_drop_file(self) -> str:
        """Nothing may be dropped onto a run."""
        return ""

    def upload_image(self, tex_id: int, img: Any, width: int, height: int, bpp: int) -> int:
        """An image for the panels."""
        return int(self._ui.upload_image(tex_id, img, width, height, bpp))


def use_contexts(context: int, plots: int) -> None:
    """Let Studio's bindings build their panels in these contexts."""
    imgui.SetCurrentContext(context)
    ux.set_imgui_context(context)
    ux.set_implot_context(plots)
    implot.set_imgui_context(context)
    implot.set_implot_context(plots)
