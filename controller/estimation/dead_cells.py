"""Load cells that give no signal: found out, and replaced by what the other three say."""

from collections.abc import Sequence

FOOT_LOAD = 0.3
"""Share of the weight that makes a foot count as loaded."""
SIGNAL = 0.06
"""Share of the weight that shows that a cell lives."""
SILENCE_S = 1.5
"""A cell silent for so long on a loaded foot counts as dead."""


class DeadCells:
    """Replaces f_c by max(0, f_a + f_b − f_o) of the neighbours a, b and the opposite corner o.

    A rigid sole on even pads has forces linear in place, in which that is an equality. A cell
    counts as dead after 1.5 s of a loaded foot without a signal of its own, and as alive at once
    when it shows one: a sole that stands on its edge unloads cells too.
    """

    def __init__(self, weight: float, dt: float) -> None:
        self._loaded, self._signal = FOOT_LOAD * weight, SIGNAL * weight
        self._patience = round(SILENCE_S / dt)
        self._silent = [[0] * 4, [0] * 4]

    def repair(self, foot: int, forces: Sequence[float]) -> list[float]:
        """The foot's corner forces [N], front left and right, rear left and right, repaired."""
        silent = self._silent[foot]
        if sum(forces) > self._loaded:
            for corner, force in enumerate(forces):
                silent[corner] = 0 if force > self._signal else silent[corner] + 1
        repaired = list(forces)
        if max(silent) > self._patience:
            corner = silent.index(max(silent))
            opposite = forces[3 - corner]
            neighbours = sum(forces) - forces[corner] - opposite
            repaired[corner] = max(0.0, neighbours - opposite)
        return repaired
