"""What steers one run."""

import socket
from dataclasses import dataclass

from hil.steering.gamepad import Gamepad
from hil.steering.helm import Helm


@dataclass(frozen=True, slots=True)
class Steering:
    """A helm, and the devices beside the terminal that speak to it."""

    helm: Helm | None
    """None where nobody steers: the view can stop the run all the same."""
    gamepad: Gamepad | None = None
    view: socket.socket | None = None
    """Our end of the pair that the live view's process writes into, a line a message."""
