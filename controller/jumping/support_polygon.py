"""The supporting polygon: the ground between the feet, over which the body is balanced.

Seed 004_2880d7939e94ed85, section 3.2.2: the outer edges of the feet, a line between the toes and
one between the heels; the convex hull of the contact points is that for parallel feet, and also
holds for feet that are not.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from hil.convex_hull import convex_hull
from hil.errors import InputError
from hil.interface import Floats


@dataclass(frozen=True, slots=True)
class SupportPolygon:
    """A convex polygon in the ground plane.

    With vertices p_i, counter-clockwise, and w_i = p_i × p_{i+1}: area A = ½·Σw_i, centre
    c = Σ(p_i + p_{i+1})·w_i/(6A). A point's margin is its least signed distance from an edge.
    """

    vertices: Floats
    """Counter-clockwise [m], shape (v, 2)."""

    @classmethod
    def of(cls, points: Floats) -> Self:
        """Hull of contact points [m], shape (..., 2) or (..., 3), of which z is left out.

        Raises InputError for points on one line, on which nothing stands.
        """
        vertices = convex_hull(points.reshape(-1, points.shape[-1])[:, :2])
        if len(vertices) < 3:
            raise InputError("support polygon: the contact points lie on one line")
        return cls(vertices)

    @property
    def centre(self) -> Floats:
        """Centroid of the area [m], shape (2,)."""
        # Relative to a vertex: far from the origin the cross products would lose digits.
        local = self.vertices - self.vertices[0]
        following = np.roll(local, -1, axis=0)
        crossed = local[:, 0] * following[:, 1] - local[:, 1] * following[:, 0]
        moment = ((local + following) * crossed[:, None]).sum(axis=0)
        centre: Floats = self.vertices[0] + moment / (3.0 * crossed.sum())
        return centre

    def margin(self, point: Floats) -> float:
        """How far a point (shape (2,) or more) is inside [m], below 0 outside."""
        edges = np.roll(self.vertices, -1, axis=0) - self.vertices
        away = point[:2] - self.vertices
        crossed = edges[:, 0] * away[:, 1] - edges[:, 1] * away[:, 0]
        return float((crossed / np.hypot(edges[:, 0], edges[:, 1])).min())
