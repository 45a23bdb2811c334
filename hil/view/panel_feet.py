"""The panel of the soles: corner loads, centre of pressure, and the band it should keep."""

from typing import Any

import numpy as np
from mujoco.studio.dear_imgui import dear_imgui as imgui

from hil.body_motion import CORNERS
from hil.interface import SIDES, Floats
from hil.view import gui
from hil.view.stage import Sole

WIDTH, HEIGHT = 380.0, 230.0
BAND = 0.15
"""The centre of pressure keeps this share of the sole from its edges (seed 000_bd1305a0ae731442:
the stabilizer's band)."""
SCALE = 0.62
"""Share of the panel's height that the longer side of a sole takes."""
LARGEST = 22.0
"""Radius of a corner that carries the whole weight [pixels]."""
SOLE, EDGE, CORNER, CENTRE = (
    (0.25, 0.27, 0.31, 1.0),
    (0.55, 0.57, 0.60, 1.0),
    (0.10, 0.55, 0.95, 0.9),
    (0.95, 0.30, 0.75, 1.0),
)


class FeetPanel:
    """Both soles from above, toes up, left foot on the left."""

    def __init__(self, soles: list[Sole], weight: float) -> None:
        self._halves = [sole.half[:2] for sole in soles]
        self._weight = weight

    def build(self, desk: gui.Desk, row: Any, top: float) -> None:
        """The panel of this frame, below `top`."""
        left = -WIDTH - gui.MARGIN
        with desk.panel("Feet", left, top, WIDTH, HEIGHT) as shown:
            if not shown:
                return
            corner, size = imgui.GetWindowPos(), imgui.GetWindowSize()
            forces = row["frame"]["foot_force"]
            for foot, side in enumerate(SIDES):
                centre = np.array(
                    [corner.x + size.x * (0.27 + 0.46 * foot), corner.y + 0.56 * size.y]
                )
                self._sole(centre, SCALE * size.y, foot, forces[foot])
                valid = int(row["frame"]["foot_valid"][foot].sum())
                words = f"{side} {float(forces[foot].sum()):5.1f} N"
                if foot:
                    imgui.SameLine(0.5 * size.x)
                gui.text(words, gui.PLAIN if valid == 4 else gui.WARN)

    def _sole(self, centre: Floats, length: float, foot: int, forces: Floats) -> None:
        half = self._halves[foot]
        scale = length / (2 * float(half.max()))

        def point(x: float, y: float) -> Any:
            """Of a sole's share: x ahead is up, y left is left."""
            return imgui.Vec2(
                float(centre[0] - y * half[1] * scale), float(centre[1] - x * half[0] * scale)
            )

        paper = imgui.GetWindowDrawList()
        paper.AddRectFilled(point(1, 1), point(-1, -1), gui.packed(SOLE))
        inner = 1 - 2 * BAND
        paper.AddRect(point(inner, inner), point(-inner, -inner), gui.packed(EDGE))
        for (x, y), force in zip(CORNERS.tolist(), forces.tolist(), strict=True):
            share = min(max(force / self._weight, 0.0), 1.0)
            radius = 3.0 + LARGEST * share**0.5
            paper.AddCircleFilled(point(0.8 * x, 0.8 * y), radius, gui.packed(CORNER))
        total = float(forces.sum())
        if total > 0.02 * self._weight:
            cop = (CORNERS * forces[:, None]).sum(axis=0) / total
            outside = bool(np.any(np.abs(cop) > inner))
            paper.AddCircleFilled(
                point(*cop.tolist()), 5.0, gui.packed(gui.BAD if outside else CENTRE)
            )
