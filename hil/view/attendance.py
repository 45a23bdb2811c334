"""Whoever watches or steers one run: the view, the devices, and what they are connected to."""

import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hil.errors import InputError
from hil.interface import Ints
from hil.loop import Loop
from hil.pacer import Pacer
from hil.request import KEYS
from hil.run_folder import rung
from hil.session import Session
from hil.steering.gamepad import Gamepad
from hil.steering.helm import Helm
from hil.steering.limits import SteerLimits, steer_limits
from hil.steering.steering import Steering
from hil.view.feed import ViewFeed

TOLD = 8
"""The newest faults that the view is told of: a tick packs them, and a message has an end."""


@dataclass(frozen=True, slots=True)
class Attendance:
    """What the command line asked for; nothing, in most runs."""

    helm: Helm | None = None
    steering: Steering | None = None
    feed: ViewFeed | None = None
    pacer: Pacer | None = None

    def sinks(self, last_row: Callable[[], Ints]) -> tuple[ViewFeed, ...]:
        """What a tick is handed to after the recorder, whose last row this is."""
        if self.feed is None:
            return ()
        self.feed.follow(last_row)
        return (self.feed,)

    def follow(self, loop: Loop, session: Session) -> None:
        """From now on the view is told why the supervisor does what it does."""
        if self.feed is not None:
            self.feed.facts = lambda: {
                "statistics": session.backend.statistics(),
                "faults": [asdict(fault) for fault in loop.outcome.faults[-TOLD:]],
            }

    def close(self) -> None:
        """End the view."""
        if self.feed is not None:
            self.feed.close()


def attend(session: Session) -> Attendance:
    """Open what a run's request asks for. Raises InputError, with nothing left open."""
    request = session.request
    if request.view is None and request.steer is None:
        return Attendance()
    waits = request.steered and not session.description.start.moving
    limits = steer_limits(session.description)
    rate_hz = request.rate_hz or session.description.defaults.rate_hz
    pushes = session.world is not None
    helm = Helm(limits, rate_hz, dead_man=request.live, pushes=pushes) if request.steered else None
    if request.steer == KEYS and not sys.stdin.isatty():
        raise InputError("--steer keys: standard input is no terminal whose keys could be heard")
    pad = request.steer if request.steer not in (None, KEYS) else None
    gamepad = None if pad is None else Gamepad(Path(pad), limits)
    feed = None if request.view is None else ViewFeed(_job(session, limits, rate_hz), rate_hz)
    if feed is not None:
        sys.stderr.writelines(f"stride: view: {line}\n" for line in feed.place.splitlines())
    if waits:
        sys.stderr.write("stride: it will stand until it is told to begin: Start, or Enter\n")
    view = None if feed is None else feed.socket
    return Attendance(helm, Steering(helm, gamepad, view), feed, Pacer() if request.paced else None)


def _job(session: Session, limits: SteerLimits, rate_hz: int) -> dict[str, Any]:
    """What the view's process must know."""
    request, description = session.request, session.description
    return {
        "view": request.view,
        "robot": request.robot,
        "overrides": list(request.overrides),
        "joints": len(description.joints),
        "truth": session.world is not None,
        "rate_hz": rate_hz,
        "rung": rung(session),
        "steered": request.steered,
        "bounds": asdict(limits) | ({} if session.world is not None else {"push": 0.0}),
    }
