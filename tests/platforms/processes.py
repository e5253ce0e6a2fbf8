"""Locks and the life of processes on this machine: ``python -m tests.platforms.processes``. psutil suffices."""

import subprocess
import sys
from contextlib import suppress
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from time import time

# not public: the lock of a folder and the life of a process, without a scene to solve
from comparisons.cases.owner import Owner
from comparisons.files import alone_in

HOLD = """
import sys, time
from pathlib import Path
from comparisons.files import alone_in
with alone_in(Path(sys.argv[1])):
    print("held", flush=True)
    if len(sys.argv) > 2:
        time.sleep(600)
"""
PATIENCE = 1.0
"""Seconds after which a process that has not gone on is one that waits."""


def holder(folder: Path, *how: str) -> "subprocess.Popen[str]":
    """Start a process that locks a folder and says so; with an argument more it never ends by itself."""
    return subprocess.Popen(
        [sys.executable, "-c", HOLD, str(folder), *how],
        cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE,
        text=True,
    )


def check(folder: Path) -> None:
    """Let a process hold a folder and be killed: another one waits until then, and no longer, and no file stays."""
    first, second = holder(folder, "forever"), None
    try:
        assert first.stdout is not None
        assert first.stdout.readline() == "held\n"
        owner = Owner(host=Owner.this_process().host, pid=first.pid, born=time())
        assert owner.alive(time())
        assert not replace(owner, born=0.0).alive(time()), "another process had the number"
        second = holder(folder)
        with suppress(subprocess.TimeoutExpired):
            second.wait(PATIENCE)
        assert second.returncode is None, "two held the folder at once"
        first.kill()
        assert second.communicate(timeout=60)[0] == "held\n"
        assert not owner.alive(time()), "dead, though nobody has asked how it ended"
        with alone_in(folder):
            assert not list(folder.iterdir())
    finally:
        for process in filter(None, (first, second)):
            process.kill()
            process.communicate()


def main() -> int:
    with TemporaryDirectory() as folder:
        check(Path(folder))
    print(f"psutil {metadata.version('psutil')}: locks end with their processes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
