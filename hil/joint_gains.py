"""Stiffness and damping of joints by control rate, as a robot file stores them."""

from collections.abc import Collection, Sequence

from pydantic import NonNegativeFloat

from hil.interface import SIDES

GainSet = dict[str, tuple[NonNegativeFloat, NonNegativeFloat]]
"""Stiffness [N·m/rad] and damping [N·m·s/rad] by joint, named without its side."""


def kind_of(joint: str) -> str:
    """Name of a joint, or of a group of joints, without its side: `left_hip` is a `hip`."""
    for side in SIDES:
        if joint.startswith(f"{side}_"):
            return joint.removeprefix(f"{side}_")
    return joint


def kinds(joints: Sequence[str]) -> dict[str, list[int]]:
    """Places of the joints of each kind, the sides together, in the order given."""
    groups: dict[str, list[int]] = {}
    for place, joint in enumerate(joints):
        groups.setdefault(kind_of(joint), []).append(place)
    return groups


def set_for(rates: Collection[int], rate_hz: int) -> int:
    """The rate whose gain set a control rate takes: the highest not above it, or the lowest.

    A set that is stable at its own rate is so at higher ones, but not at lower ones.
    """
    return max((rate for rate in rates if rate <= rate_hz), default=min(rates))
