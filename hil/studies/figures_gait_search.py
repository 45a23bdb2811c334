"""The figure of `stride study gait`: the cost over the iterations, and what was changed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from hil.figure_style import BODY, LEFT, RIGHT, STYLE


@dataclass(frozen=True, slots=True)
class Move:
    """What a search made of one variable."""

    name: str
    start: float
    best: float
    spreads: float
    """Change in units of the first standard deviation."""


def draw_gait_search(
    title: str, history: Sequence[float], moves: Sequence[Move], path: Path
) -> None:
    """Left the lowest cost so far, which begins with the start's, right how far variables moved."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, max(3.0, 1.2 + 0.2 * len(moves))), layout="constrained")
        cost, change = figure.subplots(1, 2)
        cost.plot(range(len(history)), history, color=BODY, drawstyle="steps-post")
        cost.set(title="Lowest cost so far", xlabel="iteration")
        cost.xaxis.get_major_locator().set_params(integer=True)
        if max(history) > 100.0 * min(history) > 0.0:
            cost.set_yscale("log")
        for row, move in enumerate(reversed(moves)):
            way = move.spreads
            change.barh(row, way, color=RIGHT if way > 0 else LEFT)
            change.annotate(
                f" {move.start:.3g} → {move.best:.3g} ", (way, row), fontsize=7, va="center",
                ha="left" if way >= 0 else "right",
            )  # fmt: skip
        change.set_yticks(range(len(moves)), [move.name for move in reversed(moves)])
        change.set_axisbelow(True)
        change.margins(x=0.4)
        change.set(title="Start and best", xlabel="change in first steps of the search")
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)
