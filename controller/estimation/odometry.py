"""Where the base is and how fast it moves: loaded sole corners do not move on flat ground."""

import mujoco
import numpy as np

from hil.interface import Bools, Floats


class CornerOdometry:
    """Every loaded corner is an anchor that votes with its load.

    r_c is the position of corner c against the base origin in world axes, and w_c = f_c/Σf. A
    corner on the ground is at rest, so the base moves by −Σ w_c·Δr_c in a tick; its velocity is
    −Σ w_c·ṙ_c, with ṙ_c = v_f + ω_f × (r_c − o) from the twist of its foot; the ground is flat at
    z = 0, so the base's height is −Σ w_c·r_c,z.
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
        self.position: Floats = np.zeros(3)
        """Base origin in the world [m]."""
        self.velocity: Floats = np.zeros(3)
        """World axes [m/s]."""

    def update(
        self, corners: Floats, twists: Floats, origin: Floats, force: Floats, contact: Bools
    ) -> None:
        """Take one tick.

        `corners` against the base [m], (2, 4, 3); `twists` of the feet against the base, (2, 6),
        angular before linear, of the point `origin`, (3,); filtered corner forces [N], (2, 4);
        contact flags, (2,).
        """
        self._in_contact = (self._in_contact + self._dt) * contact
        load = np.maximum(force, 0.0)
        load *= (self._in_contact >= self._trust_time)[:, None]
        total = float(load.sum())
        last = corners if self._last is None else self._last
        if total > self._floor:
            load /= total
            self._anchor(corners - last, corners, load)
            self._set_velocity(corners, twists, origin, load)
        else:
            self.position += self.velocity * self._dt
        self._last = corners

    def _anchor(self, moved: Floats, corners: Floats, share: Floats) -> None:
        flat = share.ravel()
        self.position -= flat @ moved.reshape(8, 3)
        self.position[2] = -(flat @ corners.reshape(8, 3))[2]

    def _set_velocity(self, corners: Floats, twists: Floats, origin: Floats, share: Floats) -> None:
        velocity, turning = np.zeros(3), np.empty(3)
        for foot in range(2):
            foot_share = share[foot]
            carried = float(foot_share.sum())
            lever = foot_share @ corners[foot] - carried * origin
            mujoco.mju_cross(turning, twists[foot, :3], lever)
            velocity -= carried * twists[foot, 3:] + turning
        self.velocity = velocity
