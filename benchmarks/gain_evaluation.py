"""What one evaluation of `stride study gains` costs: processor time of this process.

    python benchmarks/gain_evaluation.py [ROBOT] [RATE]

The reference walk, then the same candidate five times: 10 s of the human's walk, head and hands
included. Compiled models are kept from one evaluation to the next.
"""

import sys
import time

from hil.cli.study_gains import LEG_S, WARM_S
from hil.compose.optimisations import gain_space
from hil.request import RunRequest
from hil.robot_facts import robot_facts
from hil.robot_files import load_robot
from hil.studies.gain_walks import (
    CandidateCase,
    GainCase,
    Similar,
    evaluate_gains,
    lateral_speed,
    legs,
    reference_walk,
)

REPEATS = 5


def main(robot: str = "human", rate: str = "300") -> None:
    description = load_robot(robot)
    facts = robot_facts(description)
    warm_s, leg_s = WARM_S * facts.time_scale, LEG_S * facts.time_scale
    request = RunRequest(robot=robot, rate_hz=int(rate)).resolved(description)
    lateral = legs(warm_s, leg_s, lateral_speed(facts.speed_scale))
    schedules = request.schedules.model_copy(update={"lateral": lateral})
    gains = gain_space.gains_at(description, int(rate), request.pd == "implicit")
    case = GainCase(
        request=request.model_copy(update={"schedules": schedules}),
        gains=gains, warm_s=warm_s, leg_s=leg_s,
    )  # fmt: skip
    similar = Similar.model_validate(reference_walk(case)["similar"])
    values = case.model_dump() | {"start": gains, "side": "min", "similar": similar, "cap": None}
    candidate = CandidateCase.model_validate(values)
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        result = evaluate_gains(candidate)
        times.append(time.process_time() - begin)
    walked = case.walk_request.duration_s
    print(f"{robot}, {rate} Hz, {walked:.1f} s of walking, cost {result['cost']:.6g}:")
    print(f"{min(times):.2f} s of one core at least, {sorted(times)[REPEATS // 2]:.2f} s median")


if __name__ == "__main__":
    main(*sys.argv[1:])
