"""Who is asked in a group read, and in which order, so that a silent servo costs only itself.

Servos answer one after the other, each waiting for the one before: behind a silent servo nobody
answers. So a servo that missed its turn goes to the end of the chain until it has answered for a
while, and one that misses again is left out until it answers a read in idle time.

The order turns round from tick to tick. It costs nothing, and tells an answer that comes a tick
late from the one that is waited for.
"""

DROP_AFTER = 2
"""Misses in a row after which a servo is left out."""
TRUST_AFTER = 10
"""Answers in a row after which a servo that missed its turn stands among the others again."""


class Chain:
    """Order of the servos of one bus, by their places 0…size-1 on it."""

    def __init__(self, size: int) -> None:
        all_places = tuple(range(size))
        self._orders = (all_places, all_places[::-1])
        self._answers: dict[int, int] = {}
        """Answers in a row of doubtful servos; negative are misses."""
        self._tick = 0
        self._probe = 0

    @property
    def doubts(self) -> bool:
        """Whether there is a servo that missed its turn lately."""
        return bool(self._answers)

    @property
    def silent(self) -> tuple[int, ...]:
        """Servos that missed their last turn."""
        return tuple(place for place, answers in self._answers.items() if answers < 0)

    def members(self) -> tuple[int, ...]:
        """Servos to ask in this tick: the trusted ones, then those that may not answer."""
        self._tick += 1
        order = self._orders[self._tick % 2]
        if not self._answers:
            return order
        trusted = [place for place in order if place not in self._answers]
        doubtful = [place for place, answers in self._answers.items() if answers > -DROP_AFTER]
        return (*trusted, *sorted(doubtful, key=self._answers.__getitem__, reverse=True))

    def next_lost(self) -> int | None:
        """One of the servos that are left out, each in turn."""
        lost = [place for place, answers in self._answers.items() if answers <= -DROP_AFTER]
        if not lost:
            return None
        self._probe += 1
        return lost[self._probe % len(lost)]

    def heard(self, place: int) -> None:
        """A servo answered."""
        answers = self._answers.get(place)
        if answers is None:
            return
        self._answers[place] = max(answers, 0) + 1
        if self._answers[place] >= TRUST_AFTER:
            del self._answers[place]

    def missed(self, place: int, others_answered: bool) -> None:
        """A servo broke the chain: it moves behind all others.

        Where nobody answered it may have been the wire, so that is no reason to leave it out.
        """
        answers = min(self._answers.pop(place, 0), 0) - 1
        self._answers[place] = answers if others_answered else max(answers, 1 - DROP_AFTER)
