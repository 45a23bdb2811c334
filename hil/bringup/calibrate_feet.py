"""Load cells: zero in the air, scale from known weights, the robot's own weight as the proof."""

from dataclasses import dataclass

import numpy as np

from hil.bringup.calibrating import Calibrating
from hil.bringup.cell_fit import CellFit, fit_scales
from hil.bringup.deed import Deed
from hil.bringup.joint_signs import middle_pose
from hil.bringup.moment import Cells
from hil.errors import InputError
from hil.interface import CORNERS, GRAVITY, SIDES, Floats
from hil.robot_facts import body_weight

LISTEN_S = 0.7
"""How long one listens to cells on which something stands [s]."""
SEEN = 8.0
"""A load shows when it is so many standard deviations of a frame (assumed)."""
SPREAD = 3.0
"""Between the scales of one foot's cells: more is another cell, another gain, or a bad wire."""
WEIGHT_TOLERANCE = 0.1
"""Of the robot's own weight (assumed: the model's mass is a builder's kitchen scale's)."""
RESIDUAL_SHARE = 0.05
"""Of the largest weight: what placements on a good foot leave over (assumed)."""
MIDDLE = "middle"


@dataclass(frozen=True, slots=True)
class FeetRequest:
    """What is to be done."""

    weights_kg: tuple[float, ...] = (1.0,)
    """Each is put on every cell and on the middle of both soles."""
    mass_kg: float | None = None
    """The robot's, weighed; the model's if there is none."""


@dataclass(frozen=True, slots=True)
class FeetResult:
    """What was found."""

    zeros: dict[str, Floats]
    """[counts], by side."""
    fits: dict[str, CellFit]
    """By side."""
    weight_n: float
    """The robot's, as the cells have it [N]."""


def calibrate_feet(work: Calibrating, request: FeetRequest) -> FeetResult:
    """Ask, look, and write the file. Raises RefusedError, and nothing is written then."""
    boards: dict[str, str] = {
        side: foot.board for side, foot in work.description.feet.items() if foot.board
    }
    sides: list[str] = [side for side in SIDES if side in boards]
    if not sides:
        raise InputError(f"{work.description.name} has no load cells")
    if not request.weights_kg or min(request.weights_kg) <= 0:
        raise InputError("--weight must be above 0 kg")
    tare = _tare(work, sides)
    fits: dict[str, CellFit] = {}
    for side in sides:
        fits[side] = _load(work, side, tare, request.weights_kg)
        _require_plausible(work, side, fits[side], max(request.weights_kg) * GRAVITY)
    work.settle()
    weight = _self_weight(work, tare, fits, request.mass_kg)
    work.settle()
    feet = {
        side: {"zero": np.round(tare[side].mean, 1).tolist(), "scale": fits[side].scale.tolist()}
        for side in sides
    }
    residual = float(np.sqrt(np.mean([fit.residual**2 for fit in fits.values()])))
    weights = ", ".join(f"{kg:g} kg" for kg in request.weights_kg)
    work.file.keep_feet(
        feet, f"tared in the air, {weights} on every cell; weighed {weight:.1f} N", residual,
        {board: f"{side} foot" for side, board in boards.items()},
    )  # fmt: skip
    return FeetResult({side: tare[side].mean for side in sides}, fits, weight)


def _tare(work: Calibrating, sides: list[str]) -> dict[str, Cells]:
    work.wait(
        "Hold the robot in the air: nothing touches its soles",
        Deed(lifted=True, joints=middle_pose(work), load={}),
    )
    tare = work.sampler.watch(LISTEN_S, joints=False).feet
    for side in sides:
        where = f"{side} foot"
        if not work.inspection.expect(side in tare, where, "its board sends nothing", "its plug"):
            continue
        for cell, corner in enumerate(CORNERS):
            work.inspection.expect(
                tare[side].valid[cell], where, f"cell {corner} is marked invalid by its board",
                "its wires: an open or shorted cell",
            )  # fmt: skip
    work.settle()
    return tare


def _load(
    work: Calibrating, side: str, tare: dict[str, Cells], weights_kg: tuple[float, ...]
) -> CellFit:
    """Every weight on every cell and on the middle of one sole."""
    rows, forces = [], []
    for kg in weights_kg:
        for place in (*CORNERS, MIDDLE):
            force = kg * GRAVITY
            counts = _put(work, side, place, kg, tare)
            if place != MIDDLE:
                _require_cell(work, side, place, counts, tare)
            rows.append(counts[side])
            forces.append(force)
    work.wait(f"Take the weight off the {side} sole", Deed(load={}))
    work.settle()
    try:
        return fit_scales(np.array(rows), np.array(forces))
    except ValueError as error:
        work.inspection.expect(False, f"{side} foot", str(error), "load one cell after another")
        work.settle()
        raise


def _put(
    work: Calibrating, side: str, place: str, kg: float, tare: dict[str, Cells]
) -> dict[str, Floats]:
    """A weight on one place; counts above zero of both feet."""
    corners = CORNERS if place == MIDDLE else (place,)
    share = kg * GRAVITY / len(corners)
    spot = "the middle" if place == MIDDLE else place.replace("_", " ")
    work.wait(
        f"{side} foot: {kg:g} kg on {spot} of the sole, turned up or with a hook; hands off",
        Deed(load={(side, corner): share for corner in corners}),
    )
    feet = work.sampler.watch(LISTEN_S, joints=False).feet
    return {one: feet[one].mean - tare[one].mean for one in tare if one in feet}


def _require_cell(
    work: Calibrating, side: str, corner: str, counts: dict[str, Floats], tare: dict[str, Cells]
) -> None:
    """The cell that was loaded must answer, and more than any other."""
    size = {one: np.abs(counts[one]) / np.maximum(tare[one].deviation, 1.0) for one in counts}
    foot, cell = max(
        ((one, index) for one in size for index in range(len(CORNERS))),
        key=lambda at: float(size[at[0]][at[1]]),
    )
    where = f"{side} foot"
    wanted = size[side][CORNERS.index(corner)]
    if size[foot][cell] < SEEN:
        what, advice = f"cell {corner} does not answer to load", "its wires, its cell"
    elif foot != side:
        what = f"was loaded, and the {foot} foot answered"
        advice = "the ports of the two feet are exchanged"
    elif CORNERS[cell] == corner:
        what = advice = ""
    elif wanted < SEEN:
        what = f"cell {corner} was loaded, and {CORNERS[cell]} answered"
        advice = "their wires are exchanged, or one of them is dead"
    else:
        what = f"cell {corner} was loaded, and {CORNERS[cell]} answered more"
        advice = "the weight belongs on the corner; or the wires of two cells are exchanged"
    work.inspection.expect(not what, where, what, advice)


def _require_plausible(work: Calibrating, side: str, fit: CellFit, largest: float) -> None:
    where, sizes = f"{side} foot", np.abs(fit.scale)
    odd = int(np.argmax(np.abs(np.log(sizes / np.median(sizes)))))
    ratio = float(sizes[odd] / np.median(sizes))
    work.inspection.expect(
        1 / SPREAD < ratio < SPREAD, where,
        f"cell {CORNERS[odd]} gives {1 / ratio:.1f} times the counts a newton of the others",
        "another cell, another gain, or a bad wire",
    )  # fmt: skip
    work.inspection.expect(
        fit.residual <= RESIDUAL_SHARE * largest, where,
        f"the weights are off by {fit.residual:.2f} N (rms) from what they weigh",
        "something carries load beside the cells, or a weight is not what was said",
    )  # fmt: skip
    down = [CORNERS[cell] for cell in range(len(CORNERS)) if fit.scale[cell] < 0]
    if down:
        work.inspection.remark(
            where, f"{', '.join(down)}: counts go down under load",
            "signal wires are exchanged; the scale makes up for it",
        )  # fmt: skip


def _self_weight(
    work: Calibrating, tare: dict[str, Cells], fits: dict[str, CellFit], mass_kg: float | None
) -> float:
    expected = body_weight(work.description) if mass_kg is None else mass_kg * GRAVITY
    zero = dict.fromkeys(work.description.joint_names, 0.0)
    stand = zero | work.description.start.joints
    sit = stand if work.description.sit is None else zero | work.description.sit.joints
    work.wait(
        "Put the robot on its feet, legs folded until it carries itself, and steady it with a "
        "fingertip: all of its weight on the soles, none in a hand or cable",
        Deed(lifted=True, joints=stand), Deed(lifted=False), Deed(released=True), Deed(joints=sit),
    )  # fmt: skip
    feet = work.sampler.watch(LISTEN_S, joints=False).feet
    weight = sum(float(fits[s].scale @ (feet[s].mean - tare[s].mean)) for s in fits if s in feet)
    work.inspection.expect(
        abs(weight - expected) <= WEIGHT_TOLERANCE * expected, "feet",
        f"weigh the robot as {weight:.1f} N, its mass says {expected:.1f} N",
        "hands off; or the weight was not what --weight says; or --mass, weighed",
    )  # fmt: skip
    return weight
