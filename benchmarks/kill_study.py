"""Kills a real-time walk at random moments, and asks its servos how soon they stopped.

Emulated, on pseudo-terminals: each kill ends a `stride walk --realtime` of its own with SIGKILL,
at a moment drawn between torque on and the end of the walk. The emulator's journal tells when the
last servo stopped (its bus watchdog tripped, or its torque went off) and when the last torque went
off (the guardian's frames). Times run from the kill.

Run: `python benchmarks/kill_study.py --kills 200` (some 20 min on a quiet machine). Exit code 1 if
one took too long. `--light` takes coarse physics, for a machine that is busy otherwise.
"""

import argparse
import os
import signal
import sys
import time
from collections.abc import Sequence
from random import Random

from live_walk import LIGHT, NOMINAL, STAND_UP_S, LiveWalk, Reaction

STOPPED_WITHIN_S, OFF_WITHIN_S = 0.060, 0.100
WALK_S = 2.5
"""Of a walk, in which it may be killed."""
MARGIN_S = 1.0
"""It would go on for so much longer."""
ATTEMPTS = 5
"""Of one kill; a walk that a busy machine made stop by itself counts for nothing."""


def kill_once(rate_hz: int, after_s: float, overrides: Sequence[str]) -> Reaction:
    """Kill a walk some time after torque on; what its servos did. Zero joints: it had ended."""
    words = ("--speed", "0.1", "--duration", str(WALK_S + MARGIN_S))
    with LiveWalk(rate_hz, words, overrides) as walk:
        on_ns = walk.torque_on_ns()
        time.sleep(max(0.0, (on_ns - time.monotonic_ns()) * 1e-9 + after_s))
        killed_ns = time.monotonic_ns()
        os.kill(walk.process.pid, signal.SIGKILL)
        return walk.reaction(killed_ns)


def study(
    kills: int, rate_hz: int, seed: int, overrides: Sequence[str]
) -> tuple[list[tuple[float, Reaction]], int]:
    """All kills as (time after torque on, reaction), and how many walks had ended before."""
    random, found, ended = Random(seed), [], 0
    while len(found) < kills and ended < ATTEMPTS * kills:
        after_s = random.uniform(0.05, STAND_UP_S + WALK_S)
        try:
            reaction = kill_once(rate_hz, after_s, overrides)
        except TimeoutError as error:
            sys.stderr.write(f"{error}\n")
            reaction = Reaction(0.0, 0.0, 0.0, 0)
        if reaction.joints == 0:
            ended += 1
            continue
        found.append((after_s, reaction))
        sys.stderr.write(
            f"{len(found):4d}  killed {after_s:4.2f} s after torque on: stopped after "
            f"{1000 * reaction.stopped_s:5.1f} ms, off after {1000 * reaction.off_s:5.1f} ms\n"
        )
    return found, ended


def in_time(reaction: Reaction) -> bool:
    """Whether a reaction keeps both promises; one that never came is NaN, and does not."""
    return reaction.stopped_s <= STOPPED_WITHIN_S and reaction.off_s <= OFF_WITHIN_S


def share(values: Sequence[float], of: float) -> float:
    """The value below which a share of all lies, the next higher one; NaN counts as highest.

    NaN if there are none: every walk had ended by itself.
    """
    if not values:
        return float("nan")
    ordered = sorted(values, key=lambda value: (value != value, value))
    return ordered[min(len(ordered) - 1, int(of * len(ordered)))]


def main() -> int:
    """Kill, print the table of docs/safety.md; the exit code."""
    parser = argparse.ArgumentParser(prog="python benchmarks/kill_study.py")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--rate", type=int, default=150, help="ticks a second [Hz]")
    parser.add_argument("--seed", type=int, default=0, help="draws the moments")
    parser.add_argument("--light", action="store_true", help="coarse physics")
    options = parser.parse_args()
    found, ended = study(
        options.kills, options.rate, options.seed, LIGHT if options.light else NOMINAL
    )
    print("| from the kill to | promised | least | median | p90 | p99 | most |")
    print("|---|---|---|---|---|---|---|")
    for name, bound, values in (
        ("the last servo stopped", STOPPED_WITHIN_S, [r.stopped_s for _, r in found]),
        ("the last torque off", OFF_WITHIN_S, [r.off_s for _, r in found]),
    ):
        cells = [f"{1000 * share(values, of):.1f} ms" for of in (0.0, 0.5, 0.9, 0.99, 1.0)]
        print(f"| {name} | {1000 * bound:.0f} ms | {' | '.join(cells)} |")
    good = sum(in_time(reaction) for _, reaction in found)
    print(f"\n{good} of {len(found)} kills in time; {ended} walks had ended by themselves before.")
    return 0 if good == len(found) == options.kills else 1


if __name__ == "__main__":
    sys.exit(main())
