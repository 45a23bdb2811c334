"""One step of each walking controller, in a walk on MuJoCo: mean and p99 [ms].

Run: `python benchmarks/controller_step.py`
"""

from hil.bench import CASES, measure

DURATION_S = 5.0


def main() -> None:
    for case in CASES:
        step = measure(case, DURATION_S)[0]
        print(f"{step.group:24s}{step.value:8.3f} ms, held to {step.held_to:g}: {step.ratio:.2f}")


if __name__ == "__main__":
    main()
