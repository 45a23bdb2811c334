"""Studies on a Dask cluster: the same results, and one line for what does not fit."""

import pytest
from search_fakes import InThisProcess, bowls

from hil.errors import InputError, StrideError
from hil.studies.run import run_study

distributed = pytest.importorskip(
    "distributed", reason="no Dask here: pip install 'stridebridge[cluster]'"
)


def searched(cluster, tmp_path, name, **settings):
    study = bowls(tmp_path / "log", iterations=4, **settings)
    return run_study(study, tmp_path / name, None, cluster.scheduler_address)


def test_a_search_on_a_cluster_finds_what_it_finds_here(cluster, tmp_path):
    there = searched(cluster, tmp_path, "there")
    pids = {path.name.partition("-")[0] for path in (tmp_path / "log").iterdir()}
    assert pids <= {str(pid) for pid in cluster_pids(cluster)}
    study = bowls(tmp_path / "log", iterations=4)
    here = study.conduct(InThisProcess())
    assert there.result.rows == here.rows
    again = run_study(study, tmp_path / "there", 1)  # all is kept: no worker is needed
    assert again.result.rows == here.rows


def test_a_case_that_kills_its_workers_ends_the_study(cluster, tmp_path):
    with pytest.raises(StrideError, match="a worker process died"):
        searched(cluster, tmp_path, "out", start=(2.2, 0.0, 0.0), deadly=True)


def test_workers_with_another_version_are_refused(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr("hil.studies.workers.__version__", "0.0.1")
    with pytest.raises(InputError, match=r"worker tcp://.* has version .*, here is 0\.0\.1"):
        searched(cluster, tmp_path, "out")


def test_a_scheduler_that_is_not_there_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("hil.studies.workers.CONNECT_S", 0.5)
    study = bowls(tmp_path / "log")
    with pytest.raises(InputError, match=r"tcp://127\.0\.0\.1:9: no Dask scheduler"):
        run_study(study, tmp_path / "out", None, "tcp://127.0.0.1:9")
    with pytest.raises(InputError, match="--scheduler nowhere: no Dask scheduler"):
        run_study(study, tmp_path / "out", None, "nowhere")


def test_a_scheduler_without_workers_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("hil.studies.workers.CONNECT_S", 0.5)
    with distributed.LocalCluster(
        n_workers=0, dashboard_address=None, host="127.0.0.1"
    ) as empty, pytest.raises(InputError, match="has no workers"):  # fmt: skip
        run_study(bowls(tmp_path / "log"), tmp_path / "out", None, empty.scheduler_address)


def test_jobs_and_scheduler_exclude_each_other(tmp_path):
    with pytest.raises(InputError, match="--jobs counts processes here"):
        run_study(bowls(tmp_path / "log"), tmp_path / "out", 2, "tcp://127.0.0.1:9")


def cluster_pids(cluster):
    with distributed.Client(cluster, set_as_default=False) as client:
        return client.run(own_pid).values()


def own_pid():
    import os

    return os.getpid()
