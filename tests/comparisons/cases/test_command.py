"""`crossval study FILE` in processes of its own: killed, interrupted, in company, out of room, on a cluster."""

import os
import random
import resource
import signal
import sqlite3
import subprocess
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from time import monotonic, sleep

import pytest

from comparisons.cases.results import read_results, result_rows
from comparisons.cli import main
from comparisons.output import csv_text
from tests.comparisons.cases.conftest import tiny

CASES = 30
"""Of the tiny study."""
KILLS = 20
"""A third while the libraries are loaded, the others after 1 to 8 cases more; of the command alone or of its workers too."""
Start = Callable[..., "subprocess.Popen[str]"]


def table(file: Path) -> str:
    return csv_text(result_rows(read_results(file), timings=False))


def histories(file: Path) -> dict[str, str]:
    """Every number of every result but seconds and memory, by key."""
    return {
        result.key: replace(result.measurement, seconds=0.0, peak_memory=0).to_json()
        for result in read_results(file)
    }


def recorded(file: Path) -> int:
    """Number of results in a file that may not be there yet."""
    try:
        with closing(sqlite3.connect(f"{file.as_uri()}?mode=ro", uri=True)) as connection:
            return int(connection.execute("SELECT count(*) FROM result").fetchone()[0])
    except sqlite3.Error:
        return 0


def wait_for(condition: Callable[[], bool], seconds: float = 60) -> None:
    deadline = monotonic() + seconds
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


def running(group: int) -> list[int]:
    """Processes of a group that are not dead."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] not in "ZX":
            found.append(int(entry.parent.name))
    return found


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of the tiny study, uninterrupted."""
    folder = tmp_path_factory.mktemp("whole")
    study = tiny(folder / "tiny.toml", CASES // 3)
    assert main(["study", str(study), "--out", str(folder), "--workers", "1"]) == 0
    return folder / "tiny.sqlite"


@pytest.mark.slow
@pytest.mark.parametrize("kept", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_results_of_another_version(kept: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Half of them, wrong ones: computed anew, or kept when that is asked for; one line says which."""
    command = [
        "study",
        str(tiny(tmp_path / "tiny.toml", 2)),
        "--out",
        str(tmp_path),
        "--workers",
        "1",
        "--quiet",
    ]
    file = tmp_path / "tiny.sqlite"
    assert main(command) == 0
    assert capsys.readouterr().err == ""
    right = histories(file)
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute(
            "UPDATE result SET version = '0.1.0', key = 'x' || key, status = 'WRONG' WHERE label LIKE '% 5'"
        )
    assert main([*command, *(["--keep-old-versions"] if kept else [])]) == 0
    out, err = capsys.readouterr()
    what = "kept" if kept else "left aside, and the cases computed anew"
    assert err == f"crossval: 3 results of other versions (0.1.0) were {what}\n"
    assert ("WRONG 3" in out) is kept
    found = histories(file)
    assert len(found) == (6 if kept else 9)
    assert (found.items() >= right.items()) is not kept
    assert main(command) == 0
    assert capsys.readouterr().err == (
        "crossval: 3 results of other versions (0.1.0) were left aside, and the cases computed anew\n"
        if kept
        else ""
    )


def killed(process: "subprocess.Popen[str]", file: Path, chance: random.Random) -> bool:
    """Kill the command, or all its processes, at a random point; whether it was still at work."""
    if chance.random() < 1 / 3:
        # while interpreter and libraries are loaded
        sleep(chance.uniform(0, 1))
    else:
        goal = recorded(file) + chance.randint(1, 8)
        wait_for(lambda: recorded(file) >= min(goal, CASES) or process.poll() is not None)
        sleep(chance.uniform(0, 0.05))
    at_work = process.poll() is None
    if at_work:
        chance.choice((os.kill, os.killpg))(process.pid, signal.SIGKILL)
    process.communicate()
    wait_for(lambda: not running(process.pid))
    return at_work


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc to see what is left running")
def test_killed_at_twenty_random_points(whole: Path, tmp_path: Path, start: Start) -> None:
    """20 times kill -9, over as many studies as that takes: each ends with the tables of one that was left alone."""
    study = tiny(tmp_path / "tiny.toml", CASES // 3)
    chance, hit, files = random.Random(7), list[int](), list[Path]()  # noqa: S311 - no secret
    while len(hit) < KILLS:
        file = tmp_path / f"{len(files)}.sqlite"
        files.append(file)
        while recorded(file) < CASES and len(hit) < KILLS:
            if killed(start("study", study, "--results", file, "--workers", "2"), file, chance):
                hit.append(recorded(file))
    for file in files:
        assert main(["study", str(study), "--results", str(file), "--workers", "1"]) == 0
        assert table(file) == table(whole)
        assert histories(file) == histories(whole)
    assert len(set(hit)) > KILLS // 4, "the points are spread over the study"
    print(f"killed with {sorted(hit)} cases done, in {len(files)} studies")


@pytest.mark.slow
def test_four_runs_on_one_file(whole: Path, tmp_path: Path, start: Start) -> None:
    study, file = tiny(tmp_path / "tiny.toml", CASES // 3), tmp_path / "a.sqlite"
    runs = [start("study", study, "--results", file, "--workers", "1") for _ in range(4)]
    ends = [(run.communicate(), run.returncode) for run in runs]
    assert all(status == 0 for _, status in ends), ends
    assert all(out.startswith("tiny: 30 cases: COMPLETED 30\n") for (out, _), _ in ends)
    assert table(file) == table(whole)
    assert histories(file) == histories(whole)


@pytest.mark.slow
@pytest.mark.parametrize("whom", ["command", "group"])
def test_interrupted_and_gone_on(whom: str, whole: Path, tmp_path: Path, start: Start) -> None:
    study, file = tiny(tmp_path / "tiny.toml", CASES // 3), tmp_path / "a.sqlite"
    process = start("study", study, "--results", file, "--workers", "2")
    wait_for(lambda: recorded(file) >= 3)
    (os.kill if whom == "command" else os.killpg)(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert out == ""
    assert err.splitlines()[-1] == "crossval: interrupted"
    assert "Traceback" not in err
    assert "Warning" not in err
    kept = histories(file)
    assert 3 <= len(kept) < CASES
    assert main(["study", str(study), "--results", str(file), "--workers", "1"]) == 0
    assert kept.items() <= histories(file).items()
    assert table(file) == table(whole)


@pytest.mark.slow
def test_out_of_room(tmp_path: Path, start: Start) -> None:
    """A limit on the size of files stops the command like a full disk: one line, and everything before it kept."""
    study, file = tiny(tmp_path / "tiny.toml", CASES // 3), tmp_path / "a.sqlite"

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, resource.RLIM_INFINITY))

    process = start("study", study, "--results", file, "--workers", "2", preexec_fn=limit)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2, err
    assert err.splitlines()[-1].startswith(f"crossval: {file}: cannot be written: ")
    assert "Traceback" not in err
    with closing(sqlite3.connect(file)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert 0 < recorded(file) < CASES
    assert main(["study", str(study), "--results", str(file), "--workers", "1"]) == 0
    assert recorded(file) == CASES
