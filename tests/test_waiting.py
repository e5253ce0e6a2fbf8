"""What `make setup` shows while it installs."""

import runpy
import subprocess
import sys
from pathlib import Path

import pytest

WAITING = Path(__file__).parents[1] / ".ci" / "waiting.py"


@pytest.mark.parametrize(
    ("code", "status", "said"),
    [("print('Collecting a')", 0, "installing\n"), ("import sys; sys.exit('boom')", 1, "installing\nboom\n")],
)
def test_one_line_and_what_a_failed_installer_said(code: str, status: int, said: str, tmp_path: Path) -> None:
    (tmp_path / ".constraints.txt").write_text("a==1\nb==2\n")
    command = [sys.executable, WAITING, "installing", ".venv", sys.executable, "-c", code]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (status, "", said)


def test_libraries_are_loaded_and_then_installed() -> None:
    part = runpy.run_path(str(WAITING))["part"]
    log = "Collecting a\n  Downloading a.whl\nCollecting b (from a)\n"
    assert [part("", 0, 4), part(log, 0, 4), part(log, 4, 4), part(log, 9, 4)] == [0.0, 0.25, 1.0, 1.0]
