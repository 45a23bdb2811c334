"""Ranges of gains by rate and joint, with the closed-form ceiling and the stored sets.

Figures 2 and 3 of seed 000_bd1305a0ae731442.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil.description import RobotDescription
from hil.figure_style import BODY, LEFT, RIGHT, STYLE
from hil.joint_gains import GainSet
from hil.studies.ceiling_rows import ALL
from hil.studies.gain_sets import sum_of, total_of
from hil.studies.range_file import RateGains
from hil.studies.study import Result

MAGNIFIED = {"hip": 10, "ankle": 30, "toe": 30}
"""Joints whose sums are drawn larger in figure 3 of the seed, and how much."""


def draw_range_ceilings(
    title: str,
    description: RobotDescription,
    ranges: Sequence[RateGains],
    stored: Mapping[int, GainSet],
    ceilings: Sequence[Result],
    path: Path,
) -> None:
    """Four panels; `ceilings` are rows of `stride study ceiling` for the largest sets."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 13), layout="constrained")
        sums, means, shares, used = figure.subplots(4, 1)
        _draw_sums(sums, description, ranges, stored, ceilings)
        _draw_means(means, ranges)
        _draw_shares(shares, ranges)
        _draw_used(used, ranges, ceilings)
        for axes in (sums, means, shares, used):
            axes.set_axisbelow(True)
        figure.suptitle(f"{title}: acceptable gains", x=0.01, ha="left", fontweight="bold")
        figure.savefig(path, dpi=90)


def _draw_sums(
    axes: Axes,
    description: RobotDescription,
    ranges: Sequence[RateGains],
    stored: Mapping[int, GainSet],
    ceilings: Sequence[Result],
) -> None:
    """Figure 2: the sums of the smallest and largest sets."""
    whole = {row["rate_hz"]: row["factor"] for row in ceilings if row["joint_group"] == ALL}
    for place, found in enumerate(ranges):
        largest = total_of(description, found.largest)
        smallest = total_of(description, found.smallest)
        axes.bar(place - 0.2, smallest, 0.38, color=LEFT, label="smallest" if not place else None)
        axes.bar(place + 0.2, largest, 0.38, color=RIGHT, label="largest" if not place else None)
        factor = whole.get(found.rate_hz)
        if factor is not None:
            axes.plot(
                [place, place + 0.4], [factor * largest] * 2, color=BODY, linewidth=2.0,
                label="closed-form ceiling of the largest set" if not place else None,
            )  # fmt: skip
        if found.rate_hz in stored:
            total = total_of(description, stored[found.rate_hz])
            axes.plot([place], [total], "D", color=BODY, mfc="white", ms=7)
    axes.plot([], [], "D", color=BODY, mfc="white", ms=7, label="stored set of that rate")
    axes.set_xticks(range(len(ranges)), [f"{found.rate_hz} Hz" for found in ranges])
    axes.set(ylabel="ΣKp + 10·ΣKd", title="Sum of the gains")
    axes.legend(ncols=2)


def _draw_means(axes: Axes, ranges: Sequence[RateGains]) -> None:
    """Figure 3, top: the middle of each joint's range."""
    joints = list(ranges[0].smallest)
    _bars(
        axes,
        ranges,
        joints,
        lambda found, joint: MAGNIFIED.get(joint, 1) * sum_of(found.middle(joint)),
    )
    names = [f"{joint} ×{MAGNIFIED[joint]}" if joint in MAGNIFIED else joint for joint in joints]
    axes.set_xticks(range(len(joints)), names)
    axes.set(ylabel="Kp + 10·Kd", title="Mean of the range, joint by joint")
    axes.legend(ncols=4, fontsize=8)


def _draw_shares(axes: Axes, ranges: Sequence[RateGains]) -> None:
    """Figure 3, bottom: the width of each joint's range."""
    joints = list(ranges[0].smallest)

    def share(found: RateGains, joint: str) -> float:
        width = sum_of(found.largest[joint]) - sum_of(found.smallest[joint])
        middle = sum_of(found.middle(joint))
        return 100.0 * width / middle if middle > 0.0 else 0.0

    _bars(axes, ranges, joints, share)
    axes.set_xticks(range(len(joints)), joints)
    axes.set(ylabel="% of the mean", title="Width of the range, joint by joint")


def _draw_used(axes: Axes, ranges: Sequence[RateGains], ceilings: Sequence[Result]) -> None:
    """How much of its ceiling each joint of the largest set uses."""
    joints = list(ranges[0].smallest)
    factors = {
        (row["rate_hz"], row["joint_group"]): row["factor_typical"] or float("inf")
        for row in ceilings
    }
    _bars(axes, ranges, joints, lambda found, joint: 1.0 / factors[found.rate_hz, joint])
    axes.axhline(1.0, color=BODY, linewidth=1.5)
    axes.set_ylim(0.0, max(1.1, axes.get_ylim()[1]))
    axes.set_xticks(range(len(joints)), joints)
    axes.set(
        ylabel="gains / ceiling",
        title="Largest sets over the closed-form ceiling of each joint (median over a step)",
    )


def _bars(
    axes: Axes,
    ranges: Sequence[RateGains],
    joints: list[str],
    height: Callable[[RateGains, str], float],
) -> None:
    """A group a joint, a bar a rate, darker for higher rates."""
    width = 0.8 / len(ranges)
    for place, found in enumerate(ranges):
        values = [height(found, joint) for joint in joints]
        places = [joint + (place + 0.5) * width - 0.4 for joint in range(len(joints))]
        shade = 1.0 - 0.75 * place / len(ranges)
        axes.bar(places, values, width, color=LEFT, alpha=shade, label=f"{found.rate_hz} Hz")
