"""The convex hull of points in the plane."""

import numpy as np

from hil.interface import Floats

Point = tuple[float, ...]


def convex_hull(points: Floats) -> Floats:
    """Hull of points of shape (k, 2), counter-clockwise (Andrew's monotone chain), shape (v, 2).

    Points that agree to a nanometre are one; points on an edge are left out.
    """
    ordered = sorted(map(tuple, np.round(points, 9).tolist()))
    lower, upper = _half_hull(ordered), _half_hull(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _half_hull(points: list[Point]) -> list[Point]:
    chain: list[Point] = []
    for point in points:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
