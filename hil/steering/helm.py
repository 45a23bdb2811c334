"""The helm of a run: words arrive at any time, and act at the next tick's beginning."""

import math
from collections import deque
from collections.abc import Callable

from hil.schedule import Operator, Push
from hil.steering.limits import PUSH_TIME_S, SteerLimits
from hil.steering.words import Word

DEAD_MAN_S = 2.0
"""A live robot that is steered and hears nothing for so long stops on the spot."""
FULL_TURN = 2.0 * math.pi
FARTHEST = 1000.0 * FULL_TURN
"""No heading beyond this is asked for: longer than a run, and sums stay finite [rad]."""


class Helm:
    """Takes words from any thread and changes the operator's schedules at a tick's boundary.

    There is one way to ask a controller for anything: `hil.schedule.Operator`. A word replaces
    what was scheduled for its axis from now on; axes that nobody touches keep their schedule.
    """

    def __init__(self, limits: SteerLimits, rate_hz: int, *, dead_man: bool, pushes: bool) -> None:
        """`dead_man`: a hand must be heard of every `DEAD_MAN_S`; `pushes`: there is a world that
        can push.
        """
        self.limits = limits
        self.started = False
        """Whether a walk that waits was told to begin."""
        self._dead_man, self._pushes = dead_man, pushes
        self._words: deque[Word] = deque(maxlen=256)
        self._silence = 0
        self._patience = round(DEAD_MAN_S * rate_hz)
        self._moving = False
        self._asked: dict[str, float] = {}
        self._actions: dict[str, Callable[[Operator, float, tuple[float, ...]], None]] = {
            "speed": self._speed,
            "lateral": self._lateral,
            "heading": self._heading,
            "faster": self._faster,
            "sideways": self._sideways,
            "turn": self._turn,
            "push": self._push,
            "halt": self._halt,
        }

    def post(self, word: Word) -> None:
        """Say a word, from any thread; beyond 256 that wait, the oldest is forgotten."""
        self._words.append(word)
        if word.name == "start":
            self.started = True

    def act(self, operator: Operator, time_s: float) -> bool:
        """Apply what was said since the last tick; True when the dead man's rule stopped it."""
        if not self._words:
            return self._let_go(operator, time_s)
        while self._words:
            word = self._words.popleft()
            action = self._actions.get(word.name)
            if action is not None:
                action(operator, time_s, word.values)
        self._silence = 0
        return False

    def _let_go(self, operator: Operator, time_s: float) -> bool:
        self._silence += 1
        if not (self._dead_man and self._moving and self._silence > self._patience):
            return False
        self._halt(operator, time_s, ())
        return True

    def _speed(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        self._set(operator, "speed", self.limits.speed(values[0]), time_s)

    def _lateral(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        self._set(operator, "lateral", self.limits.lateral(values[0]), time_s)

    def _heading(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        heading = max(-FARTHEST, min(values[0], FARTHEST))
        self._set(operator, "heading", heading, time_s)

    def _faster(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        wanted = self._wanted(operator, "speed", time_s) + values[0]
        self._speed(operator, time_s, (wanted,))

    def _sideways(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        wanted = self._wanted(operator, "lateral", time_s) + values[0]
        self._lateral(operator, time_s, (wanted,))

    def _turn(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        turn = max(-FULL_TURN, min(values[0], FULL_TURN))
        self._heading(operator, time_s, (self._wanted(operator, "heading", time_s) + turn,))

    def _halt(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        del values  # It has none.
        self._set(operator, "speed", 0.0, time_s)
        self._set(operator, "lateral", 0.0, time_s)

    def _push(self, operator: Operator, time_s: float, values: tuple[float, ...]) -> None:
        fx, fy, fz, duration = values
        if self._pushes and duration > 0.0:
            bound = self.limits.force
            force = (bound(fx), bound(fy), bound(fz))
            push = Push(force=force, start=max(time_s, 0.0), duration=min(duration, PUSH_TIME_S))
            operator.push_now(push)

    def _wanted(self, operator: Operator, axis: str, time_s: float) -> float:
        """What is asked for on an axis, which a heading has perhaps not reached yet."""
        known = self._asked.get(axis)
        return float(getattr(operator.reference(time_s), axis)) if known is None else known

    def _set(self, operator: Operator, axis: str, value: float, time_s: float) -> None:
        operator.steer(axis, value, time_s)
        self._asked[axis] = value
        self._moving = any(self._asked.get(name, 0.0) != 0.0 for name in ("speed", "lateral"))
