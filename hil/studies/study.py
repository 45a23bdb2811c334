"""What a study is: settings, cases, and what comes out of them."""

import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Protocol, TypeVar

from hil.request import RunRequest
from hil.validation import Config


class Case(Config):
    """One experiment of a study. Its parameters are all that its result depends on."""

    request: RunRequest
    """Resolved; the case adds what it varies."""


CaseT = TypeVar("CaseT", bound=Case)
Result = dict[str, Any]
"""JSON values. `error` holds the message of a case that could not be run."""


class Counter(Protocol):
    """Is told of every case that is done."""

    def advance(self) -> None:
        """One more."""
        ...


class RunCases(Protocol):
    """Runs cases, or remembers those that ran before; results in the order of the cases."""

    def __call__(
        self,
        function: Callable[[CaseT], Result],
        cases: Sequence[CaseT],
        counter: Counter | None = None,
    ) -> list[Result]:
        """`function` is a module's own: worker processes import it.

        `counter` counts these cases in place of a progress bar of their own.
        """
        ...

    def publish(self, result: "StudyResult") -> None:
        """Show in the study's folder what is known so far, as CSV and figure."""
        ...


@dataclass(frozen=True, slots=True)
class Table:
    """A table for the screen; columns without a head are text."""

    title: str
    heads: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class StudyResult:
    """What a study found."""

    rows: list[Result]
    """One flat object a case, all with the same keys: the CSV."""
    tables: list[Table]
    draw: Callable[[Path], None]
    """Writes the figure to a file."""
    notes: list[str] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    """Further files of the study's folder: name and text."""


class Study(Config, ABC):
    """A study is its settings: two with equal fields are the same one."""

    name: ClassVar[str]
    request: RunRequest
    """What every walk of the study has in common, resolved."""

    @abstractmethod
    def conduct(self, run_cases: RunCases) -> StudyResult:
        """Make the cases, have them run, and put the results together."""


def case_key(case: Case) -> str:
    """The case as one line of JSON: equal for equal cases, whichever process asks."""
    return json.dumps(case.model_dump(mode="json"), sort_keys=True)
