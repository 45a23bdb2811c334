"""What a person's hands do to a limp robot, as data: for the virtual robot, which has a hand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Cell = tuple[str, str]
"""Side and corner."""


@dataclass(frozen=True, slots=True)
class Deed:
    """One thing that hands do, and then hold; what is not named stays as it was.

    In terms of the body as it is, whatever encoders, cells and the IMU make of it.
    """

    joints: Mapping[str, float] = field(default_factory=dict)
    """Angles to bring joints to, and hold them at [rad], by name."""
    free: tuple[str, ...] = ()
    """Joints to let go of."""
    tilt: tuple[float, float] | None = None
    """Roll and pitch to bring the torso to [rad]: leaning left is a negative roll, leaning forward
    a positive pitch."""
    lifted: bool | None = None
    """Whether the torso is held up in the air, or held where it stands."""
    released: bool = False
    """The robot stands on its feet; hands at the torso only lean it."""
    load: Mapping[Cell, float] | None = None
    """Forces on cells [N], instead of those before."""

    def as_request(self) -> dict[str, Any]:
        """For the control socket of a virtual robot; a deed without anything is only a question."""
        request: dict[str, Any] = {"do": "hand"}
        if self.joints:
            request["joints"] = dict(self.joints)
        if self.free:
            request["free"] = list(self.free)
        if self.tilt is not None:
            request["tilt"] = list(self.tilt)
        if self.lifted is not None:
            request["lifted"] = self.lifted
        if self.released:
            request["released"] = True
        if self.load is not None:
            request["load"] = {f"{side}:{corner}": n for (side, corner), n in self.load.items()}
        return request
