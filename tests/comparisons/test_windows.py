"""Commands where Python has no Unix: modules that Windows does not have are blocked, in workers too."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.cases.results import read_results
from tests.comparisons.cases.conftest import COMMAND

BLOCK = """
import os, signal, sys
import psutil  # which on Unix takes them itself
sys.modules.update(dict.fromkeys(["fcntl", "grp", "pwd", "resource", "termios"]))
del os.fork, os.getuid, os.killpg, os.O_NONBLOCK, signal.pthread_sigmask, signal.SIGKILL
"""
"""Run by every Python of the tests as it starts."""
PACKAGES = ("tsm", "fem_reference", "comparisons")
STUDY = '[study]\nname = "s"\nscene = "ks-cantilever"\nrepeats = 1\n[[run]]\nmodel = "tsm"\nelements = [4, 5]\nscene.load_parameters = 2\n'


def crossval(folder: Path, *arguments: str) -> str:
    """Run ``crossval`` in a folder; return what it prints."""
    start = folder / "start"
    start.mkdir()
    (start / "sitecustomize.py").write_text(BLOCK)
    found = subprocess.run(
        [sys.executable, "-c", f"import sys; assert sys.modules['fcntl'] is None; {COMMAND}", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(start), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert found.returncode == 0, found.stderr
    assert "Traceback" not in found.stderr
    return found.stdout


@pytest.mark.parametrize(
    ("arguments", "printed"),
    [
        (["--help"], "usage: crossval"),
        (["scenes"], "ks-cantilever\n"),
        (["solve", "ks-cantilever", "--model", "tsm", "--elements", "4", "--json", "a.json"], "COMPLETED"),
    ],
    ids=["help", "scenes", "solve"],
)
def test_commands_without_unix(arguments: list[str], printed: str, tmp_path: Path) -> None:
    assert printed in crossval(tmp_path, *arguments)
    if "--json" in arguments:
        assert json.loads((tmp_path / "a.json").read_text())["status"] == "COMPLETED"


def test_a_series_without_unix(tmp_path: Path) -> None:
    """A set of files, whose folder is locked, and a scene from a file, which is read without waiting for a pipe."""
    text = (Path(sys.modules["comparisons"].__path__[0]) / "scene/scenes/ks-cantilever.toml").read_text()
    scene = tmp_path / "a.toml"
    scene.write_text(re.sub(r"load_parameters = \d+", "load_parameters = 2", text))
    crossval(tmp_path, "solve", "a.toml", "--model", "tsm", "--elements", "4", "--vtk", "vtk")
    assert sorted(path.name for path in (tmp_path / "vtk").glob("tsm-0*.vtm")) == [
        "tsm-0001.vtm",
        "tsm-0002.vtm",
    ]


@pytest.mark.slow
def test_a_study_without_unix(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(STUDY)
    crossval(tmp_path, "study", "s.toml", "--results", "s.sqlite", "--workers", "1")
    results = read_results(tmp_path / "s.sqlite")
    assert [result.measurement.response.status for result in results] == ["COMPLETED"] * 2


UNIX = r"os\.(fork|forkpty|kill|killpg|getuid|geteuid|getpgid|setsid|wait\w*|chown|fchown|nice|sched_\w+|uname|statvfs|mkfifo|O_(NONBLOCK|DIRECTORY|NOFOLLOW|CLOEXEC))\b|signal\.(SIGKILL|SIGHUP|SIGUSR\d|SIGALRM|alarm|setitimer|pause)\b"


def test_no_module_takes_what_only_unix_has() -> None:
    """Where a line needs it, `getattr` or `hasattr` asks first."""
    root = Path(sys.modules["comparisons"].__path__[0]).parent
    files = [path for package in PACKAGES for path in (root / package).rglob("*.py")]
    assert len(files) > 200
    taken = [path.name for path in files if re.search(UNIX, path.read_text(encoding="utf-8"))]
    assert not taken
    imported = r"^(import|from) (fcntl|grp|pty|pwd|resource|syslog|termios|tty)\b"
    assert not [path.name for path in files if re.search(imported, path.read_text(encoding="utf-8"), re.M)]
