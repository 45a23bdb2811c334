"""Who is asked in a group read, and in which order, so that a silent servo costs only itself.

Servos answer one after the other, each waiting for the one before: behind a silent servo nobody
answers. So a servo that missed its turn goes to the end of the chain, and one that stays silent
is left out but for a probe now and then.

The order turns round from tick to tick. It costs nothing, and tells an answer that comes a tick
late, which nothing else in the protocol marks, from the one that is waited for.
"""

GIVE_UP_AFTER = 10
"""Misses in a row after which a servo is only probed; a loop gives up on it earlier."""
PROBE_EVERY = 10
"""Ticks between probes of silent servos."""


class Chain:
    """Order of the servos of one bus, by their places 0…size−1 on it."""

    def __init__(self, size: int) -> None:
        self._all = tuple(range(size))
        self._orders = (self._all, self._all[::-1])
        self._misses: dict[int, int] = {}
        self._tick = 0
        self._probe = 0

    @property
    def silent(self) -> tuple[int, ...]:
        """Servos that missed their last turn."""
        return tuple(self._misses)

    def members(self) -> tuple[int, ...]:
        """Servos to ask in this tick: those that answer first, then doubtful ones."""
        self._tick += 1
        order = self._orders[self._tick % 2]
        if not self._misses:
            return order
        answering = [place for place in order if place not in self._misses]
        doubtful = [place for place, misses in self._misses.items() if misses < GIVE_UP_AFTER]
        lost = [place for place, misses in self._misses.items() if misses >= GIVE_UP_AFTER]
        if lost and self._tick % PROBE_EVERY == 0:
            self._probe += 1
            doubtful.append(lost[self._probe % len(lost)])
        return (*answering, *doubtful)

    def heard(self, place: int) -> None:
        """A servo answered."""
        self._misses.pop(place, None)

    def missed(self, place: int) -> None:
        """A servo broke the chain: it moves behind all others."""
        self._misses[place] = self._misses.pop(place, 0) + 1
