"""`crossval run FILE.toml` in processes of its own: killed, interrupted, out of room."""

import json
import os
import random
import resource
import signal
import subprocess
import sys
from pathlib import Path
from time import sleep

import pytest

from comparisons.cli import main
from tests.comparisons.processes import COMMAND
from tests.comparisons.suite.conftest import (
    CASES,
    TINY,
    check_finished,
    crossval,
    histories,
    recorded,
    rows,
    wait_for,
)

KILLS = 20
"""A third while the libraries are loaded, the others after 1 to 8 cases more; of the command alone or of its workers too."""


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


def killed(process, results, chance):
    """Kill the command, or all its processes, at a random point; whether it was still at work."""
    if chance.random() < 1 / 3:
        # while interpreter and libraries are loaded
        sleep(chance.uniform(0, 1))
    else:
        goal = recorded(results) + chance.randint(1, 8)
        wait_for(lambda: recorded(results) >= min(goal, CASES) or process.poll() is not None)
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
def test_killed_at_twenty_random_points(whole, tmp_path, start):
    """20 times kill -9, over as many studies as that takes: each ends with the tables of one that was left alone."""
    chance, hit, folders = random.Random(7), list[int](), list[Path]()  # noqa: S311 - no secret
    while len(hit) < KILLS:
        folder = tmp_path / str(len(folders))
        folders.append(folder)
        while recorded(folder / "tiny") < CASES and len(hit) < KILLS:
            if killed(start("run", TINY, "--out", folder, "--workers", "2"), folder / "tiny", chance):
                hit.append(recorded(folder / "tiny"))
    for folder in folders:
        check_finished(folder, whole)
    assert len(set(hit)) > KILLS // 4, "the points are spread over the study"
    print(f"killed with {sorted(hit)} cases done, in {len(folders)} studies")


@pytest.mark.slow
@pytest.mark.parametrize("whom", ["command", "group"])
def test_interrupted_and_gone_on(whom, whole, tmp_path, start):
    process = start("run", TINY, "--out", tmp_path, "--workers", "2")
    wait_for(lambda: recorded(tmp_path / "tiny") >= 3)
    (os.kill if whom == "command" else os.killpg)(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "crossval: interrupted"
    assert "Traceback" not in err
    assert "Warning" not in err
    kept = histories(tmp_path)
    assert 3 <= len(kept) < CASES
    check_finished(tmp_path, whole)
    assert kept.items() <= histories(tmp_path).items()


@pytest.mark.slow
def test_out_of_room(whole, tmp_path, start):
    """A limit on the size of files stops the command like a full disk: one line, and everything before it kept."""
    sizes = [file.stat().st_size for file in (whole / "tiny").glob("*.json")]

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (sorted(sizes)[-2], resource.RLIM_INFINITY))

    process = start("run", TINY, "--out", tmp_path, "--workers", "2", preexec_fn=limit)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2, err
    line = err.splitlines()[-1]
    assert line.startswith(f"crossval: {tmp_path}/tiny/")
    assert line.endswith(".json: cannot be written: File too large")
    assert "Traceback" not in err
    assert 0 < recorded(tmp_path / "tiny") < CASES
    assert len(list((tmp_path / "tiny").iterdir())) == recorded(tmp_path / "tiny")
    check_finished(tmp_path, whole)


def test_a_folder_that_is_only_read(capsys):
    """Not even the superuser writes there."""
    assert crossval("run", TINY, "--out", "/proc/study") == 2
    assert capsys.readouterr().err.startswith("crossval: /proc/study: cannot be written: ")


def test_a_program_from_standard_input_is_refused_by_one_line(tmp_path):
    """Processes by spawn load the file of the main program, and there is none."""
    command = [sys.executable, "-", "run", TINY, "--out", tmp_path, "--quiet"]
    found = subprocess.run(command, input=COMMAND, capture_output=True, text=True, check=False)
    assert found.returncode == 2
    (line,) = found.stderr.splitlines()
    assert line.startswith("crossval: workers: cannot load <stdin>: ")


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
    arguments = ["run", str(tmp_path / "study.toml"), "--out", str(tmp_path), "--workers", "2", "--quiet"]
    for status in [3, 0][2 - times :]:
        assert main(arguments) == status
        lost = [row["message"] for row in rows(tmp_path / "beside.csv") if row["status"] == "WORKER_LOST"]
        assert len(lost) == bool(status)
        out, err = capsys.readouterr()
        assert "COMPLETED 2" in out
        assert ("1 cases have no result; the same command tries them again" in err) == bool(status)
    assert (tmp_path / "killed").read_text() == "x" * times
