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

from comparisons.cli import main
from tests.comparisons.cases.conftest import CASES, recorded, wait_for
from tests.comparisons.cases.test_command import check_finished


@pytest.fixture
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50
    ) as found:
        yield found


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker(cluster, tiny, tmp_path):
    here, there = tmp_path / "here.sqlite", tmp_path / "there.sqlite"
    victim = next(iter(cluster.workers.values())).pid
    killed = list[int]()

    def kill():
        wait_for(lambda: recorded(there) >= 3)
        killed.append(recorded(there))
        os.kill(victim, signal.SIGKILL)

    killer = Thread(target=kill)
    killer.start()
    status = main(["study", str(tiny), "--results", str(there), "--cluster", cluster.scheduler_address])
    killer.join()
    assert status == 0
    assert 3 <= killed[0] < CASES
    assert main(["study", str(tiny), "--results", str(here), "--workers", "1"]) == 0
    check_finished(tiny, there, here)


@pytest.mark.slow_at("tcp://127.0.0.1:9")
@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:9"])
def test_no_cluster_there(address, tiny, tmp_path, capsys):
    status = main(["study", str(tiny), "--results", str(tmp_path / "a.sqlite"), "--cluster", address])
    assert status == 2
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
def test_a_scheduler_that_dies_is_one_line_and_keeps_what_is_done(tiny, tmp_path, capfd):
    file, port = tmp_path / "a.sqlite", free_port()
    address = f"tcp://127.0.0.1:{port}"
    with dask("scheduler", "--host", "127.0.0.1", "--port", str(port)) as scheduler:

        def kill():
            wait_for(lambda: recorded(file) >= 3)
            scheduler.kill()

        with dask("worker", address, "--nthreads", "1", "--no-nanny"):
            killer = Thread(target=kill)
            killer.start()
            status = main(["study", str(tiny), "--results", str(file), "--cluster", address])
            killer.join()
    assert status == 2
    assert 3 <= recorded(file) < CASES
    err = capfd.readouterr().err.splitlines()
    assert err[-1] == "crossval: cluster: is gone; what has been finished is kept"
    assert all("cases done" in line for line in err[:-1])
