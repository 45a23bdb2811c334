"""What each effect of the servo model costs a physics substep of the minibiped.

    python benchmarks/substep_costs.py

Prints, for the nominal robot and with one effect at a time, microseconds of one whole substep and
of the servos' share in it: minima over many short runs that take turns, so that ratios hold on a
busy machine too.
"""

import time
from collections.abc import Callable

import numpy as np

from hil.robot_files import load_robot
from hil.servo import ServoGoals
from sim_backends.plant import Plant
from sim_backends.virtual.motors import nominal_motors

ROUNDS, SUBSTEPS = 300, 32
NOMINAL = "plant.draws=null"
CASES = {
    "nominal": (NOMINAL,),
    "backlash": (NOMINAL, "backlash=0.01"),
    "uneven floor": (NOMINAL, "floor_height=0.001"),
    "Stribeck and load friction": (NOMINAL, "stribeck_friction=0.024", "load_friction=0.234"),
    "latency of two ticks": (NOMINAL, "latency_ticks=2"),
    "everything that is drawn": (),
    "position I gain on every servo": (NOMINAL,),
    "profile on every servo": (NOMINAL,),
    "current mode on every servo": (NOMINAL,),
}


def standing(name: str, overrides: tuple[str, ...]) -> Plant:
    """The robot on its feet, torque on."""
    description = load_robot("minibiped", overrides)
    plant = Plant(description, 300, 1, nominal_motors(description))
    if plant.servos is None:
        raise SystemExit("the minibiped has no servos")
    n = len(description.joints)
    goals = np.rint(plant.servos.counts).astype(np.int64)
    full = np.full(n, 885)
    plant.servos.set_goals(ServoGoals(goals, np.full(n, 800), np.zeros(n, np.int64), full))
    for servo in range(n):
        plant.servos.set_enabled(servo, True)
    for firmware in plant.servos.firmware:
        if "I gain" in name:
            firmware.i_gain = 10
        elif "profile" in name:
            firmware.profile.configure(100, 20, False)
        elif "current" in name:
            firmware.mode = 0
    plant.servos.refresh()
    if "current" not in name:
        plant.set_support(False)
    for _ in range(600):
        plant.substep()
    return plant


def fastest(actions: dict[str, Callable[[], object]]) -> dict[str, float]:
    """Shortest time of one call of each action [µs]."""
    best = dict.fromkeys(actions, np.inf)
    for _ in range(ROUNDS):
        for name, action in actions.items():
            start = time.perf_counter()
            for _ in range(SUBSTEPS):
                action()
            best[name] = min(best[name], (time.perf_counter() - start) / SUBSTEPS)
    return {name: 1e6 * seconds for name, seconds in best.items()}


def main() -> None:
    """Print the table."""
    plants = {name: standing(name, overrides) for name, overrides in CASES.items()}
    whole = fastest({name: plant.substep for name, plant in plants.items()})
    servos = fastest({name: plant.drive for name, plant in plants.items()})
    print(f"{'':34s}{'substep':>10s}{'servos':>10s}   [µs]")
    for name in CASES:
        print(f"{name:34s}{whole[name]:10.1f}{servos[name]:10.1f}")


if __name__ == "__main__":
    main()
