"""The web screen: Studio's server behind our gate."""

from typing import Any

from mujoco.studio import ux

from hil.timing import stopwatch_ns
from hil.view.gate import Gate
from hil.view.inner_server import WebPicture

SILENCE_S = 1.0
"""A page sends its input with every frame; one that is hidden or gone is silent."""


KNOCK_NS = 500_000_000
"""So often Studio is asked whether a page wants panels, although none was heard."""


class WebScreen(WebPicture):
    """Pictures and panels for browsers on this machine, steering for those with the token."""

    def __init__(self, title: str, model: Any) -> None:
        super().__init__(title, model)
        ux.setup_theme(ux.GuiTheme.DARK)
        self._gate = Gate(self.address)
        self._heard = self._asked_ns = 0
        self._gate.start()
        self.place = f"steer: {self._gate.steer_url}\nwatch: {self._gate.watch_url}"

    def prepare_next_frame(self) -> bool:
        """New panels for a page that has drawn the last ones: a slow one would see old ones."""
        now_ns = stopwatch_ns()
        if self._gate.heard == self._heard and now_ns < self._asked_ns + KNOCK_NS:
            return False
        self._heard, self._asked_ns = self._gate.heard, now_ns
        return super().prepare_next_frame()

    def hand_there(self) -> bool:
        """Whether a page that may steer is shown somewhere."""
        return stopwatch_ns() * 1e-9 - self._gate.heard_s < SILENCE_S
