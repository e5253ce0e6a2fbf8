"""Where cases run: processes of this machine, or a Dask cluster."""

import logging
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING

from comparisons.extras import install
from comparisons.scene.tables import InputError

if TYPE_CHECKING:
    from distributed import Client

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of a worker: numerical libraries use one thread, so that times of cases are comparable."""
CLUSTER_PATIENCE = 10.0
"""Seconds to wait for the cluster."""


class WorkersError(InputError):
    """Workers that cannot be had, or are gone: one line."""


@dataclass(frozen=True, kw_only=True)
class Workers:
    """Where cases run: `width` at the same time, on the executor that ``start()`` gives.

    When the context ends by an exception, it ends what runs. `start` is called again after its executor broke. The exceptions `lost` are
    those of a future whose worker died for good, while the executor goes on.
    """

    width: int
    start: Callable[[], AbstractContextManager[Executor]]
    lost: tuple[type[BaseException], ...] = ()


def local(count: int | None = None) -> Workers:
    """Return `count` processes of this machine, by default one for each processor core."""
    width = count or os.cpu_count() or 1
    return Workers(width=width, start=lambda: _processes(width))


@contextmanager
def _processes(count: int) -> Iterator[Executor]:
    main = str(getattr(sys.modules["__main__"], "__file__", ""))
    if main.startswith("<"):
        raise WorkersError(
            "workers", f"cannot load {main}: a program from standard input must be a file to start processes"
        )
    context = get_context("spawn")
    # nothing is sent: the workers see the pipe close when this process closes it or dies
    watched, held = context.Pipe(duplex=False)
    with _environment(ONE_THREAD):
        executor = ProcessPoolExecutor(count, mp_context=context, initializer=_end_with, initargs=(watched,))
        try:
            yield executor
        except BrokenExecutor:
            started = list(executor._processes.values())  # noqa: SLF001 - nothing else knows how a worker ended
            executor.shutdown()
            raise BrokenExecutor(_cause([process.exitcode for process in started])) from None
        finally:
            held.close()
            executor.shutdown(cancel_futures=True)
            watched.close()


def _cause(codes: list[int | None]) -> str:
    """Say how a worker ended; when one dies, the executor ends the others by SIGTERM."""
    code = next((code for code in codes if code not in (None, 0, -signal.SIGTERM)), -signal.SIGTERM)
    how = f"with exit status {code}" if code >= 0 else f"by signal {-code}, {signal.strsignal(-code)}"
    return f"the worker process ended {how}"


def _end_with(parent: Connection) -> None:
    """Let this worker end when `parent` closes, in the middle of a case if need be."""

    def watch() -> None:
        try:
            parent.recv()
        except (EOFError, OSError):
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ[name] for name in values if name in os.environ}
    os.environ.update(values)
    try:
        yield
    finally:
        for name in values:
            del os.environ[name]
        os.environ.update(before)


def cluster(address: str) -> Workers:
    """Return the workers of the Dask cluster whose scheduler is at `address`, as ``tcp://127.0.0.1:8786``; they need this package.

    The scheduler itself gives the cases of a worker that died to another one, and gives a case up after
    `distributed.scheduler.allowed-failures` deaths. A `WorkersError` says that the extra or the scheduler is missing.
    """
    try:
        from distributed import KilledWorker
    except ImportError:
        raise WorkersError(f"cluster {address}", f"needs distributed: {install('distributed')}") from None
    with _client(address) as client:
        cores = sum(client.ncores().values())
    return Workers(width=2 * max(cores, 4), start=lambda: _cluster(address), lost=(KilledWorker,))


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    with _client(address) as client:
        executor: Executor = client.get_executor(retries=1, pure=False)
        try:
            yield executor
        finally:
            executor.shutdown(wait=False)


@contextmanager
def _client(address: str) -> "Iterator[Client]":
    from distributed import Client

    logging.disable()  # what is an exception here anyway would be printed with its traceback
    try:
        try:
            client = Client(address, timeout=CLUSTER_PATIENCE)
        except (OSError, ValueError) as error:
            raise WorkersError(f"cluster {address}", str(error)) from None
        with client:
            yield client
    finally:
        logging.disable(logging.NOTSET)
