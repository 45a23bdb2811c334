"""The clock of a plant without wires: time passes when the loop sleeps."""

from collections.abc import Callable, Sequence

from hil.interface import Readable
from sim_backends.plant import Plant


class PlantClock:
    """Virtual time on which a plant is stepped; starts at the plant's own time."""

    def __init__(
        self,
        plant: Plant,
        before_substep: Callable[[int], None],
        after_substep: Callable[[], None],
    ) -> None:
        """`before_substep` gets the grid time at which the substep to come ends [ns]."""
        self._plant = plant
        self._now_ns = plant.time_ns
        self._grid_ns = plant.grid_time_ns(plant.substep_index + 1)
        self._before = before_substep
        self._after = after_substep

    def now_ns(self) -> int:
        """Current time [ns]."""
        return self._now_ns

    def sleep_until_ns(self, time_ns: int) -> None:
        """Step the plant through every grid point up to an absolute time."""
        plant = self._plant
        while self._grid_ns <= time_ns:
            self._now_ns = self._grid_ns
            self._before(self._now_ns)
            plant.substep()
            self._after()
            self._grid_ns = plant.grid_time_ns(plant.substep_index + 1)
        self._now_ns = max(self._now_ns, time_ns)

    def wait_readable(self, ports: Sequence[Readable], deadline_ns: int) -> None:
        """Sleep to the deadline, unless a port has bytes: nothing arrives in between."""
        if not any(port.in_waiting for port in ports):
            self.sleep_until_ns(deadline_ns)
