"""Does each joint turn the way that the robot file says? Moved by hand, one after another."""

from collections import deque

import numpy as np

from hil.bringup.calibrating import STILL_RAD, Calibrating
from hil.bringup.deed import Deed
from hil.bringup.motion_words import motion_words

MOVED_RAD = np.radians(12.0)
"""A joint that was moved on purpose; hands that do so move others by less."""
ASKED_RAD = np.radians(20.0)
_WINDOW_NS = 400_000_000
_REMIND_NS = 15_000_000_000

Angles = dict[str, float]


def middle_pose(work: Calibrating) -> Angles:
    """Angles near zero from which every joint has room to be moved [rad]."""
    room = 1.25 * ASKED_RAD
    return {
        joint.name: float(np.clip(0.0, joint.range[0], max(joint.range[0], joint.range[1] - room)))
        for joint in work.description.joints
    }


def confirm_signs(work: Calibrating, joints: list[str]) -> None:
    """Ask for every joint to be moved; problems go into the inspection."""
    words, pose = motion_words(work.description), middle_pose(work)
    work.wait(
        "Hang the robot up so that its legs are free. Joints will be moved one at a time, by "
        f"about {np.degrees(ASKED_RAD):.0f}° and only as told; hold the rest of the leg",
        Deed(lifted=True, joints=pose),
    )
    for joint in joints:
        before = _await_rest(work)
        goal = pose[joint] + ASKED_RAD
        work.dialogue.say(
            f"{joint}: move it so that {words[joint]}, and hold it there",
            Deed(joints={joint: goal}),
        )
        after = _await_move(work, joint, before)
        _judge(work, joint, {name: after[name] - before[name] for name in after if name in before})
        work.dialogue.say("  let it go", Deed(joints={joint: pose[joint]}))


def _judge(work: Calibrating, joint: str, moved: Angles) -> None:
    own = moved.get(joint, 0.0)
    other = max(moved, key=lambda name: abs(moved[name]))
    if abs(own) < MOVED_RAD:
        work.dialogue.say(f"  {other} answered instead")
        work.inspection.expect(
            False, joint, f"it was moved, and {other} answered",
            "ids or plugs are exchanged: stride setup gives a servo its id",
        )  # fmt: skip
        return
    went = f"{np.degrees(own):+.0f}°"
    work.dialogue.say(f"  {went}: {'right' if own > 0 else 'the wrong way'}")
    direction = next(one.direction for one in work.description.joints if one.name == joint)
    work.inspection.expect(
        own > 0, joint, f"turns the wrong way: moved as told, its angle went {went}",
        f"direction: {-direction} in the robot file if every robot of this file is built so; "
        "otherwise this servo is mounted mirrored",
    )  # fmt: skip


def _await_rest(work: Calibrating) -> Angles:
    return work.still(0.3).angles


def _await_move(work: Calibrating, joint: str, before: Angles) -> Angles:
    """Angles once some joint was moved and all are still; reminds of what is awaited."""
    window: deque[tuple[int, Angles]] = deque()
    remind_ns = work.clock.now_ns() + _REMIND_NS
    while True:
        now_ns, angles = work.clock.now_ns(), work.sampler.angles()
        window.append((now_ns, angles))
        while window[0][0] < now_ns - _WINDOW_NS:
            window.popleft()
        moved = {name: angles[name] - before[name] for name in angles if name in before}
        whole = now_ns - window[0][0] > 0.8 * _WINDOW_NS
        if whole and max(map(abs, moved.values()), default=0.0) > MOVED_RAD and _rests(window):
            return angles
        if now_ns > remind_ns:
            work.dialogue.say(
                f"  waiting: {joint} has moved {np.degrees(moved.get(joint, 0.0)):+.0f}°, "
                f"{np.degrees(MOVED_RAD):.0f}° are needed"
            )
            remind_ns = now_ns + _REMIND_NS
        work.pause()


def _rests(window: deque[tuple[int, Angles]]) -> bool:
    last = window[-1][1]
    return all(
        abs(look[name] - last[name]) < STILL_RAD for _, look in window for name in last
        if name in look
    )  # fmt: skip
