"""How long an offline search may go on."""

import math

from pydantic import Field, PositiveInt

from hil.validation import Config


class SearchBudget(Config):
    """Limits of one CMA run. Defaults: seed 000_bd1305a0ae731442, section 4.2."""

    iterations: PositiveInt = 150
    population: PositiveInt | None = Field(default=None, ge=4)
    """Candidates of an iteration; none for 4 + ⌊3·ln n⌋ of n variables (Hansen)."""
    patience: PositiveInt = 20
    """Iterations without evolution after which a run ends."""
    progress: float = Field(default=1e-3, ge=0)
    """Share of |cost| by which the best must fall in these iterations to count as evolution."""

    def population_of(self, variables: int) -> int:
        """Candidates of an iteration in a space of so many variables."""
        return self.population or 4 + math.floor(3 * math.log(variables))
