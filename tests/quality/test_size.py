"""Modules stay small and functions short: the limits of the house."""

import ast
from pathlib import Path
from statistics import quantiles

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("hil", "controller", "drivers", "sim_backends")
FILES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
DATA_TABLES = {"drivers/dynamixel/control_table.py", "drivers/dynamixel/servo_models.py",
               "hil/interface.py"}  # fmt: skip


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_module_grows_beyond_300_lines(path):
    if str(path.relative_to(ROOT)) not in DATA_TABLES:
        assert len(path.read_text(encoding="utf-8").splitlines()) <= 300


def functions():
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield path, node


def test_nine_in_ten_functions_are_short():
    lengths = [node.end_lineno - node.lineno + 1 for _, node in functions()]
    assert quantiles(lengths, n=10)[-1] <= 30


def test_no_function_is_longer_than_a_screen():
    long = [
        f"{path.name}:{node.name}"
        for path, node in functions()
        if node.end_lineno - node.lineno + 1 > 60
    ]
    assert not long
