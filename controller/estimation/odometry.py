"""Where the base is and how fast it moves: loaded sole corners do not move on flat ground."""

import numpy as np

from hil.interface import Bools, Floats


class CornerOdometry:
    """Every loaded corner is an anchor that votes with its load.

    r_c and ṙ_c are position and velocity of corner c against the base origin, in world axes, and
    w_c = f_c/Σf. A corner on the ground is at rest, so the base moves by −Σ w_c·Δr_c in a tick
    and its velocity is −Σ w_c·ṙ_c; the ground is flat at z = 0, so its height is −Σ w_c·r_c,z.
    A foot that has just landed is trusted only after `trust_time`: it still settles, and filtered
    joint velocities still show its swing. Without a trusted load the velocity is kept and the base
    moves on with it.
    """

    def __init__(self, weight: float, dt: float, trust_time: float) -> None:
        self._floor = 0.1 * weight
        self._dt = dt
        self._trust_time = trust_time
        self._in_contact: Floats = np.full(2, trust_time)
        self._last: Floats | None = None
        self._share: Floats = np.full((2, 4), 0.125)
        self.position: Floats = np.zeros(3)
        """Base origin in the world [m]."""
        self.velocity: Floats = np.zeros(3)
        """World axes [m/s]."""

    def update(
        self, corners: Floats, velocities: Floats, force: Floats, contact: Bools
    ) -> None:
        """Take corner positions [m] and velocities [m/s] against the base, both (2, 4, 3),
        filtered corner forces [N], shape (2, 4), and contact flags, shape (2,)."""
        self._in_contact = np.where(contact, self._in_contact + self._dt, 0.0)
        trusted = self._in_contact >= self._trust_time
        load = np.maximum(force, 0.0) * trusted[:, None]
        total = float(load.sum())
        if self._last is None:
            self._last = corners.copy()
        if total > self._floor:
            self._share = load / total
            self.velocity = -np.tensordot(self._share, velocities)
            self.position -= np.tensordot(self._share, corners - self._last)
            self.position[2] = -np.tensordot(self._share, corners[..., 2])
        else:
            self.position += self.velocity * self._dt
        self._last[...] = corners
