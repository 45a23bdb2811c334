"""What the simulated liquid costs a substep, part by part, and an element of its surface.

The human stands at 300 Hz; minima of many repeats, since the machine is shared. The real-time
factor is that of whole ticks, each by the fastest of some equal walks. Cost of an element: slope of
the liquid's time over the number of elements, from surfaces of 4, 2 and 1 cm. The least work of an
element is counted: three multiply-adds for its height, six for its normal speed, ten for its part
of the moments, 19 in all, and their 152 bytes read once.
"""

import argparse
from collections.abc import Callable
from time import perf_counter

import mujoco
import numpy as np

from controller.robot_model import RobotModel
from controller.walking.buoyancy import BuoyancyCompensation
from controller.walking.joint_groups import JointGroups
from hil.cycle import TickRecord
from hil.request import RunRequest
from hil.robot_files import load_robot
from hil.schedule import Schedules
from hil.studies.walks import walk
from sim_backends.plant import Plant
from sim_backends.water.hydrodynamics import Hydrodynamics

LEVELS = (0.25, 0.5, 0.75, 1.0)
WALK_S = 4.0
MULTIPLY_ADDS = 19
ELEMENT_BYTES = 152


def best(work: Callable[[], object], repeats: int) -> float:
    """Shortest time of a call [µs]."""
    times = []
    for _ in range(repeats):
        begin = perf_counter()
        work()
        times.append(perf_counter() - begin)
    return 1e6 * min(times)


def water_of(plant: Plant, cell: float, level: float) -> Hydrodynamics:
    """The liquid around the plant's body, in the state of `mj_step1`."""
    root = mujoco.mj_name2id(plant.model, mujoco.mjtObj.mjOBJ_BODY, plant.description.root)
    water = Hydrodynamics(plant.model, plant.data, root, cell)
    water.set_medium(level, 1000.0, 1.0)
    mujoco.mj_step1(plant.model, plant.data)
    water.act()
    water.withdraw()
    return water


def acting(water: Hydrodynamics) -> None:
    """One substep's share of the liquid."""
    water.act()
    water.withdraw()


class Stamps:
    """A sink that keeps the wall time at which every tick ended."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def put(self, record: TickRecord) -> None:
        """Take the time."""
        if record.time_s >= 0.0:
            self.times.append(perf_counter())


def real_time_factor(level: float, walks: int) -> float:
    """Of `stride walk human` in memory, every tick by the fastest of so many equal walks."""
    water = ((0.0, level),) if level > 0.0 else ()
    request = RunRequest(robot="human", duration_s=WALK_S, schedules=Schedules(water=water))
    ticks = []
    for _ in range(walks):
        stamps = Stamps()
        walk(request, stamps)
        ticks.append(np.diff(stamps.times))
    shortest = np.min([row[: min(map(len, ticks))] for row in ticks], axis=0)
    return len(shortest) / 300 / float(shortest.sum())


def machine_rate() -> float:
    """Multiply-adds of a matrix-vector product that stays in the cache [1/µs]."""
    matrix, vector = np.ones((500, 19)), np.ones(19)
    return matrix.size / best(lambda: matrix @ vector, 3000)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=2000)
    parser.add_argument("--walks", type=int, default=5)
    options = parser.parse_args()
    repeats = options.repeats
    human = load_robot("human")
    plant = Plant(human, 300, initial_velocity=(0.5, 0.0))
    robot = RobotModel(human)
    robot.set_state(plant.truth())
    lift = BuoyancyCompensation(robot, JointGroups(human, robot))
    step = best(lambda: mujoco.mj_forward(plant.model, plant.data), repeats)
    print(f"mj_forward, dry: {step:.0f} us")
    print("level m | elements | liquid us | controller's buoyancy us")
    for level in LEVELS:
        water = water_of(plant, 0.02, level)
        cost = best(lambda water=water: acting(water), repeats)
        own = best(lambda level=level: lift.torques(0, level, 1000.0), repeats)
        print(f"{level:7.2f} | {water.elements:8d} | {cost:9.0f} | {own:5.0f}")
    for level in (0.0, 0.5, 1.0):
        factor = real_time_factor(level, options.walks)
        print(f"whole tick at {level:g} m: {factor:.1f} x real time")
    counts, costs = [], []
    for cell in (0.04, 0.02, 0.01):
        water = water_of(plant, cell, 1.0)
        counts.append(water.elements)
        costs.append(best(lambda water=water: acting(water), repeats))
    slope, fixed = np.polyfit(counts, costs, 1)
    least = 1e3 * MULTIPLY_ADDS / machine_rate()
    print(f"1 m, cells of 4, 2, 1 cm: {counts} elements, {[round(c) for c in costs]} us")
    print(f"an element: {1e3 * slope:.1f} ns; fixed: {fixed:.0f} us")
    print(f"least: {MULTIPLY_ADDS} multiply-adds in {least:.1f} ns, {ELEMENT_BYTES} bytes")


if __name__ == "__main__":
    main()
