"""The coronal cycle of the seeds' evaluation: a sideways speed that changes every few steps."""

from hil.schedule import Point

STEPS_A_LEG = 5
"""Seed 000_bd1305a0ae731442, section 4: 0, 0.2, −0.2 m/s, each for five steps."""
SIGNS = (0.0, 1.0, -1.0)
FROUDE_SPEED = 0.0662
"""0.2 m/s of the seeds' character (L = 0.93 m) as v/√(gL)."""


def coronal_cycle(amplitude: float, step_s: float, duration_s: float) -> tuple[Point, ...]:
    """Coronal speeds 0, +amplitude, −amplitude [m/s], each for five steps of a mean time [s].

    The command jumps: two points at the same time.
    """
    leg_s = STEPS_A_LEG * step_s
    points: list[Point] = [(0.0, 0.0)]
    for leg in range(1, int(duration_s / leg_s) + 1):
        before, after = SIGNS[(leg - 1) % 3] * amplitude, SIGNS[leg % 3] * amplitude
        points += [(leg * leg_s, before), (leg * leg_s, after)]
    return tuple(points)
