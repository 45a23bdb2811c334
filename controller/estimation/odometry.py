"""Where the base is and how fast it moves: loaded sole corners do not move on flat ground."""

from collections.abc import Sequence

from controller.robot_model import RobotModel

Vector = tuple[float, float, float]
Pose = tuple[list[float], list[list[float]]]
"""Centre of a sole box and its rotation matrix."""


class CornerOdometry:
    """Every loaded corner is an anchor that votes with its load.

    r_c is the position of corner c against the base origin in world axes, and w_c = f_c/Σf. A
    corner on the ground is at rest, so the base moves by −Σ w_c·Δr_c in a tick; its velocity is
    −Σ w_c·ṙ_c, with ṙ_c = v_f + ω_f × (r_c − o) from the twist of its foot; the ground is flat at
    z = 0, so the base's height is −Σ w_c·r_c,z.
    Σ w_c·r_c over a foot is W·c + R·Σ w_c·s_c, with W = Σ w_c, c and R the pose of its sole box and
    s_c the corner in it.
    A foot that has just landed is trusted only after `trust_time`: it still settles, and filtered
    joint velocities still show its swing. Without a trusted load the velocity is kept and the base
    moves on with it.
    """

    def __init__(self, model: RobotModel, dt: float, trust_time: float) -> None:
        self._model = model
        self._floor = 0.1 * model.weight
        self._dt = dt
        self._trust_time = trust_time
        self._in_contact = [trust_time, trust_time]
        self._front_left: list[list[float]] = model.corner_offsets[:, 0].tolist()
        self._last: list[Pose] = []
        self.position: Vector = (0.0, 0.0, 0.0)
        """Base origin in the world [m]."""
        self.velocity: Vector = (0.0, 0.0, 0.0)
        """World axes [m/s]."""

    def update(self, corners: Sequence[Sequence[float]], contact: Sequence[bool]) -> None:
        """Take one tick, with the model at its present state but the base at rest at the origin.

        `corners` are filtered forces [N], four a foot; `contact` the feet's flags.
        """
        model = self._model
        present = [
            (centre.tolist(), rotation.tolist())
            for centre, rotation in zip(model.soles, model.sole_rotations, strict=True)
        ]
        shares = self._shares(corners, contact)
        if shares is not None:
            self._move(self._last or present, present, shares)
        else:
            (x, y, z), (u, v, w), dt = self.position, self.velocity, self._dt
            self.position = (x + u * dt, y + v * dt, z + w * dt)
        self._last = present

    def _shares(
        self, corners: Sequence[Sequence[float]], contact: Sequence[bool]
    ) -> list[list[float]] | None:
        """Share w_c of each corner in what trusted feet carry; none where that is too little."""
        loads = []
        for foot, forces in enumerate(corners):
            time = self._in_contact[foot] + self._dt if contact[foot] else 0.0
            self._in_contact[foot] = time
            trusted = time >= self._trust_time
            loads.append([force if trusted and force > 0.0 else 0.0 for force in forces])
        total = sum(loads[0]) + sum(loads[1])
        if total <= self._floor:
            return None
        return [[load / total for load in foot] for foot in loads]

    def _move(self, last: list[Pose], present: list[Pose], shares: list[list[float]]) -> None:
        x, y, height = *self.position[:2], 0.0
        u = v = w = 0.0
        ox, oy, oz = self._model.com.tolist()
        for foot, share in enumerate(shares):
            carried = sum(share)
            if carried == 0.0:
                continue
            point = self._loaded_point(foot, share)
            before = _placed(last[foot], carried, point)
            px, py, pz = _placed(present[foot], carried, point)
            x, y, height = x - (px - before[0]), y - (py - before[1]), height - pz
            rx, ry, rz, vx, vy, vz = self._model.foot_twists[foot].tolist()
            px, py, pz = px - carried * ox, py - carried * oy, pz - carried * oz
            u -= carried * vx + ry * pz - rz * py
            v -= carried * vy + rz * px - rx * pz
            w -= carried * vz + rx * py - ry * px
        self.position, self.velocity = (x, y, height), (u, v, w)

    def _loaded_point(self, foot: int, share: Sequence[float]) -> Vector:
        """Σ w_c·s_c of the sole's corners."""
        a, b, c, d = share
        x, y, z = self._front_left[foot]
        return x * (a + b - c - d), y * (a - b + c - d), z * (a + b + c + d)


def _placed(pose: Pose, carried: float, point: Vector) -> Vector:
    """W·c + R·p of a pose (c, R)."""
    (cx, cy, cz), ((xx, xy, xz), (yx, yy, yz), (zx, zy, zz)) = pose
    x, y, z = point
    return (
        carried * cx + xx * x + xy * y + xz * z,
        carried * cy + yx * x + yy * y + yz * z,
        carried * cz + zx * x + zy * y + zz * z,
    )
