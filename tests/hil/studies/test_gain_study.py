"""The whole of Algorithm 1 on the human: killed, resumed, on a cluster, and what it refuses."""

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from gain_fakes import tiny
from search_fakes import InThisProcess

from hil.errors import InputError, UnknownNameError
from hil.robot_files import load_robot
from hil.studies.folder import StudyFolder
from hil.studies.gain_range import check_rates
from hil.studies.gain_sets import total_of
from hil.studies.run import run_study
from hil.studies.study import Case

PROGRAM = Path(__file__).parent / "gain_fakes.py"
ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def rows():
    """What the study finds without workers and without an interruption."""
    return tiny().conduct(InThisProcess()).rows


def cases(out):
    path = out / "cases.jsonl"
    return path.read_text().count("\n") if path.exists() else 0


def read(out):
    with (out / "gains.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_killed_study_resumes_and_finds_the_same(rows, tmp_path):
    out = tmp_path / "out"
    path = os.pathsep.join((str(ROOT), str(PROGRAM.parent)))
    program = subprocess.Popen(
        [sys.executable, str(PROGRAM), str(out)],
        env={**os.environ, "PYTHONPATH": path}, stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip
    end = time.monotonic() + 120
    while cases(out) < 13:  # in the second rate
        assert time.monotonic() < end
        assert program.poll() is None, program.stderr.read()
        time.sleep(0.02)
    os.killpg(program.pid, signal.SIGKILL)
    program.communicate()
    kept = cases(out)
    assert kept < 21
    assert {row["rate_hz"] for row in read(out)} == {"300"}  # what was known by then
    resumed = run_study(tiny(), out, jobs=2)
    assert resumed.result.rows == rows
    assert cases(out) == 21
    assert [row["joint_group"] for row in read(out)] == [row["joint_group"] for row in rows]
    assert (out / "gains.png").stat().st_size > 1000


def test_a_cluster_finds_the_same(rows, cluster, tmp_path):
    found = run_study(tiny(), tmp_path / "out", None, cluster.scheduler_address)
    assert found.result.rows == rows


def test_ranges_are_those_of_the_joints_that_may_vary(rows):
    of_rate = {rate: [row for row in rows if row["rate_hz"] == rate] for rate in (300, 275)}
    for found in of_rate.values():
        for row in found:
            moved = row["kp_min"] != row["kp_start"] or row["kp_max"] != row["kp_start"]
            assert moved == (row["joint_group"] in ("knee", "toe"))
        assert found[0]["sum_min"] < found[0]["sum_max"]
        assert found[0]["evaluations"] == 10
    gains = {row["joint_group"]: (row["kp_max"], row["kd_max"]) for row in of_rate[300]}
    assert total_of(load_robot("human"), gains) == pytest.approx(of_rate[300][0]["sum_max"])
    for first, second in zip(*of_rate.values(), strict=True):
        blend = 0.8 * first["kp_min"] + 0.2 * first["kp_max"]
        assert second["kp_start"] == pytest.approx(blend)


def test_the_checkpoint_of_other_settings_is_refused(tmp_path):
    with StudyFolder(tiny(rates_hz=(300,), joints=("toe",)), tmp_path / "out") as folder:
        folder.append(Case(request=tiny().request), {"stopped_s": None})
    with pytest.raises(InputError, match=r"study gains of human with other settings\.joints"):
        run_study(tiny(rates_hz=(300,)), tmp_path / "out", jobs=1)


def test_a_start_set_that_falls_is_named_with_its_rate():
    study = tiny(rates_hz=(60,), warm_s=2.0)
    with pytest.raises(InputError, match=r"the start set falls after \d\.\d s at 60 Hz"):
        study.conduct(InThisProcess())


def test_a_start_set_that_walks_too_slowly_is_named():
    request = tiny().request
    fast = request.model_copy(
        update={"schedules": request.schedules.model_copy(update={"speed": ((0.0, 1.4),)})}
    )
    study = tiny(rates_hz=(300,), request=fast)
    with pytest.raises(InputError, match=r"the start set walks at 0\.\d+ m/s in place of 1\.4"):
        study.conduct(InThisProcess())


def test_a_joint_that_has_no_gains_is_named_with_those_that_have():
    with pytest.raises(UnknownNameError, match="unknown joint 'tail'; valid: root, back, hip"):
        tiny(joints=("tail",)).conduct(InThisProcess())


def test_rates_must_fall():
    assert check_rates("1000,300,225") == (1000, 300, 225)
    with pytest.raises(InputError, match="--rates: must fall"):
        check_rates("225,300")
    with pytest.raises(InputError, match="--rates: '300;225' is not a list"):
        check_rates("300;225")
