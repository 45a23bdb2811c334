"""The space of an offline search: named variables, where they start, how far they may go."""

from dataclasses import dataclass

from hil.errors import InputError

Vector = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class SearchSpace:
    """Variables of a search, one entry each in `names`, `start`, `lower` and `upper`.

    The search draws its first candidates from N(start, sigma²·I): scale the variables so that
    one step size fits all. Raises InputError for a start outside the bounds.
    """

    names: tuple[str, ...]
    start: Vector
    sigma: float
    """First standard deviation, the same for all variables."""
    lower: Vector
    upper: Vector

    def __post_init__(self) -> None:
        if not self.names:
            raise InputError("a search needs at least one variable")
        if self.sigma <= 0:
            raise InputError(f"the step size of a search must be above 0 (got {self.sigma:g})")
        rows = zip(self.names, self.lower, self.start, self.upper, strict=True)
        for name, low, value, high in rows:
            if not low < high or not low <= value <= high:
                raise InputError(f"{name}: starts at {value:g}, outside {low:g} to {high:g}")
