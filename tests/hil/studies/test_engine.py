"""Cases run once, in any number of processes, and survive whatever happens to the study."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from study_fakes import numbers

from hil.errors import InputError, StrideError
from hil.studies.folder import StudyFolder
from hil.studies.run import run_study

PROGRAM = Path(__file__).parent / "study_fakes.py"
ROOT = Path(__file__).parents[3]


def start(log, out):
    """The tiny study in a process of its own."""
    path = os.pathsep.join((str(ROOT), str(PROGRAM.parent)))
    command = [sys.executable, str(PROGRAM), str(log), str(out)]
    log.mkdir()
    return subprocess.Popen(
        command,
        env={**os.environ, "PYTHONPATH": path},
        stderr=subprocess.PIPE,
        text=True,
        # A shell that runs us in the background has us ignore Ctrl-C, which a child inherits.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def wait_for(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def finished(out):
    path = out / "cases.jsonl"
    return path.read_text().count("\n") if path.exists() else 0


def alive(pid):
    """Whether a process is there and no zombie."""
    try:
        return " Z " not in Path(f"/proc/{pid}/stat").read_text()
    except FileNotFoundError:
        return False


def ran(log):
    """Case numbers, once for every time that one was begun."""
    return sorted(int(path.name.split("-")[0]) for path in log.iterdir())


def workers(log):
    return {int(path.name.split("-")[1]) for path in log.iterdir()}


def test_a_killed_study_resumes_and_leaves_no_worker_behind(tmp_path):
    log, out = tmp_path / "log", tmp_path / "out"
    program = start(log, out)
    wait_for(lambda: finished(out) >= 3)
    program.kill()
    program.communicate()
    wait_for(lambda: not any(alive(pid) for pid in workers(log)))
    kept = finished(out)
    assert 3 <= kept < 12
    before = ran(log)
    with (out / "cases.jsonl").open("a") as file:
        file.write('{"case": {"number": 11')  # what a crash of the machine may leave
    study = numbers(log, count=12, wait_s=0.3)
    run = run_study(study, out, jobs=2)
    assert [row["square"] for row in run.result.rows if row["number"] != 5] == [
        number**2 for number in range(12) if number != 5
    ]
    assert len(ran(log)) - len(before) == 12 - kept
    assert finished(out) == 12
    for line in (out / "cases.jsonl").read_text().splitlines():
        json.loads(line)


def test_an_interrupt_ends_the_study_at_once_and_says_where_it_is(tmp_path):
    log, out = tmp_path / "log", tmp_path / "out"
    program = start(log, out)
    wait_for(lambda: finished(out) >= 1)
    program.send_signal(signal.SIGINT)
    _, errors = program.communicate(timeout=10)
    assert program.returncode != 0
    assert f"finished cases are kept in {out}" in errors
    assert not any(alive(pid) for pid in workers(log))
    assert 1 <= finished(out) < 12


def test_results_do_not_depend_on_the_number_of_jobs(tmp_path):
    one = run_study(numbers(tmp_path / "log"), tmp_path / "one", jobs=1)
    assert len(workers(tmp_path / "log")) == 1
    two = run_study(numbers(tmp_path / "log"), tmp_path / "two", jobs=2)
    assert one.result.rows == two.result.rows
    for name in ("numbers.csv", "numbers.png"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_an_error_of_ours_is_a_result_and_the_csv_holds_every_case(tmp_path):
    run = run_study(numbers(tmp_path / "log", count=7), tmp_path / "out", jobs=2)
    with (tmp_path / "out" / "numbers.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[3] == {"number": "3", "square": "9", "error": ""}
    assert rows[5] == {"number": "5", "square": "", "error": "five is not for this robot"}
    assert len(rows) == 7 and run.folder == tmp_path / "out"


def test_a_finished_study_runs_nothing_again(tmp_path):
    study = numbers(tmp_path / "log", count=3)
    first = run_study(study, tmp_path / "out", jobs=1)
    second = run_study(study, tmp_path / "out", jobs=2)
    assert ran(tmp_path / "log") == [0, 1, 2]
    assert second.result.rows == first.result.rows


def test_a_defect_stops_the_study_and_names_the_case(tmp_path):
    with pytest.raises(ZeroDivisionError) as caught:
        run_study(numbers(tmp_path / "log", first=97, count=100), tmp_path / "out", jobs=1)
    notes = " ".join(caught.value.__notes__)
    assert finished(tmp_path / "out") == 2
    assert '"number": 99' in notes and "finished cases are kept" in notes


def test_a_worker_that_dies_is_told(tmp_path):
    with pytest.raises(StrideError, match="worker process died"):
        run_study(numbers(tmp_path / "log", first=19, count=22), tmp_path / "out", jobs=1)
    assert finished(tmp_path / "out") == 1


def test_a_folder_of_another_study_is_refused(tmp_path):
    run_study(numbers(tmp_path / "log", count=2), tmp_path / "out", jobs=1)
    for other, difference in (
        (numbers(tmp_path / "log", count=3), "settings.count"),
        (numbers(tmp_path / "log", count=2, robot="minibiped"), "settings.request"),
    ):
        with pytest.raises(InputError, match=difference):
            run_study(other, tmp_path / "out", jobs=1)
    assert ran(tmp_path / "log") == [0, 1]


def test_a_study_without_results_gives_way_to_another(tmp_path):
    with StudyFolder(numbers(tmp_path / "log", count=2), tmp_path / "out"):
        pass
    run = run_study(numbers(tmp_path / "log", count=1), tmp_path / "out", jobs=1)
    assert run.result.rows[0]["square"] == 0
    (tmp_path / "else").mkdir()
    (tmp_path / "else" / "study.json").write_text('{"title": "mine"}')
    with pytest.raises(InputError, match="other study, robot"):
        run_study(numbers(tmp_path / "log", count=1), tmp_path / "else", jobs=1)


def test_a_folder_of_something_else_is_refused_and_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(InputError, match="holds no study"):
        run_study(numbers(tmp_path / "log", count=2), tmp_path, jobs=1)
    assert not (tmp_path / "study.json").exists()


def test_two_processes_do_not_share_a_folder(tmp_path):
    log, out = tmp_path / "log", tmp_path / "out"
    program = start(log, out)
    wait_for(lambda: finished(out) >= 1)
    with pytest.raises(InputError, match="another process"):
        run_study(numbers(log, count=12, wait_s=0.3), out, jobs=1)
    program.kill()
    program.communicate()


def test_changed_code_is_told(tmp_path):
    study = numbers(tmp_path / "log", count=2)
    run_study(study, tmp_path / "out", jobs=1)
    path = tmp_path / "out" / "study.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"git_commit": "0123456789ab"}))
    assert "0123456789ab" in run_study(study, tmp_path / "out", jobs=1).notes[0]
