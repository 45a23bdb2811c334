"""The cases of `stride study windup`, and their rows: the seed's three empty tables and a fourth.

Seed 004_2880d7939e94ed85: tables 3.1 (controller constants), 3.2 (spring muscles) and 3.3 (joint
constraints); its chapter 1 for characters of other weight and on the Moon.
"""

from hil.description import RobotDescription
from hil.interface import GRAVITY
from hil.joint_gains import kind_of
from hil.studies.study import Result
from hil.studies.windup_case import WindupCase

KP = (0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 1.6, 1.9, 2.2)
KD = (0.0, 0.1, 0.3)
UNLIMITED = {"travel": 1.0, "iterations": 100}
"""While constants are compared no limit on the hip's travel shall hide what they do."""
SCALES = (0.7, 0.85, 1.0, 1.25, 1.6, 2.0)
SHARES = (1.0, 0.8, 0.6, 0.4)
BENDING = ("knee", "hip_pitch", "ankle_pitch")
WEAK = 0.4
"""Stiffness with which no bend is enough: the windups of table 3.3 go as deep as limits let."""
MOON, MARS = 1.62, 3.71
CHARACTERS = (
    ("Earth", GRAVITY, 1.0),
    ("Mars", MARS, 1.0),
    ("Moon", MOON, 1.0),
    ("double mass", GRAVITY, 2.0),
    ("half mass", GRAVITY, 0.5),
)

Labelled = tuple[Result, WindupCase]
"""What varies, as columns of the table, and the case."""


def gain_cases(base: WindupCase, *, few: bool) -> list[Labelled]:
    """Table 3.1: kp and kd."""
    return [
        ({"table": "3.1", "kp": kp, "kd": kd},
         base.model_copy(update={"settings": {"kp": kp, "kd": kd, **UNLIMITED}}))
        for kd in KD[: 1 if few else None]
        for kp in KP[: 2 if few else None]
    ]  # fmt: skip


def muscle_cases(base: WindupCase, *, few: bool) -> list[Labelled]:
    """Table 3.2: k and r, one at a time."""
    scales = SCALES[2:3] if few else SCALES
    laws = (base.law,) if few else ("mitre", "chord")
    return [
        ({"table": "3.2", "law": law, "varied": name, "scale": scale},
         base.model_copy(update={"law": law, f"{long}_scale": scale}))
        for law in laws
        for name, long in (("k", "stiffness"), ("r", "width"))
        for scale in scales
    ]  # fmt: skip


def limit_cases(base: WindupCase, description: RobotDescription, *, few: bool) -> list[Labelled]:
    """Table 3.3: narrower ranges of each kind of joint that bends, for as deep a windup as goes."""
    weak = base.model_copy(update={"law": "mitre", "stiffness_scale": WEAK})
    cases: list[Labelled] = []
    for kind in BENDING[: 1 if few else None]:
        lower, upper = next(
            joint.range for joint in description.joints if kind_of(joint.name) == kind
        )
        for share in SHARES[: 1 if few else None]:
            columns = {"table": "3.3", "joint": kind, "share": share,
                       "lower_rad": lower, "upper_rad": upper}  # fmt: skip
            cases.append((columns, weak.model_copy(update={"limits": (kind, share)})))
    return cases


def character_cases(base: WindupCase, *, few: bool) -> list[Labelled]:
    """The same target and air time elsewhere, and for others."""
    return [
        ({"table": "characters", "law": law, "character": name},
         base.model_copy(update={"law": law, "gravity": gravity, "mass_scale": mass}))
        for law in ((base.law,) if few else ("mitre", "chord"))
        for name, gravity, mass in CHARACTERS[: 1 if few else None]
    ]  # fmt: skip
