import sys
from pathlib import Path

import pytest

# Worker processes import the fakes by name: they get this process's sys.path.
sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def cluster():
    """A Dask scheduler and two workers, each a process of its own."""
    reason = "no Dask here: pip install 'stridebridge[cluster]'"
    distributed = pytest.importorskip("distributed", reason=reason)
    dask = pytest.importorskip("dask", reason=reason)
    # One worker that dies is enough to give up.
    once = dask.config.set({"distributed.scheduler.allowed-failures": 0})
    with once, distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
    ) as found:  # fmt: skip
        yield found
