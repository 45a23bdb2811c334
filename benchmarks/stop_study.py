"""The software stop of a real-time walk: from the key, signal or word to torque-off frames.

Emulated, on pseudo-terminals. A walk is stopped in each state with torque on and in each way, at
moments drawn in that state; the emulator's journal tells when the slowest bus had its first
torque-off frame whole, and when the last torque went off. Times run from the moment of asking.
Arming takes some milliseconds and is not met here: tests/safety stops it in virtual time.

Run: `python benchmarks/stop_study.py --stops 10` (of each; some 15 min on a quiet machine). Exit
code 1 if one took too long. `--light` takes coarse physics, for a machine that is busy otherwise.
"""

import argparse
import os
import signal
import sys
import time
from collections.abc import Callable, Sequence
from itertools import islice
from random import Random

from kill_study import share
from live_walk import LIGHT, NOMINAL, SIT_S, STAND_UP_S, LiveWalk, Reaction

FRAME_WITHIN_S = 0.005
WALK_S = 3.0
ATTEMPTS = 4


def _press_space(walk: LiveWalk) -> None:
    os.write(walk.terminal, b" ")


def _say_off(walk: LiveWalk) -> None:
    walk.say("off")


def _send_quit(walk: LiveWalk) -> None:
    os.kill(walk.process.pid, signal.SIGQUIT)


def _send_two(walk: LiveWalk) -> None:
    """Two of a kind at once would be one to the kernel."""
    os.kill(walk.process.pid, signal.SIGINT)
    os.kill(walk.process.pid, signal.SIGTERM)


WAYS: dict[str, Callable[[LiveWalk], None]] = {
    "key": _press_space,
    "socket": _say_off,
    "SIGQUIT": _send_quit,
    "second signal": _send_two,
}
STATES = {
    "standing up": (0.05, STAND_UP_S - 0.1),
    "walking": (STAND_UP_S + 0.1, STAND_UP_S + WALK_S - 0.5),
    "sitting down": (STAND_UP_S + 1.0, STAND_UP_S + 1.0),
}
"""Earliest and latest moment after torque on [s]; for the last one, when it is told to sit."""


def stop_once(
    state: str, way: str, random: Random, rate_hz: int, overrides: Sequence[str]
) -> Reaction:
    """Stop one walk in a state; what its servos did. Zero joints: it had ended."""
    words = ("--speed", "0.1", "--duration", str(WALK_S))
    with LiveWalk(rate_hz, words, overrides) as walk:
        try:
            after_s = random.uniform(*STATES[state])
            time.sleep(max(0.0, (walk.torque_on_ns() - time.monotonic_ns()) * 1e-9 + after_s))
            if state == "sitting down":
                walk.say("sit")
                time.sleep(random.uniform(0.05, SIT_S - 0.2))
            asked_ns = time.monotonic_ns()
            WAYS[way](walk)
        except (OSError, TimeoutError):  # a busy machine made it end by itself
            return Reaction(0.0, 0.0, 0.0, 0)
        return walk.reaction(asked_ns)


def main() -> int:
    """Stop, print the table of docs/safety.md; the exit code."""
    parser = argparse.ArgumentParser(prog="python benchmarks/stop_study.py")
    parser.add_argument("--stops", type=int, default=10, help="of each state and way")
    parser.add_argument("--rate", type=int, default=150, help="ticks a second [Hz]")
    parser.add_argument("--seed", type=int, default=0, help="draws the moments")
    parser.add_argument("--light", action="store_true", help="coarse physics")
    options = parser.parse_args()
    overrides, random = LIGHT if options.light else NOMINAL, Random(options.seed)
    print("| state | asked by | stops | first frame: median | most | last torque off: most |")
    print("|---|---|---|---|---|---|")
    slow = 0
    for state in STATES:
        for way in WAYS:
            tried = (
                stop_once(state, way, random, options.rate, overrides)
                for _ in range(ATTEMPTS * options.stops)
            )
            found = list(islice((r for r in tried if r.joints), options.stops))
            frames, offs = [r.frame_s for r in found], [r.off_s for r in found]
            slow += sum(not frame <= FRAME_WITHIN_S for frame in frames)
            cells = [f"{1000 * value:.1f} ms" for value in
                     (share(frames, 0.5), share(frames, 1.0), share(offs, 1.0))]  # fmt: skip
            print(f"| {state} | {way} | {len(found)} | {' | '.join(cells)} |", flush=True)
    print(f"\n{slow} first frames later than {1000 * FRAME_WITHIN_S:.0f} ms.")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
