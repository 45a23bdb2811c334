"""The end of every run: torque off until it is read back, ports closed."""

from hil.errors import BackendError
from hil.interface import Backend, StopMode
from hil.session import Session

TORQUE_OFF_ATTEMPTS = 5


def stop_and_close(session: Session) -> None:
    """Make a robot safe, whatever state it is in, and release what its session holds.

    Torque goes off first: to hold the last goal before would keep the bus busy for nothing.
    Raises BackendError if torque off could not be verified, else what closing raised.
    """
    try:
        _torque_off(session.backend)
    finally:
        session.close()


def _torque_off(backend: Backend) -> None:
    for _ in range(TORQUE_OFF_ATTEMPTS):
        if backend.stop(StopMode.TORQUE_OFF):
            return
    raise BackendError(
        f"{backend.name}: torque off was sent {TORQUE_OFF_ATTEMPTS} times and never read back: "
        "cut the servo power by hand"
    )
