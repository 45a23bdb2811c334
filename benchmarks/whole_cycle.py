"""The whole tick of each rung that runs in lockstep: p99, the loop's own share, speed.

Run: `python benchmarks/whole_cycle.py`
"""

from hil.bench import CASES, measure

DURATION_S = 5.0


def main() -> None:
    for case in CASES:
        for row in measure(case, DURATION_S)[1:]:
            figure = f"{row.value:8.3f} {row.unit}, held to {row.held_to:g}: {row.ratio:.2f}"
            print(f"{row.group:24s}{row.name:30s}{figure}")


if __name__ == "__main__":
    main()
