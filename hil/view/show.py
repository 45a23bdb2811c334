"""The view's own loop: newest tick to picture and panels, until the run or the window ends."""

from typing import Any, Protocol

import mujoco

from hil.description import RobotDescription
from hil.steering.words import Word
from hil.timing import pause, stopwatch_ns
from hil.view import gui
from hil.view.live import LiveRun
from hil.view.overlay import Overlay
from hil.view.panel_bus import BusPanel
from hil.view.panel_feet import FeetPanel
from hil.view.panel_joints import JointPanel
from hil.view.panel_state import HEIGHT as STATE_HEIGHT
from hil.view.panel_state import StatePanel
from hil.view.panel_walk import HEIGHT as WALK_HEIGHT
from hil.view.panel_walk import Bounds, WalkPanel
from hil.view.stage import AZIMUTH, ELEVATION, Stage

FRAME_S = 1.0 / 30.0
"""Shortest time of a frame: the run's processor has more to do than pictures."""
ALIVE_S = 0.25
"""How often the run hears that a hand is there."""
LINGER_S = 0.5
"""How long the last picture is sent after the run's end."""


class Screen(Protocol):
    """A Studio viewer of ours."""

    model: Any
    data: Any
    camera: Any
    extra_geoms: list[Any]

    def is_running(self) -> bool:
        """Whether it was not closed."""
        ...

    def prepare_next_frame(self) -> bool:
        """Begin a frame; whether panels are shown."""
        ...

    def sync(self) -> None:
        """End the frame."""
        ...

    def publish(self) -> None:
        """Send the scene without panels."""
        ...

    def hand_there(self) -> bool:
        """Whether whoever may steer was there in the last moment."""
        ...


class Show:
    """Draws one run on one screen."""

    def __init__(
        self, job: dict[str, Any], description: RobotDescription, screen: Screen, live: LiveRun
    ) -> None:
        self._screen, self._live = screen, live
        self._stage = stage = Stage(description, screen.model)
        self._overlay = Overlay(stage, screen.extra_geoms)
        steered = bool(job["steered"])
        self._walk = WalkPanel(Bounds(**job["bounds"]), live, steered=steered)
        self._state = StatePanel(job["rung"], live, waits=steered, truth=job["truth"])
        limits = [joint.torque_limit for joint in description.joints]
        heat = description.safety.temperature_limit
        self._joints = JointPanel(description.joint_names, limits, heat)
        self._feet = FeetPanel(stage.soles, stage.weight)
        self._bus = BusPanel(job["rate_hz"], live)
        camera = screen.camera
        camera.type, camera.trackbodyid = mujoco.mjtCamera.mjCAMERA_TRACKING, stage.root
        camera.distance, camera.azimuth, camera.elevation = 5.5 * stage.height, AZIMUTH, ELEVATION
        self._alive_ns = 0
        self._desk = gui.Desk()

    def run(self) -> None:
        """Until the run is over and its last tick was shown, or the screen is closed."""
        end_ns: int | None = None
        while self._screen.is_running():
            began_ns = stopwatch_ns()
            self._frame()
            if self._live.over and end_ns is None:
                end_ns = stopwatch_ns() + round(LINGER_S * 1e9)
            if end_ns is not None and stopwatch_ns() > end_ns:
                return
            pause(max(0.0, FRAME_S - (stopwatch_ns() - began_ns) * 1e-9))

    def _frame(self) -> None:
        screen, live = self._screen, self._live
        panels = screen.prepare_next_frame()
        if not screen.is_running():
            return
        if live.update():
            motion = live.row[self._state.source]
            self._stage.place(screen.model, screen.data, motion)
            self._overlay.draw(screen.data, live.row, motion)
        if panels:
            self._panels()
            screen.sync()
        else:
            screen.publish()
        if screen.hand_there() and stopwatch_ns() > self._alive_ns:
            self._alive_ns = stopwatch_ns() + round(ALIVE_S * 1e9)
            live.say(Word("alive"))

    def _panels(self) -> None:
        row = self._live.row
        desk = self._desk
        desk.measure()
        self._walk.build(desk)
        self._state.build(desk, row[self._state.source])
        self._joints.build(desk, row)
        below = self._joints.height + 2 * gui.MARGIN
        self._feet.build(desk, row, below)
        self._bus.build(desk, WALK_HEIGHT + STATE_HEIGHT + 3 * gui.MARGIN)
