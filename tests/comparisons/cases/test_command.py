"""`crossval study FILE` in processes of its own: killed, interrupted, in company, out of room, on a cluster."""

import json
import os
import random
import resource
import signal
import sys
import zlib
from pathlib import Path
from time import sleep

import pytest

from comparisons.cli import main
from tests.comparisons.cases.conftest import CASES, TINY, asked, recorded, rows, wait_for

KILLS = 20
"""A third while the libraries are loaded, the others after 1 to 8 cases more; of the command alone or of its workers too."""


def table(file):
    return rows(file, "--no-timings")


def histories(file):
    """Every number of every result but seconds and memory, by key."""
    found = {}
    for key, blob in asked(file, "SELECT key, measurement FROM result"):
        assert isinstance(blob, bytes)
        found[key] = json.loads(zlib.decompress(blob)) | {"seconds": 0.0, "peak_memory": 0}
    return found


def running(group):
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
def whole(tmp_path_factory):
    """The results of the tiny study, uninterrupted."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "tiny.toml").write_text(TINY)
    assert main(["study", str(folder / "tiny.toml"), "--out", str(folder), "--workers", "1"]) == 0
    return folder / "tiny.sqlite"


def check_finished(study, file, whole):
    """The same command goes on to the table of a run that was left alone."""
    assert main(["study", str(study), "--results", str(file), "--workers", "1"]) == 0
    assert table(file) == table(whole)
    assert histories(file) == histories(whole)


def killed(process, file, chance):
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
def test_killed_at_twenty_random_points(whole, tiny, tmp_path, start):
    """20 times kill -9, over as many studies as that takes: each ends with the tables of one that was left alone."""
    chance, hit, files = random.Random(7), list[int](), list[Path]()  # noqa: S311 - no secret
    while len(hit) < KILLS:
        file = tmp_path / f"{len(files)}.sqlite"
        files.append(file)
        while recorded(file) < CASES and len(hit) < KILLS:
            if killed(start("study", tiny, "--results", file, "--workers", "2"), file, chance):
                hit.append(recorded(file))
    for file in files:
        check_finished(tiny, file, whole)
    assert len(set(hit)) > KILLS // 4, "the points are spread over the study"
    print(f"killed with {sorted(hit)} cases done, in {len(files)} studies")


@pytest.mark.slow
def test_four_runs_on_one_file(whole, tiny, tmp_path, start):
    file = tmp_path / "a.sqlite"
    runs = [start("study", tiny, "--results", file, "--workers", "1") for _ in range(4)]
    ends = [(run.communicate(), run.returncode) for run in runs]
    assert all(status == 0 for _, status in ends), ends
    assert all(out.startswith("tiny: 30 cases: COMPLETED 30\n") for (out, _), _ in ends)
    check_finished(tiny, file, whole)


@pytest.mark.slow
@pytest.mark.parametrize("whom", ["command", "group"])
def test_interrupted_and_gone_on(whom, whole, tiny, tmp_path, start):
    file = tmp_path / "a.sqlite"
    process = start("study", tiny, "--results", file, "--workers", "2")
    wait_for(lambda: recorded(file) >= 3)
    (os.kill if whom == "command" else os.killpg)(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "crossval: interrupted"
    assert "Traceback" not in err
    assert "Warning" not in err
    kept = histories(file)
    assert 3 <= len(kept) < CASES
    check_finished(tiny, file, whole)
    assert kept.items() <= histories(file).items()


@pytest.mark.slow
def test_out_of_room(whole, tiny, tmp_path, start):
    """A limit on the size of files stops the command like a full disk: one line, and everything before it kept."""
    file = tmp_path / "a.sqlite"

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, resource.RLIM_INFINITY))

    process = start("study", tiny, "--results", file, "--workers", "2", preexec_fn=limit)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2, err
    assert err.splitlines()[-1].startswith(f"crossval: {file}: cannot be written: ")
    assert "Traceback" not in err
    assert asked(file, "PRAGMA integrity_check") == [("ok",)]
    assert 0 < recorded(file) < CASES
    check_finished(tiny, file, whole)


KILLER = """
import os, signal
from pathlib import Path
killed = Path("killed")
count = len(killed.read_text()) if killed.exists() else 0
if count < {times}:
    killed.write_text("x" * (count + 1))
    os.kill(os.getppid(), signal.SIGKILL)
"""
BESIDE = """
[study]
name = "beside"
scene = "ks-cantilever"
[[run]]
model = ["killer.toml", "tsm", "rod"]
scene.load_parameters = 2
"""


@pytest.mark.slow
@pytest.mark.parametrize("times", [1, 2])
def test_a_case_that_kills_its_worker_is_tried_once_more_and_blamed_alone(times, tmp_path, capsys):
    """A program that kills the worker that asks it: a second death is the case's, and the next study tries it again."""
    (tmp_path / "killer.py").write_text(KILLER.format(times=times))
    command = json.dumps([sys.executable, "-I", "killer.py"])
    (tmp_path / "killer.toml").write_text(f'[program]\nname = "killer"\ncommand = {command}\n')
    (tmp_path / "study.toml").write_text(BESIDE)
    arguments = ["study", str(tmp_path / "study.toml"), "--out", str(tmp_path), "--workers", "2", "--quiet"]
    for status in [3, 0][2 - times :]:
        assert main(arguments) == status
        lost = [row["model"] for row in rows(tmp_path / "beside.sqlite") if row["status"] == "WORKER_LOST"]
        assert lost == ["killer"] * bool(status)
        out, err = capsys.readouterr()
        assert "COMPLETED 2" in out
        assert ("1 cases have no result; the same command tries them again" in err) == bool(status)
    assert (tmp_path / "killed").read_text() == "x" * times
