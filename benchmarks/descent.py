"""Cyclic coordinate descent on drawn targets: how many it reaches, in how many sweeps and how long.

Targets for the ankle of the left leg: at angles drawn within the limits (reachable), beside the
same leg's reach by 10 to 60 % (not). Prints one line a robot and kind.
"""

import argparse
from dataclasses import replace
from time import process_time

import numpy as np

from controller.jumping.ccd import SWEEPS, CcdSolution, solve_ccd, sweep
from controller.jumping.chain import JointChain, leg_chain
from controller.robot_model import RobotModel
from hil.interface import Floats
from hil.robot_files import load_robot

TOLERANCE = 1e-3
"""Share of the leg."""


def targets(chain: JointChain, leg: float, kind: str, rng: np.random.Generator) -> Floats:
    """One target [m], shape (1, 3)."""
    if kind != "out of reach":
        return chain.points(rng.uniform(chain.lower, chain.upper))
    direction = rng.normal(size=3)
    away = rng.uniform(1.1, 1.6) * leg * direction / np.linalg.norm(direction)
    return chain.anchors[:1] + away


def plain(chain: JointChain, start: Floats, target: Floats, tolerance: float) -> CcdSolution:
    """The seed's algorithm and nothing else."""
    angles, distance, done = start, np.inf, 0
    while distance > tolerance and done < SWEEPS:
        angles, distance = sweep(chain, angles, target)
        done += 1
    return CcdSolution(angles, distance, done, distance <= tolerance)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--targets", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for name in ("human", "minibiped"):
        description = load_robot(name)
        robot = RobotModel(description)
        leg = robot.leg_length
        chain = leg_chain(robot, description, 0)
        chain = replace(chain, tip=chain.anchors[-1:])  # one point, as the seed has it
        start = np.array(description.start_position)[chain.joints]
        tenth = options.targets // 10
        for kind, count in (
            ("reachable", options.targets), ("plain", tenth), ("out of reach", tenth),
        ):  # fmt: skip
            rng = np.random.default_rng(options.seed)
            begin, found = process_time(), []
            for _ in range(count):
                target = targets(chain, leg, kind, rng)
                if kind == "plain":
                    found.append(plain(chain, start, target, TOLERANCE * leg))
                else:
                    found.append(solve_ccd(chain, start, target, tolerance=TOLERANCE * leg))
            spent = 1e3 * (process_time() - begin) / count
            sweeps = np.percentile([each.sweeps for each in found], (50, 90, 100))
            print(
                f"{name:10} {kind:12} converged {sum(each.converged for each in found)} of "
                f"{count}; sweeps: median {sweeps[0]:.0f}, 9 in 10 within "
                f"{sweeps[1]:.0f}, most {sweeps[2]:.0f}; {spent:.1f} ms each"
            )


if __name__ == "__main__":
    main()
