"""Where the time of a tick goes: every part's own time [µs], the same walk repeated.

A walk in lockstep is the same every time, so of each tick and part the least of all repeats is
kept: what the machine did meanwhile drops out. Own time is without the parts called inside.

Run: `python benchmarks/tick_parts.py human --stabilizer` (see `--help`).
"""

import argparse
import tempfile
from collections.abc import Callable
from contextlib import closing
from importlib import import_module
from pathlib import Path
from time import perf_counter_ns
from typing import Any

import numpy as np

from hil.compose import build
from hil.loop import Loop
from hil.recorder import Recorder
from hil.request import RunRequest
from hil.run_folder import make_meta

STABILIZER = "controller.walking.stabilizer"
TORQUE_PARTS = (
    "controller.robot_model.RobotModel.set_state",
    "controller.walking.step_planner.StepPlanner.update",
    "controller.walking.torque_walker.TorqueWalker._aim_swing_leg",
    "controller.walking.torque_law.TorqueLaw.torques",
    "controller.walking.pose_tracking.PoseTracking.torques",
    "controller.walking.torque_law.TorqueLaw._push_body",
    "controller.walking.implicit_pd.ImplicitPd.correct",
    f"{STABILIZER}.stabilizer.Stabilizer.add_torques",
    f"{STABILIZER}.response.ResponseModel.place",
    f"{STABILIZER}.response.ResponseModel.forces",
    f"{STABILIZER}.stabilizer.Stabilizer._search",
)
SERVO_PARTS = (
    "controller.walking.servo_step.ServoStep.update",
    "controller.robot_model.RobotModel.set_state",
    "controller.walking.support_force.SupportForce.torques",
    "controller.walking.balance.Balance.ground_reaction",
    "controller.walking.leg_targets.LegPlanner.solve",
)
TICK_PARTS = (
    "hil.cycle.Cycle.tick",
    "hil.cycle.Cycle._hand_over",
    "hil.timing.TickSchedule.wait",
    "hil.timing.TickSchedule.finish",
    "hil.schedule.Operator.reference",
    "hil.safety.supervisor.Supervisor.judge",
    "hil.limits.JointLimits.apply",
    "hil.recorder.Recorder.put",
    "controller.estimation.truth.TruthEstimator.update",
    "controller.estimation.sensors.SensorEstimator.update",
    "controller.walking.torque_walker.TorqueWalker.step",
    "controller.walking.servo_walker.ServoWalker.step",
    "sim_backends.mujoco_backend.MujocoBackend.read",
    "sim_backends.mujoco_backend.MujocoBackend.write",
    "sim_backends.plant.Plant.truth",
    "drivers.robot_backend.BusBackend.read",
    "drivers.robot_backend.BusBackend.write",
)


class PartTimes:
    """Own time of every part in every tick of one walk; ticks are calls of the root part."""

    def __init__(self, names: list[str], root: str, ticks: int) -> None:
        self.names, self._root = names, root
        self.own_ns = np.zeros((len(names), ticks), dtype=np.int64)
        self._tick = -1
        self._inner = [0]

    def wrapped(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, timed."""
        place, root, inner = self.names.index(name), name == self._root, self._inner

        def timed(*args: Any, **kwargs: Any) -> Any:
            if root:
                self._tick += 1
            inner.append(0)
            begin = perf_counter_ns()
            result = function(*args, **kwargs)
            spent = perf_counter_ns() - begin
            own = spent - inner.pop()
            inner[-1] += spent
            if 0 <= self._tick < self.own_ns.shape[1]:
                self.own_ns[place, self._tick] += own
            return result

        return timed


def walk_once(request: RunRequest, names: list[str], ticks: int) -> np.ndarray:
    """Own times [ns] of one walk, shape (parts, ticks)."""
    times = PartTimes(names, names[0], ticks)
    originals = []
    for name in names:
        owner, function = _resolve(name)
        originals.append((owner, name.rpartition(".")[2], function))
        setattr(owner, originals[-1][1], times.wrapped(name, function))
    try:
        session = build(request)
        with tempfile.TemporaryDirectory() as folder:
            recorder = Recorder(Path(folder), make_meta(session), truth=True, progress=False)
            with closing(session), recorder:
                session.backend.open()
                Loop(session, (recorder,)).run()
    finally:
        for owner, attribute, function in originals:
            setattr(owner, attribute, function)
    return times.own_ns


def _resolve(name: str) -> tuple[type, Callable[..., Any]]:
    path, _, method = name.rpartition(".")
    module, _, owner = path.rpartition(".")
    found = getattr(import_module(module), owner)
    return found, getattr(found, method)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("robot")
    parser.add_argument("--backend")
    parser.add_argument("--pd")
    parser.add_argument("--stabilizer", action="store_true")
    parser.add_argument("--solver", default=None)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--duration", type=float, default=5.0)
    parser.add_argument("--repeats", type=int, default=8)
    parser.add_argument("--whole", action="store_true", help="all parts of the tick, else the step")
    parser.add_argument("--total", action="store_true", help="the root alone, without its parts")
    args = parser.parse_args()
    request = RunRequest.checked(
        robot=args.robot, backend=args.backend, pd=args.pd, stabilizer=args.stabilizer or None,
        stabilizer_solver=args.solver, overrides=tuple(args.set), rate_hz=300,
        duration_s=args.duration,
    )  # fmt: skip
    torque = args.robot == "human"
    steps = TORQUE_PARTS if torque else SERVO_PARTS
    root = TICK_PARTS[10 if torque else 11]
    names = list(TICK_PARTS) if args.whole else [root, *steps]
    if args.total:
        names = names[:1]
    least = None
    for _ in range(args.repeats):
        found = walk_once(request, names, round(300 * args.duration))
        least = found if least is None else np.minimum(least, found)
    mean_us = least.mean(axis=1) * 1e-3
    for name, value in sorted(zip(names, mean_us, strict=True), key=lambda pair: -pair[1]):
        if value:
            print(f"{value:9.2f} µs  {name}")
    print(f"{mean_us.sum():9.2f} µs  in all")


if __name__ == "__main__":
    main()
