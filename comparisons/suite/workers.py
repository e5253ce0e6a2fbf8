"""Where cases run: processes of this machine, or a Dask cluster."""

import logging
import os
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection

from comparisons.extras import install
from comparisons.scene.tables import InputError

Workers = Callable[[], AbstractContextManager[tuple[Executor, int]]]
"""Gives an executor, and the number of cases to have under way; its end by an exception ends what runs."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of a worker: numerical libraries use one thread, so that times of cases are comparable."""
CLUSTER_PATIENCE = 10.0
"""Seconds to wait for the cluster."""


class WorkersError(InputError):
    """Workers that cannot be had, or are gone: one line."""


@contextmanager
def local(count: int | None) -> Iterator[tuple[Executor, int]]:
    """Give `count` processes of this machine, by default one for each processor core."""
    count = count or os.cpu_count() or 1
    main = str(getattr(sys.modules["__main__"], "__file__", ""))
    if main.startswith("<"):
        raise WorkersError(
            "workers", f"cannot load {main}: a program from standard input must be a file to start processes"
        )
    context, before = get_context("spawn"), {k: v for k, v in os.environ.items() if k in ONE_THREAD}
    # nothing is sent: the workers see the pipe close when this process closes it or dies
    watched, held = context.Pipe(duplex=False)
    executor = ProcessPoolExecutor(count, mp_context=context, initializer=_end_with, initargs=(watched,))
    os.environ.update(ONE_THREAD)
    try:
        yield executor, count
    finally:
        for name in ONE_THREAD:
            del os.environ[name]
        os.environ.update(before)
        held.close()
        executor.shutdown(cancel_futures=True)
        watched.close()


def _end_with(parent: Connection) -> None:
    """Let this worker end when `parent` closes, in the middle of a case if need be."""

    def watch() -> None:
        with suppress(EOFError, OSError):
            parent.recv()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def cluster(address: str) -> Iterator[tuple[Executor, int]]:
    """Give the workers of the Dask cluster whose scheduler is at `address`, as ``tcp://127.0.0.1:8786``; they need this package.

    The scheduler itself gives the cases of a worker that died to another one, and gives a case up after
    `distributed.scheduler.allowed-failures` deaths. A `WorkersError` says that the extra or the scheduler is missing.
    """
    try:
        from distributed import Client
    except ImportError:
        raise WorkersError(f"cluster {address}", f"needs distributed: {install('distributed')}") from None
    logging.disable()  # what is an exception here anyway would be printed with its traceback
    try:
        try:
            client = Client(address, timeout=CLUSTER_PATIENCE)
        except (OSError, ValueError, AssertionError) as error:
            # a busy machine does not start the client's loop within the ten seconds that distributed asserts
            raise WorkersError(f"cluster {address}", str(error) or "the client did not start") from None
        with client:
            executor: Executor = client.get_executor(retries=1, pure=False)
            try:
                yield executor, 2 * max(sum(client.ncores().values()), 4)
            finally:
                executor.shutdown(wait=False)
    finally:
        logging.disable(logging.NOTSET)
