"""The same study on a Dask cluster of two workers, one of which is killed."""

import os
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager
from threading import Thread

import distributed
import pytest

from tests.comparisons.suite.conftest import CASES, TINY, check_finished, crossval, recorded, wait_for


@pytest.fixture
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50
    ) as found:
        yield found


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker(cluster, whole, tmp_path):
    victim, killed = next(iter(cluster.workers.values())).pid, list[int]()

    def kill():
        wait_for(lambda: recorded(tmp_path / "tiny") >= 3)
        killed.append(recorded(tmp_path / "tiny"))
        os.kill(victim, signal.SIGKILL)

    killer = Thread(target=kill)
    killer.start()
    status = crossval("run", TINY, "--out", tmp_path, "--workers", cluster.scheduler_address)
    killer.join()
    assert status == 0
    assert 3 <= killed[0] < CASES
    check_finished(tmp_path, whole)


@pytest.mark.slow_at("tcp://127.0.0.1:9")
@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:9"])
def test_no_cluster_there(address, tmp_path, capsys):
    assert crossval("run", TINY, "--out", tmp_path, "--workers", address) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"crossval: cluster {address}: ")


@contextmanager
def dask(program, *arguments):
    """Run a program of Dask beside the test."""
    process = subprocess.Popen(
        [sys.executable, "-m", f"distributed.cli.dask_{program}", *arguments, "--dashboard-address", ":0"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


@pytest.mark.slow
def test_a_scheduler_that_dies_is_one_line_and_keeps_what_is_done(tmp_path, capfd):
    file, port = tmp_path / "tiny", free_port()
    address = f"tcp://127.0.0.1:{port}"
    with dask("scheduler", "--host", "127.0.0.1", "--port", str(port)) as scheduler:

        def kill():
            wait_for(lambda: recorded(file) >= 3)
            scheduler.kill()

        with dask("worker", address, "--nthreads", "1", "--no-nanny"):
            killer = Thread(target=kill)
            killer.start()
            status = crossval("run", TINY, "--out", tmp_path, "--workers", address)
            killer.join()
    assert status == 2
    assert 3 <= recorded(file) < CASES
    err = capfd.readouterr().err.splitlines()
    assert err[-1] == "crossval: cluster: is gone; what has been finished is kept"
    assert all("cases done" in line for line in err[:-1])
