"""Samples of the stabilizer one after the other and in parallel: time of a batch [µs].

Batches are a generation of the CMA search (5) and all it may try (25). Every way predicts the
same forces of the whole human in mid-stance; least of many repeats.

Run: `python benchmarks/parallel_samples.py`
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from time import perf_counter_ns

import mujoco
import numpy as np
from mujoco import batch, rollout

from controller.robot_model import RobotModel
from controller.walking.stabilizer.model_choice import ModelChoice
from controller.walking.stabilizer.response import ResponseModel
from hil.compose import build
from hil.cycle import TickRecord
from hil.interface import Floats
from hil.loop import Loop
from hil.request import RunRequest

RATE_HZ = 300
WALK_S = 4.2
THREADS = 2
REPEATS = 400
VELOCITY_STAGE = int(mujoco.mjtStage.mjSTAGE_VEL)


class LastTick:
    """A sink that keeps the last tick."""

    def put(self, record: TickRecord) -> None:
        """Remember it."""
        self.record = record


def placed_model() -> ResponseModel:
    """The whole human's model, placed in a walk."""
    session = build(RunRequest.checked(robot="human", rate_hz=RATE_HZ, duration_s=WALK_S))
    sink = LastTick()
    with closing(session):
        session.backend.open()
        Loop(session, (sink,)).run()
    robot = RobotModel(session.description)
    record = sink.record
    robot.set_state(record.estimate)
    stance = record.status.stance
    model = ModelChoice("M0", session.description, robot, 1.0 / RATE_HZ).choose(stance, False)
    model.place(record.command.torque, stance)
    return model


def least_us(function: Callable[[], object]) -> float:
    """Shortest time of a call."""
    times = []
    for _ in range(REPEATS):
        begin = perf_counter_ns()
        function()
        times.append(perf_counter_ns() - begin)
    return min(times) * 1e-3


def ways(response: ResponseModel, forces: Floats) -> dict[str, Callable[[], object]]:
    """Ways to evaluate a batch; `forces` are its generalised forces, shape (samples, nv)."""
    model, data = response.model, response.data
    copies = [mujoco.MjData(model) for _ in range(THREADS)]
    pool = ThreadPoolExecutor(THREADS)
    state = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states = np.tile(state, (len(forces), 1))
    many = batch.Batch(model, nsim=len(forces), nthread=THREADS)
    qpos, qvel, applied = many.bind("qpos"), many.bind("qvel"), many.bind("qfrc_applied")
    first_guess = many.bind("qacc_warmstart")
    roller = rollout.Rollout(nthread=THREADS)

    def serial(own: mujoco.MjData, part: Floats) -> None:
        for row in part:
            own.qfrc_applied[:] = row
            mujoco.mj_forwardSkip(model, own, VELOCITY_STAGE, 1)

    def threads() -> None:
        def work(own: mujoco.MjData, part: Floats) -> None:
            mujoco.mj_copyData(own, model, data)
            serial(own, part)

        list(pool.map(work, copies, np.array_split(forces, THREADS)))

    def batched() -> None:
        qpos[:], qvel[:], applied[:] = data.qpos, data.qvel, forces
        first_guess[:] = data.qacc_warmstart  # each batch is new: no iteration saved
        many.step()

    def rolled() -> None:
        roller.rollout(
            model, copies, states, forces[:, None, :],
            control_spec=int(mujoco.mjtState.mjSTATE_QFRC_APPLIED), nstep=1,
        )  # fmt: skip

    return {
        "mj_forwardSkip, one after the other": lambda: serial(data, forces),
        f"mj_forwardSkip, {THREADS} threads on copies": threads,
        f"mujoco.batch, {THREADS} threads": batched,
        f"mujoco.rollout, {THREADS} threads": rolled,
    }


def main() -> None:
    response = placed_model()
    base = response.data.qfrc_applied.copy()
    for samples in (5, 25):
        forces = np.tile(base, (samples, 1))
        forces[:, response.dofs] += np.random.default_rng(0).normal(0.0, 5.0, (samples, 3))
        for name, way in ways(response, forces).items():
            print(f"{samples:3d} samples {least_us(way):8.1f} µs  {name}")


if __name__ == "__main__":
    main()
