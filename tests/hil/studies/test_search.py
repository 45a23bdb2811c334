"""The offline search: finds the minimum, and always the same one."""

import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from search_fakes import InThisProcess, bowls

from hil.errors import InputError, StrideError
from hil.studies.run import run_study
from hil.studies.search.budget import SearchBudget
from hil.studies.search.space import SearchSpace

PROGRAM = Path(__file__).parent / "search_fakes.py"
ROOT = Path(__file__).parents[3]


def searched(tmp_path, **settings):
    """What a search in this process finds."""
    return bowls(tmp_path / "log", **settings).conduct(InThisProcess()).rows[0]


def studied(tmp_path, name, jobs, **settings):
    """The same with workers and a folder."""
    return run_study(bowls(tmp_path / "log", **settings), tmp_path / name, jobs).result.rows[0]


def test_the_minimum_within_the_bounds_is_found(tmp_path):
    row = searched(tmp_path)
    assert row["vector"] == pytest.approx([1.0, 2.0, 2.5], abs=0.05)
    assert row["cost"] == pytest.approx(0.1 * 0.5**2, abs=0.01)
    assert row["evaluations"] == 1 + 60 * 6
    assert row["ended"] == "iterations"
    assert sorted(row["history"], reverse=True) == row["history"]


def test_workers_do_not_change_the_result_and_the_seed_does(tmp_path):
    none = searched(tmp_path, iterations=6)
    assert studied(tmp_path, "one", 1, iterations=6) == none
    assert studied(tmp_path, "two", 2, iterations=6) == none
    assert searched(tmp_path, iterations=6, seed=2)["vector"] != none["vector"]


def test_a_start_that_nothing_beats_is_the_result_and_the_run_is_still(tmp_path):
    row = searched(tmp_path, start=(1.0, 2.0, 2.5), patience=3)
    assert row["vector"] == [1.0, 2.0, 2.5]
    assert row["ended"] == "still"
    assert row["iterations"] == 3


def test_a_candidate_that_cannot_be_run_ends_the_search(tmp_path):
    with pytest.raises(StrideError, match="bowl: x is not for this robot"):
        searched(tmp_path, start=(-3.9, 0.0, 0.0))


def test_a_killed_search_resumes_to_the_same_result(tmp_path):
    log, out = tmp_path / "log", tmp_path / "out"
    log.mkdir()
    path = os.pathsep.join((str(ROOT), str(PROGRAM.parent)))
    environment = {**os.environ, "PYTHONPATH": path}
    program = subprocess.Popen(
        [sys.executable, str(PROGRAM), str(log), str(out)],
        env=environment, stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip
    end = time.monotonic() + 60
    while len(list(log.iterdir())) < 30:
        assert time.monotonic() < end
        time.sleep(0.02)
    os.killpg(program.pid, signal.SIGKILL)
    program.communicate()
    kept = (out / "cases.jsonl").read_text().count("\n")
    assert 20 <= kept < 121
    before = len(list(log.iterdir()))
    study = bowls(log, wait_s=0.05, iterations=20)
    resumed = run_study(study, out, jobs=2).result.rows[0]
    assert len(list(log.iterdir())) - before == 121 - kept
    assert resumed == searched(tmp_path, iterations=20)


def test_the_checkpoint_of_another_search_is_refused(tmp_path):
    studied(tmp_path, "out", 1, iterations=1)
    with pytest.raises(InputError, match=r"other settings\.seed"):
        studied(tmp_path, "out", 1, iterations=1, seed=2)


def test_progress_names_the_best_cost(tmp_path, capsys):
    row = searched(tmp_path, iterations=2)
    assert f"bowl, best {row['cost']:.6g}: 13 of 13 cases" in capsys.readouterr().err


def test_a_start_outside_its_bounds_is_named():
    with pytest.raises(InputError, match=r"knee\.kp: starts at 3, outside 0 to 2"):
        SearchSpace(("hip.kp", "knee.kp"), (1.0, 3.0), 0.1, (0.0, 0.0), (2.0, 2.0))


def test_the_population_grows_with_the_variables():
    assert SearchBudget().population_of(18) == 4 + math.floor(3 * math.log(18)) == 12
    assert SearchBudget(population=6).population_of(18) == 6
