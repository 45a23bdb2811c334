"""Nothing enables torque or writes EEPROM before somebody has said yes."""

import sys

from hil.errors import InputError, StrideError


class Declined(StrideError):
    """Somebody said no: nothing was done."""


def require_consent(question: str, yes: bool) -> None:
    """Ask on the terminal, unless `--yes` has answered. Raises Declined or InputError."""
    if yes:
        return
    if not sys.stdin.isatty():
        raise InputError(f"{question} There is no terminal to ask on: --yes says yes")
    sys.stderr.write(f"{question} [y/N] ")
    sys.stderr.flush()
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise Declined("nothing was done")
