"""A box to jump onto, or down from."""

import mujoco

Extent = tuple[float, float, float, float, float]
"""From x, to x, from y, to y, height [m]."""
PLATFORM = "platform"


def add_platform(spec: mujoco.MjSpec, extent: Extent) -> None:
    """Put a box on the floor, with the floor's own surface."""
    x0, x1, y0, y1, height = extent
    floor = next(g for g in spec.worldbody.geoms if g.type == mujoco.mjtGeom.mjGEOM_PLANE)
    box = spec.worldbody.add_geom(
        name=PLATFORM,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[(x1 - x0) / 2.0, (y1 - y0) / 2.0, height / 2.0],
        pos=[(x0 + x1) / 2.0, (y0 + y1) / 2.0, height / 2.0],
    )
    for key in ("friction", "solref", "solimp", "condim", "solmix", "priority", "margin", "gap"):
        setattr(box, key, getattr(floor, key))
    box.contype, box.conaffinity = floor.contype, floor.conaffinity
