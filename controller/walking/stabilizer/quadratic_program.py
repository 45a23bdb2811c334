"""A tiny quadratic program: the smallest change that meets a few linear inequalities."""

from hil.interface import Floats

SWEEPS = 20
_TINY = 1e-12


def nearest(matrix: Floats, bound: Floats, tolerance: float) -> tuple[float, float, float]:
    """Minimise ‖u‖² subject to matrix·u ≥ bound, by Hildreth's dual coordinate ascent (1957).

    `matrix` has shape (k, 3). Stops after a sweep that moves no inequality by more than
    `tolerance`, or after 20: where the inequalities contradict each other, it ends between them.
    With three variables and nine rows, plain Python beats arrays.
    """
    x = y = z = 0.0
    rows = [
        [*row, limit, row[0] * row[0] + row[1] * row[1] + row[2] * row[2], 0.0]
        for row, limit in zip(matrix.tolist(), bound.tolist(), strict=True)
    ]
    rows = [row for row in rows if row[4] > _TINY]
    for _ in range(SWEEPS):
        moved = 0.0
        for row in rows:
            a, b, c, limit, square, price = row
            missing = limit - a * x - b * y - c * z
            change = max(missing / square, -price)
            if change != 0.0:
                row[5] = price + change
                x, y, z = x + change * a, y + change * b, z + change * c
                moved = max(moved, abs(change) * square)
        if moved < tolerance:
            break
    return x, y, z
