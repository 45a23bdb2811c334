"""The panel that says how it goes: phase, speed, severity, and the supervisor's reasons."""

from typing import Any

import numpy as np
from mujoco.studio.dear_imgui import dear_imgui as imgui

from hil.safety.severity import Severity
from hil.view import gui
from hil.view.live import LiveRun
from hil.view.panel_walk import HEIGHT as ABOVE
from hil.view.panel_walk import WIDTH

HEIGHT = 210.0
SMOOTHING = 0.02
"""Share of a new frame in the speed that is shown."""
COLOURS = {Severity.OK: gui.GOOD, Severity.WARN: gui.WARN}
SHOWN = 4
"""The newest reasons that fit."""


class StatePanel:
    """What a person wants to know first."""

    def __init__(self, rung: str, live: LiveRun, *, waits: bool, truth: bool) -> None:
        """`waits`: the walk begins when it is told to; `truth`: a simulation knows it."""
        self._rung, self._live, self._waits, self._known = rung, live, waits, truth
        self._speed = 0.0
        self.source = "estimate"
        """What drives the model: the controller's `estimate`, or the `truth`."""

    def build(self, desk: gui.Desk, motion: Any) -> None:
        """The panel of this frame; `motion` is the estimate or the truth."""
        top = ABOVE + 2 * gui.MARGIN
        with desk.panel("State", gui.MARGIN, top, WIDTH, HEIGHT) as shown:
            if shown:
                self._progress(motion)
                self._reasons()

    def _progress(self, motion: Any) -> None:
        row = self._live.row
        velocity = float(np.linalg.norm(motion["com_velocity"][:2]))
        self._speed += SMOOTHING * (velocity - self._speed)
        severity = Severity(int(row["safety"]["severity"]))
        gui.text(f"{self._rung}: {self._phase(row)}", gui.DIM)
        gui.text(severity.name, COLOURS.get(severity, gui.BAD))
        time_s = max(0.0, float(row["time_s"]))
        gui.text(f"t {time_s:6.1f} s   steps {int(row['status']['steps'])}")
        gui.text(f"speed {self._speed:5.2f} m/s   height {float(motion['com'][2]):.3f} m")
        if self._known:
            _, true = imgui.Checkbox("draw the truth", self.source == "truth")
            self.source = "truth" if true else "estimate"

    def _phase(self, row: Any) -> str:
        if self._live.over:
            return "over"
        if int(row["safety"]["severity"]) >= Severity.SOFT_STOP:
            return "on the way down"
        if float(row["time_s"]) < 0.0:
            return "stands, waits for Start" if self._waits else "starts"
        return "walks" if row["status"]["walking"] else "stands"

    def _reasons(self) -> None:
        faults = self._live.facts.get("faults", [])
        for fault in faults[-SHOWN:]:
            colour = gui.WARN if fault["reaction"] == "none" else gui.BAD
            gui.text(f"{fault['time_s']:.2f} s {fault['source']}: {fault['name']}", colour)
        if not faults:
            gui.text("no reason to stop", gui.DIM)
