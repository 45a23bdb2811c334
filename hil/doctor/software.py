"""Python, MuJoCo, and drawing without a screen."""

from hil.doctor.machine import Finding, Machine

LEAST_PYTHON = (3, 11)
LEAST_MUJOCO = (4, 0)
SPARSE_WRONG = "4.0.0"
"""Its solvers are wrong with sparse Jacobians (mujoco issue 3767)."""
LIBRARIES = ("usr/lib/*/lib{}.so*", "usr/lib/lib{}.so*", "usr/lib64/lib{}.so*")
WAYS = {"egl": "EGL", "osmesa": "OSMesa"}
"""How MuJoCo draws off screen, and the library that each needs."""


def python(machine: Machine) -> Finding:
    """Whether this Python is new enough."""
    if _numbers(machine.python)[:2] >= LEAST_PYTHON:
        return Finding("OK", "python", machine.python)
    return Finding(
        "FAIL", "python", machine.python,
        f"install Python {LEAST_PYTHON[0]}.{LEAST_PYTHON[1]} or newer, then: make setup",
    )  # fmt: skip


def mujoco(machine: Machine) -> Finding:
    """Whether MuJoCo is there, and which."""
    found = machine.package("mujoco")
    if found is None:
        return Finding("FAIL", "mujoco", "not installed", "pip install 'mujoco>=4.0.0'")
    if _numbers(found)[:2] < LEAST_MUJOCO:
        return Finding("FAIL", "mujoco", found, "pip install 'mujoco>=4.0.0'")
    if found == SPARSE_WRONG:
        return Finding("OK", "mujoco", f"{found}: wrong with sparse Jacobians, ours are dense")
    return Finding("OK", "mujoco", found)


def drawing(machine: Machine) -> Finding:
    """Whether videos can be drawn: EGL or OSMesa, or the one that MUJOCO_GL names."""
    wanted = machine.environment.get("MUJOCO_GL", "").strip().lower()
    install = "for stride video: apt-get install libegl1 libgl1-mesa-dri (or libosmesa6)"
    if wanted and wanted not in WAYS:
        return Finding(
            "WARN", "drawing", f"MUJOCO_GL={wanted} needs a display", "unset MUJOCO_GL, or egl"
        )
    names = [wanted] if wanted else list(WAYS)
    there = [
        name
        for name in names
        if machine.find(*(pattern.format(WAYS[name]) for pattern in LIBRARIES))
    ]
    if there:
        return Finding("OK", "drawing", f"{WAYS[there[0]]} is installed")
    return Finding("WARN", "drawing", f"no {' or '.join(WAYS[n] for n in names)}", install)


def _numbers(version: str) -> tuple[int, ...]:
    """Leading numbers of a version."""
    numbers = []
    for part in version.split("."):
        digits = "".join(character for character in part if character.isdigit())
        if not digits:
            break
        numbers.append(int(digits))
    return tuple(numbers)
