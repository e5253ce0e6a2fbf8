"""The same study on a Dask cluster of two workers, one of which is killed."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

from comparisons.cli import main
from comparisons.sweep import workers
from tests.comparisons.sweep.conftest import tiny
from tests.comparisons.sweep.test_command import CASES, histories, recorded, table, wait_for

distributed = pytest.importorskip("distributed")


@pytest.fixture
def cluster() -> Iterator[Any]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as found:
        yield found


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker(cluster: Any, tmp_path: Path) -> None:
    study, here, there = (
        tiny(tmp_path / "tiny.toml", CASES // 3),
        tmp_path / "here.sqlite",
        tmp_path / "there.sqlite",
    )
    victim = next(iter(cluster.workers.values())).pid
    killed = list[int]()

    def kill() -> None:
        wait_for(lambda: recorded(there) >= 3)
        killed.append(recorded(there))
        os.kill(victim, signal.SIGKILL)

    killer = Thread(target=kill)
    killer.start()
    status = main(["study", str(study), "--results", str(there), "--cluster", cluster.scheduler_address])
    killer.join()
    assert status == 0
    assert 3 <= killed[0] < CASES
    assert main(["study", str(study), "--results", str(here), "--workers", "1"]) == 0
    assert table(there) == table(here)
    assert histories(there) == histories(here)


@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:9"])
def test_no_cluster_there(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(workers, "CLUSTER_PATIENCE", 0.5)
    study = tiny(tmp_path / "tiny.toml", 2)
    status = main(["study", str(study), "--results", str(tmp_path / "a.sqlite"), "--cluster", address])
    assert status == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"crossval: cluster {address}: ")
