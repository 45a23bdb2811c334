"""The panel that steers: start, speeds, heading, pushes, and both ways to stop."""

import math
from dataclasses import dataclass

from mujoco.studio.dear_imgui import dear_imgui as imgui

from hil.steering.words import Word
from hil.timing import stopwatch_ns
from hil.view import gui
from hil.view.live import LiveRun

WIDTH, HEIGHT = 300.0, 262.0
OWN_S = 1.5
"""For so long a slider shows what it was set to; then, what the run is asked for."""
PUSH_S = 0.1
PUSH_MARKS = 0.25
"""The push that the slider begins with, as a share of the largest."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """What may be asked for of this run."""

    forward: float
    backward: float
    sideways: float
    push: float
    """[N]; 0 where nothing can push."""


class WalkPanel:
    """Sliders and buttons; every change is one word for the helm."""

    def __init__(self, bounds: Bounds, live: LiveRun, *, steered: bool) -> None:
        """`steered`: the run walks; otherwise only the stops are offered."""
        self._bounds, self._live, self._steered = bounds, live, steered
        self._own: dict[str, tuple[float, int]] = {}
        self._push = PUSH_MARKS * bounds.push

    def build(self, desk: gui.Desk) -> None:
        """The panel of this frame."""
        with desk.panel("Walk", gui.MARGIN, gui.MARGIN, WIDTH, HEIGHT) as shown:
            if not shown:
                return
            self._stops()
            if self._steered:
                imgui.Separator()
                self._course()
            if self._steered and self._bounds.push > 0.0:
                imgui.Separator()
                self._pushes()

    def _stops(self) -> None:
        half = (WIDTH - 4 * gui.MARGIN) / 2
        if gui.button(
            "SOFTWARE STOP: torque off", WIDTH - 3 * gui.MARGIN, colour=(0.75, 0.12, 0.10, 1.0)
        ):
            self._live.stop("off")
        begun = float(self._live.row["time_s"]) >= 0.0
        if self._steered:
            if gui.button("Walking" if begun else "Start", half, enabled=not begun):
                self._live.say(Word("start"))
            imgui.SameLine()
        if gui.button("Sit down", half):
            self._live.stop("sit")

    def _course(self) -> None:
        reference, bounds = self._live.row["reference"], self._bounds
        self._slider(
            "speed", float(reference["speed"]), bounds.backward, bounds.forward, "%.2f m/s"
        )
        side = bounds.sideways
        self._slider("lateral", float(reference["lateral"]), -side, side, "%.2f m/s")
        heading = math.degrees(float(reference["heading"]))
        self._slider("heading", heading, -180.0, 180.0, "%.0f deg", math.radians(1.0))
        if gui.button("On the spot", WIDTH - 3 * gui.MARGIN):
            self._own.clear()
            self._live.say(Word("halt"))

    def _slider(
        self, name: str, present: float, low: float, high: float, form: str, unit: float = 1.0
    ) -> None:
        """One axis; `unit` is what the word's number is made with."""
        value, until = self._own.get(name, (present, 0))
        if stopwatch_ns() > until:
            value = present
        changed, value = imgui.SliderFloat(name, value, low, high, form)
        if changed:
            self._own[name] = value, stopwatch_ns() + round(OWN_S * 1e9)
            self._live.say(Word(name, (value * unit,)))

    def _pushes(self) -> None:
        _, self._push = imgui.SliderFloat("push", self._push, 0.0, self._bounds.push, "%.1f N")
        quarter = (WIDTH - 6 * gui.MARGIN) / 4
        for label, x, y in (("ahead", 1, 0), ("back", -1, 0), ("left", 0, 1), ("right", 0, -1)):
            if gui.button(label, quarter):
                force = (x * self._push, y * self._push, 0.0)
                self._live.say(Word("push", (*force, PUSH_S)))
            imgui.SameLine()
        imgui.NewLine()
