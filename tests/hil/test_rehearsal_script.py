"""The rehearsal script speaks commands that exist: its rungs are climbed in other tests."""

import importlib.util
import sys
from pathlib import Path

import pytest
import typer

from hil.cli.main import app

ROOT = Path(__file__).parents[2]
_SPEC = importlib.util.spec_from_file_location("rehearsal", ROOT / "benchmarks" / "rehearsal.py")
rehearsal = importlib.util.module_from_spec(_SPEC)
sys.modules["rehearsal"] = rehearsal
_SPEC.loader.exec_module(rehearsal)

LIVE = [rung for _, ladder in rehearsal.stages(Path("robot.yaml"), 6.0) for rung in ladder]


@pytest.mark.parametrize("rung", [*LIVE, *rehearsal.dry_rungs(6.0)], ids=lambda rung: rung.name)
def test_every_rung_is_a_command(rung):
    group = typer.main.get_command(app)
    words = [*rung.command, "--rate", "100"] if rung.command[0] != "setup" else [*rung.command]
    with group.make_context("stride", [], resilient_parsing=True) as context:
        name, command, rest = group.resolve_command(context, words)
        command.make_context(name, rest)


def test_nothing_moves_a_real_robot_before_it_was_limp_and_refused():
    names = [rung.name for rung in LIVE]
    order = ["limp", "ground, too early", "stand", "hoisted", "ground", "sit"]
    assert [name for name in names if name in order] == order
    moving = {rung.name for rung in LIVE if "--live" in rung.command}
    assert moving == {"ground, too early", "stand", "hoisted", "ground", "sit"}
