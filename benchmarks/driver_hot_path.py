"""CPU time of the servo hot path against dynamixel-sdk's group classes, on a port that never waits.

Run: `python benchmarks/driver_hot_path.py`
"""

from drivers.dynamixel.hot_path_bench import measure_hot_path
from drivers.dynamixel.silent_bench import measure_silent


def main() -> None:
    print(f"{'':26s}{'ours':>9s}{'sdk':>9s}{'sdk fast':>10s}{'ours/sdk':>10s}")
    for row in measure_hot_path():
        print(
            f"{row.name:26s}{row.ours_us:7.1f} µs{row.sdk_classic_us:6.1f} µs"
            f"{row.sdk_fast_us:7.1f} µs{row.ratio:10.2f}"
        )
    print("\none of 12 servos falls silent: first cycle, its CPU, later cycles, heard in them")
    for silent in measure_silent():
        print(
            f"{silent.name:26s}{silent.first_ms:7.2f} ms{silent.first_cpu_ms:6.2f} ms"
            f"{silent.later_ms:7.2f} ms{silent.heard:7d}"
        )


if __name__ == "__main__":
    main()
