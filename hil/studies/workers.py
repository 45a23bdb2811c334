"""Where the cases of a study run: processes of this machine, or a Dask cluster."""

from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context
from typing import Any

from hil import __version__
from hil.errors import InputError, StrideError
from hil.studies.worker import prepare_worker, worker_version

CONNECT_S = 10.0
"""How long a scheduler may take to answer, and its first worker to come [s]."""


@contextmanager
def local_processes(jobs: int) -> Iterator[Executor]:
    """Worker processes of this machine; killed, not waited for, when the block raises."""
    others = set(active_children())
    spawn = get_context("spawn")  # no copied threads, and the same on every system
    pool = ProcessPoolExecutor(jobs, spawn, prepare_worker)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in set(active_children()) - others:
            worker.kill()
        raise
    finally:
        pool.shutdown()


@contextmanager
def dask_workers(address: str) -> Iterator[Executor]:
    """The workers of a Dask scheduler at `tcp://HOST:PORT`; their cases end when the block raises.

    Raises InputError for a scheduler that does not answer, has no workers, or has workers with
    another version of this program than here.
    """
    client = _connect(address)
    from distributed import KilledWorker

    executor = client.get_executor(retries=0)
    try:
        yield executor
    except KilledWorker as error:
        raise StrideError("a worker process died") from error
    except CancelledError as error:
        raise StrideError(f"--scheduler {address}: the scheduler is gone") from error
    finally:
        executor.shutdown(wait=False)  # cancels what still runs
        client.close()


def _connect(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError(
            "--scheduler needs the extra 'cluster': pip install 'stridebridge[cluster]'"
        ) from error
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler {address}: no Dask scheduler answers there") from error
    try:
        _check_workers(client, address)
    except BaseException:
        client.close()
        raise
    return client


def _check_workers(client: Any, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=CONNECT_S)
    except TimeoutError as error:
        raise InputError(f"--scheduler {address}: has no workers") from error
    try:
        versions = client.run(worker_version)
    except ImportError as error:
        raise InputError(f"--scheduler {address}: its workers lack this program") from error
    for worker, version in versions.items():
        if version != __version__:
            raise InputError(
                f"--scheduler {address}: worker {worker} has version {version}, here is "
                f"{__version__}"
            )
