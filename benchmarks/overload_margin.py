"""How near a walk of the minibiped comes to the modelled overload of its servos.

    python benchmarks/overload_margin.py --speed 0.3 --seed 5 --set plant.draws=null

Prints, joint by joint, the highest persistent load of the walk, as a share of the one that trips
(`sim_backends/servo_protection.py`), and the hottest winding and case. MuJoCo backend, modelled.
"""

import argparse
import tempfile
from contextlib import closing
from pathlib import Path

import numpy as np

from hil.compose import build
from hil.loop import Loop
from hil.recorder import Recorder
from hil.request import RunRequest
from hil.run_folder import make_meta
from hil.schedule import Schedules
from sim_backends.plant import Plant
from sim_backends.servo_protection import OVERLOAD_SHARE


def main() -> None:
    """Walk once and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--speed", type=float, default=0.15)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--duration", type=float, default=8.0)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    arguments = parser.parse_args()
    request = RunRequest(
        robot="minibiped", backend="mujoco", duration_s=arguments.duration, seed=arguments.seed,
        schedules=Schedules(speed=((0.0, arguments.speed),)), overrides=tuple(arguments.set),
    )  # fmt: skip
    session = build(request)
    with tempfile.TemporaryDirectory() as folder:
        recorder = Recorder(Path(folder), make_meta(session), truth=True, progress=False)
        with closing(session), recorder:
            session.backend.open()
            Loop(session, (recorder,)).run()
    plant = session.world
    if not isinstance(plant, Plant) or plant.servos is None:
        raise SystemExit("this robot has no servos")
    shares = plant.servos.protection.highest_load / OVERLOAD_SHARE
    for name, share in zip(session.description.joint_names, shares.tolist(), strict=True):
        print(f"{name:20s} {100 * share:5.0f} %")
    heat = plant.servos.heat
    print(f"winding {np.max(heat.winding):.1f} °C, case {np.max(heat.case):.1f} °C")


if __name__ == "__main__":
    main()
