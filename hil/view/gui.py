"""Pieces of Dear ImGui that more than one panel uses."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from mujoco.studio.dear_imgui import dear_imgui as imgui

Colour = tuple[float, float, float, float]
GOOD: Colour = (0.35, 0.75, 0.40, 1.0)
WARN: Colour = (0.95, 0.65, 0.15, 1.0)
BAD: Colour = (0.95, 0.30, 0.25, 1.0)
PLAIN: Colour = (0.90, 0.91, 0.93, 1.0)
DIM: Colour = (0.60, 0.62, 0.66, 1.0)
MARGIN = 8.0


@dataclass(slots=True)
class Desk:
    """The screen that panels lie on. They are put in place anew whenever its size changes."""

    width: float = 0.0
    height: float = 0.0
    _place: Any = imgui.Cond.Always

    def measure(self) -> None:
        """At the beginning of a frame."""
        size = imgui.GetIO().DisplaySize
        changed = (self.width, self.height) != (size.x, size.y)
        self.width, self.height = float(size.x), float(size.y)
        self._place = imgui.Cond.Always if changed else imgui.Cond.FirstUseEver

    @contextmanager
    def panel(self, title: str, x: float, y: float, width: float, height: float) -> Iterator[bool]:
        """A window at this place; negative x and y count from right and bottom. Whether it is
        open.
        """
        left = x if x >= 0.0 else self.width + x
        top = y if y >= 0.0 else self.height + y
        imgui.SetNextWindowPos(imgui.Vec2(left, top), self._place)
        imgui.SetNextWindowSize(imgui.Vec2(width, height), self._place)
        try:
            yield bool(imgui.Begin(title)[0])
        finally:
            imgui.End()


def text(words: str, colour: Colour = PLAIN) -> None:
    """A line of text."""
    imgui.TextColored(imgui.Vec4(*colour), words)


def button(label: str, width: float, *, enabled: bool = True, colour: Colour | None = None) -> bool:
    """Whether it was pressed."""
    if colour is not None:
        imgui.PushStyleColor(imgui.Col.Button, imgui.Vec4(*colour))
    imgui.BeginDisabled(not enabled)
    pressed = bool(imgui.Button(label, imgui.Vec2(width, 0.0)))
    imgui.EndDisabled()
    if colour is not None:
        imgui.PopStyleColor(1)
    return pressed


@contextmanager
def table(name: str, columns: Sequence[str]) -> Iterator[bool]:
    """A table with a header; whether it is seen."""
    flags = int(imgui.TableFlags.RowBg) | int(imgui.TableFlags.SizingFixedFit)
    shown = bool(imgui.BeginTable(name, len(columns), flags))
    if shown:
        for column in columns:
            imgui.TableSetupColumn(column)
        imgui.TableHeadersRow()
    try:
        yield shown
    finally:
        if shown:
            imgui.EndTable()


def cells(values: Sequence[tuple[str, Colour]]) -> None:
    """One row of a table."""
    imgui.TableNextRow()
    for words, colour in values:
        imgui.TableNextColumn()
        text(words, colour)


def packed(colour: Colour) -> int:
    """A colour as drawing lists take it."""
    return int(imgui.ColorConvertFloat4ToU32(imgui.Vec4(*colour)))
