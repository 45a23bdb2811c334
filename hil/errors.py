"""The error tree. Every message names what is wrong, where, and the valid choices.

The command line prints the message of a `StrideError` in one line and exits with its `exit_code`:
2 for bad input (nothing was started), 1 for a run that had to stop.
"""

from collections.abc import Iterable


class StrideError(Exception):
    """Base of every error that a user can cause or must know of."""

    exit_code = 1


class InputError(StrideError, ValueError):
    """Bad input: a file, key, name, number or port that cannot be used."""

    exit_code = 2


class UnknownNameError(InputError):
    """A name that is not among the valid ones, which the message lists."""

    def __init__(self, what: str, name: str, valid: Iterable[str]) -> None:
        self.name = name
        self.valid = tuple(valid)
        super().__init__(f"unknown {what} {name!r}; valid: {', '.join(self.valid)}")


class DescriptionError(InputError):
    """A robot file with a wrong, missing or unknown key."""

    def __init__(self, file: str, key: str, problem: str) -> None:
        self.file = file
        self.key = key
        super().__init__(f"{file}: {key}: {problem}")


class InvalidCommandError(StrideError, ValueError):
    """A joint command with a value that no actuator may receive (not finite, wrong shape)."""


class BackendError(StrideError):
    """A backend that cannot go on: a port lost, a device gone, a diverged simulation."""


class PortError(InputError):
    """A serial port that cannot be opened."""
