"""Do IMU, joints and cells tell of the same lean? Who does not is named."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from hil.interface import Floats

LEAST_LEAN = np.radians(2.0)
"""A lean that shows [rad]."""
LEAST_SHARE = 0.05
"""Of the weight: a shift of load that shows."""
LOADED = 0.15
"""Of the weight: a foot that carries less need not stand flat."""
LEANS = ("left", "right", "forward")
_NAMES = (("left", "right"), ("backward", "forward"))
"""Of a negative and a positive roll, and pitch."""
IMU, CELLS = "imu", "cells"


@dataclass(frozen=True, slots=True)
class LeanEvidence:
    """What changed from upright to one lean."""

    lean: str
    """left, right or forward: as it was told."""
    imu: Floats
    """Roll and pitch [rad], shape (2,)."""
    joints: Mapping[str, Floats] = field(default_factory=dict)
    """The same by the joints of a leg whose foot carries load, by side."""
    share: float | None = None
    """Rise of the left foot's part of the load for left and right, of the front cells' for
    forward; none without cells."""


@dataclass(frozen=True, slots=True)
class Culprit:
    """Who does not agree."""

    who: str
    """`imu`, `cells`, a side's leg as in `left leg`, or `lean` for whoever leaned it."""
    what: str


def judge(evidence: LeanEvidence) -> list[Culprit]:
    """Who contradicts, none where all agree.

    What was told is one voice among the others: where all contradict it, it was leaned otherwise.
    A voice without a visible change is silent; a silent IMU or leg is a problem of its own.
    """
    said = {IMU: _word(evidence.imu)}
    said |= {f"{side} leg": _word(lean) for side, lean in evidence.joints.items()}
    if evidence.share is not None:
        said[CELLS] = _cell_word(evidence.lean, evidence.share)
    voices = [word for word in said.values() if word is not None]
    if not voices:
        return [Culprit("lean", "nothing leaned: by more, and hold it")]
    if len(voices) > 1 and set(voices) == {voices[0]} and voices[0] != evidence.lean:
        return [Culprit("lean", f"was {voices[0]} for everybody, told was {evidence.lean}")]
    return [
        Culprit(who, "says nothing of it" if word is None else f"says {word}")
        for who, word in said.items()
        if word != evidence.lean
    ]


def _word(lean: Floats) -> str | None:
    axis = int(np.argmax(np.abs(lean)))
    if abs(lean[axis]) < LEAST_LEAN:
        return None
    return _NAMES[axis][int(lean[axis] > 0)]


def _cell_word(lean: str, share: float) -> str | None:
    if abs(share) < LEAST_SHARE:
        return None
    if lean == "forward":
        return "forward" if share > 0 else "backward"
    return "left" if share > 0 else "right"
