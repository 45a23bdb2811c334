"""The native screen: Studio's window on this machine's display."""

from typing import Any

from mujoco.studio import launch_thread, native_viewer, ux, viewer_protocol
from mujoco.studio.dear_imgui import dear_imgui as imgui

WIDTH, HEIGHT = 1400, 850
GRAPHICS = "opengl_software"
"""Through pixels: in 4.0.0 the mode that draws on the window itself has no target to draw on."""


class NativeScreen(native_viewer.NativeViewer):  # type: ignore[misc]  # Studio is not typed
    """A window; closing it ends the view and nothing else."""

    def __init__(self, title: str, model: Any) -> None:
        config = viewer_protocol.ViewerConfig(title=title, width=WIDTH, height=HEIGHT, gfx=GRAPHICS)
        endpoint, _ = launch_thread.make_thread_endpoints()
        super().__init__(config, endpoint, model=model)
        ux.setup_theme(ux.GuiTheme.DARK)
        self.place = "a window on this display"

    def sync(self) -> None:
        """Move the camera as the mouse does, and draw."""
        if not imgui.GetIO().WantCaptureMouse:
            ux.move_camera_with_mouse(self.model, self.camera, fly_camera=False)
        super().sync()

    def publish(self) -> None:
        """A window has no spectators."""

    def hand_there(self) -> bool:
        """Whether the window has been open in the last moment."""
        return bool(self.is_running())
