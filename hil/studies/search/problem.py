"""What an offline search minimises."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic

from hil.studies.search.space import SearchSpace, Vector
from hil.studies.study import CaseT, Result


@dataclass(frozen=True, slots=True)
class SearchProblem(Generic[CaseT]):
    """A cost over a space, evaluated case by case in worker processes.

    A case is all that its cost depends on, its seed included. `evaluate` is a function of a
    module, which workers import by its name. It returns JSON values with the finite number `cost`
    and whatever parts of it are worth keeping. What takes long and is the same for all candidates,
    it keeps in its process (`functools.lru_cache`).
    """

    title: str
    """For the progress bar."""
    space: SearchSpace
    case: Callable[[Vector], CaseT]
    """The case of a candidate."""
    evaluate: Callable[[CaseT], Result]
