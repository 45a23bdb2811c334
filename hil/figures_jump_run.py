"""The picture of a jump's run: key frames, path with its forces, support and balance, load.

The pictures of chapter 4 of seed 004_2880d7939e94ed85, of a jump that was done.
"""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.convex_hull import convex_hull
from hil.description import RobotDescription
from hil.figure_style import BODY, LEFT, LIMIT, RIGHT, STYLE
from hil.figures_jump import draw_com_path, draw_force_arrows, draw_jump_strip, draw_support
from hil.interface import GRAVITY, SIDES, Floats
from hil.jump_report import JumpReview, Plan, airborne, flight_of, foot_loads
from hil.trace import Trace

ARROWS = 7
"""Of the ground's force in the push, and as many in the landing."""
ARROW_LENGTH = 0.12
"""Of a force as large as the weight [m]."""
IN_THE_AIR = ("take-off", "apex")
LEAST_STEP = 0.02
"""Lower soles stand on the floor [m]."""
SETTLING_S = 0.3
"""Part of the landing that the path and its arrows show [s]."""


def draw_jump_run(
    trace: Trace, description: RobotDescription, meta: dict[str, Any], jump: JumpReview, path: Path
) -> None:
    """Write the picture of a jump to a file whose suffix says the format."""
    plan, flight = jump.plan(), flight_of(trace)
    mass, gravity = meta["weight_n"] / GRAVITY, description.plant.gravity or GRAVITY
    moments = key_moments(trace, flight)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(12, 10), layout="constrained")
        grid = figure.add_gridspec(3, 4, height_ratios=(1.25, 1.25, 0.8))
        strip = figure.add_subplot(grid[0, :])
        _strip(strip, trace, description, moments, jump)
        if plan is not None:
            _path(figure.add_subplot(grid[1, :2]), trace, plan, flight, mass, gravity)
        begin, end = (len(trace) - 1,) * 2 if flight is None else flight
        before = max(begin - 1, 0)
        name = "through the run" if flight is None else "until take-off"
        _support(figure.add_subplot(grid[1, 2]), trace, jump, (0, before), name)
        if flight is not None:
            landed = (min(end, len(trace) - 1), len(trace) - 1)
            _support(figure.add_subplot(grid[1, 3]), trace, jump, landed, "from touch-down on")
        _load(figure.add_subplot(grid[2, :]), trace, flight, mass * gravity)
        head = f"{meta['robot']}, {meta['rung']}, {meta['rate_hz']} Hz, seed {meta['seed']}: "
        figure.suptitle(head + _outcome(trace, flight), x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=110)


def key_moments(trace: Trace, flight: tuple[int, int] | None) -> dict[int, str]:
    """Ticks of the strip, in order, and what they are; a hop that never left has no flight."""
    height, last = trace.com[:, 2], len(trace) - 1
    moments = {0: "start"}
    if flight is None:
        moments[int(height.argmin())] = "lowest"
    else:
        begin, end = flight
        landing = min(end, last)
        moments[int(height[: begin + 1].argmin())] = "crouch"
        moments[begin] = "take-off"
        moments[begin + int(height[begin:end].argmax())] = "apex"
        moments[landing] = "touch-down"
        moments[landing + int(height[landing:].argmin())] = "lowest"
    moments[last] = "end"
    return dict(sorted(moments.items()))


def ground_force(trace: Trace, mass: float, gravity: float) -> Floats:
    """Force of the ground from the motion of the centre of mass [N], (T, 3): m·(a − g⃗).

    The acceleration is the slope of its velocity over two ticks; air and water are left out. It is
    0 where no foot bears anything: limbs that are thrown leave a ripple in that slope.
    """
    force: Floats = np.gradient(trace.com_velocity, trace.time_s, axis=0) * mass
    force[:, 2] += mass * gravity
    force[airborne(trace)] = 0.0
    return force


def _outcome(trace: Trace, flight: tuple[int, int] | None) -> str:
    if flight is None:
        return "never left the ground"
    begin, end = flight
    airtime = (end - begin) * float(np.mean(np.diff(trace.time_s)))
    x, y, _ = (trace.com[-1] - trace.com[0]).tolist()
    return f"{airtime:.3f} s in the air, {x:.2f} m forward, {y:.2f} m to the left"


def _strip(
    axes: Axes,
    trace: Trace,
    description: RobotDescription,
    moments: dict[int, str],
    jump: JumpReview,
) -> None:
    """Outlines, each with the step under its feet if it stands on one."""
    ticks = list(moments)
    labels = [f"{trace.time_s[tick]:.2f} s\n{name}" for tick, name in moments.items()]
    bases = trace.base_position[ticks]
    spacing = 0.75 * float(bases[:, 2].max())
    draw_jump_strip(
        axes, description, bases, trace.base_orientation[ticks], trace.joint_position[ticks],
        labels, spacing,
    )  # fmt: skip
    for place, tick in enumerate(ticks):
        step = float(jump.soles(trace, tick)[..., 2].min())
        if step > LEAST_STEP and moments[tick] not in IN_THE_AIR:
            sides = np.array((-0.4, 0.4)) * spacing + place * spacing
            axes.plot(sides, (step, step), color=LIMIT, linewidth=1.0, zorder=0)
    axes.set_title("key frames, from the right")


def _path(
    axes: Axes,
    trace: Trace,
    plan: Plan,
    flight: tuple[int, int] | None,
    mass: float,
    gravity: float,
) -> None:
    """Along the jump and up: what was planned and what became of it, with the ground's force."""
    way = (plan.landing_feet - plan.feet)[:2]
    length = float(np.hypot(*way))
    along = way / length if length > 0.0 else np.array((1.0, 0.0))

    def from_the_side(points: Floats) -> Floats:
        level = points[:, :2] @ along
        return np.column_stack((level, np.zeros(len(points)), points[:, 2]))

    times = np.linspace(0.0, plan.path.duration, 80)
    until = len(trace)
    shown: list[int] = []
    if flight is not None:
        begin, end = flight
        settled = int(np.searchsorted(trace.time_s, trace.time_s[end - 1] + SETTLING_S))
        until = min(settled + 1, len(trace))
        low = int(trace.com[: begin + 1, 2].argmin())
        push = np.linspace(low, max(begin - 2, low), ARROWS)
        landing = np.linspace(min(end + 1, until - 1), until - 1, ARROWS)
        shown = np.concatenate((push, landing)).astype(int).tolist()
    planned = plan.path.position(times)
    if flight is None:  # planned on a floor at 0, for a robot at 0
        planned = planned + (trace.com[0] - planned[0]) * (1.0, 1.0, 0.0)
    draw_com_path(axes, from_the_side(planned), from_the_side(trace.com[:until]))
    forces = from_the_side(ground_force(trace, mass, gravity)[shown])
    length_of_one = ARROW_LENGTH / (mass * gravity)
    draw_force_arrows(axes, from_the_side(trace.com[shown]), forces, length_of_one)
    axes.margins(0.1, 0.2)
    axes.set(title="centre of mass, force of the ground", xlabel="along the jump [m]")


def _support(axes: Axes, trace: Trace, jump: JumpReview, span: tuple[int, int], name: str) -> None:
    """The soles' hull at the end of a span of ticks, and the centre of mass through it."""
    first, last = span
    vertices = convex_hull(jump.soles(trace, last).reshape(-1, 3)[:, :2])
    draw_support(axes, vertices, trace.com[first : last + 1 : 4])
    axes.set_title(f"support {name}", pad=22.0)


def _load(axes: Axes, trace: Trace, flight: tuple[int, int] | None, weight: float) -> None:
    """What each foot carries; grey while both are in the air."""
    for load, side, colour in zip(foot_loads(trace).T, SIDES, (LEFT, RIGHT), strict=True):
        axes.plot(trace.time_s, load, color=colour, linewidth=1.0, label=side)
    axes.axhline(weight, color=LIMIT, linestyle=":", linewidth=1.0)
    axes.text(trace.time_s[-1], weight, "weight ", fontsize=8, color=LIMIT, va="bottom", ha="right")
    if flight is not None:
        begin, end = flight
        times = trace.time_s[[begin, end - 1]]
        axes.axvspan(*times.tolist(), color=BODY, alpha=0.12, linewidth=0, label="in the air")
    axes.set(title="load of each foot", xlabel="time [s]", ylabel="[N]")
    axes.margins(x=0)
    axes.legend(loc="upper right", ncols=3)
