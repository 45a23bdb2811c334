"""CPU time of the servo hot path against dynamixel-sdk's group classes, on a port that never waits.

Run: `python benchmarks/driver_hot_path.py`
"""

from drivers.dynamixel.hot_path_bench import measure_hot_path


def main() -> None:
    print(f"{'':26s}{'ours':>9s}{'sdk':>9s}{'sdk fast':>10s}{'ours/sdk':>10s}")
    for row in measure_hot_path():
        print(
            f"{row.name:26s}{row.ours_us:7.1f} µs{row.sdk_classic_us:6.1f} µs"
            f"{row.sdk_fast_us:7.1f} µs{row.ratio:10.2f}"
        )


if __name__ == "__main__":
    main()
