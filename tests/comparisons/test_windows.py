"""Commands where Python has no Unix: modules that Windows does not have are blocked, in workers too."""

import csv
import json
import re
from pathlib import Path

import pytest

from comparisons.scene import built_in_scenes
from tests.comparisons.processes import COMMAND, ended

BLOCK = """
import os, signal, subprocess, sys, types
sys.modules.update(dict.fromkeys(["fcntl", "grp", "pwd", "resource", "termios"]))
sys.modules["msvcrt"] = types.SimpleNamespace(LK_LOCK=1, locking=os.lockf)
del os.fork, os.getuid, os.killpg, os.O_NONBLOCK, signal.pthread_sigmask, signal.SIGKILL
"""
"""Run by every Python of the tests as it starts."""
STUDY = '[study]\nname = "s"\nscene = "ks-cantilever"\nrepeats = 1\n[[run]]\nmodel = "tsm"\nelements = [4, 5]\nscene.load_parameters = 2\n'


def crossval(folder: Path, *arguments: str) -> str:
    """Run ``crossval`` in a folder; return what it prints."""
    start = folder / "start"
    start.mkdir(exist_ok=True)
    (start / "sitecustomize.py").write_text(BLOCK)
    found = ended(
        f"import sys; assert sys.modules['fcntl'] is None; {COMMAND}", *arguments, first=start, cwd=folder
    )
    assert found.returncode == 0, found.stderr
    return found.stdout


def test_commands_without_unix(tmp_path):
    """A set of files, whose folder is locked, and a scene from a file, which is read without waiting for a pipe."""
    text = built_in_scenes()["ks-cantilever"]
    (tmp_path / "a.toml").write_text(text.replace("load_parameters = 50", "load_parameters = 2"))
    said = crossval(tmp_path, "solve", "a.toml", "--elements", "4", "--out", "a.json", "--out", "vtk")
    assert "COMPLETED" in said
    assert not list(tmp_path.rglob(".crossval.lock"))
    assert json.loads((tmp_path / "a.json").read_text())["status"] == "COMPLETED"
    assert sorted(path.name for path in tmp_path.glob("vtk/*.vtm")) == ["tsm-0001.vtm", "tsm-0002.vtm"]


@pytest.mark.slow
def test_a_study_without_unix(tmp_path):
    (tmp_path / "s.toml").write_text(STUDY)
    crossval(tmp_path, "run", "s.toml", "--out", "s", "--workers", "1")
    (table,) = (tmp_path / "s").glob("*.csv")
    rows = csv.DictReader(table.read_text().splitlines())
    assert [row["status"] for row in rows] == ["COMPLETED"] * 2


UNIX = r"os\.(fork|forkpty|kill|killpg|getuid|geteuid|getpgid|setsid|wait\w*|chown|fchown|nice|sched_\w+|uname|statvfs|mkfifo|O_(NONBLOCK|DIRECTORY|NOFOLLOW|CLOEXEC))\b|signal\.(SIGKILL|SIGHUP|SIGUSR\d|SIGALRM|alarm|setitimer|pause)\b"
IMPORTED = r"^(import|from) (fcntl|grp|pty|pwd|resource|syslog|termios|tty)\b"


def test_no_module_takes_what_only_unix_has():
    """Where a line needs it, `getattr` or `hasattr` asks first."""
    root = Path(__file__).parents[2]
    files = [
        path for package in ("tsm", "fem_reference", "comparisons") for path in (root / package).rglob("*.py")
    ]
    assert len(files) > 200
    texts = {path.name: path.read_text(encoding="utf-8") for path in files}
    assert not [name for name, text in texts.items() if re.search(f"{UNIX}|{IMPORTED}", text, re.MULTILINE)]
