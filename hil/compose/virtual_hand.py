"""The hand of a virtual robot in another process, for commands that tell a person what to do."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sim_backends.virtual.remote import RemoteWorld


@contextmanager
def virtual_hand(control: Path) -> Iterator[RemoteWorld]:
    """The world behind a control socket; let go in the end. Raises BackendError."""
    world = RemoteWorld(control)
    try:
        yield world
    finally:
        world.close()
