"""Locks on this machine: ``python -m tests.platforms.processes``."""

import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

# not public: the lock of a folder, without a scene to solve
from comparisons.files import alone_in

HOLD = """
import sys, time
from pathlib import Path
from comparisons.files import alone_in
with alone_in(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""


def holder(folder, seconds=0):
    """Start a process that locks a folder for some seconds and says so."""
    command = [sys.executable, "-c", HOLD, str(folder), str(seconds)]
    return subprocess.Popen(command, cwd=Path(__file__).parents[2], stdout=subprocess.PIPE, text=True)


def check(folder):
    """Let a process hold a folder and be killed: another one waits until then, and no longer, and no file stays."""
    with holder(folder, 600) as first:
        try:
            assert first.stdout.readline() == "held\n"
            with holder(folder) as second:
                with suppress(subprocess.TimeoutExpired):
                    second.wait(1.0)
                assert second.returncode is None, "two held the folder at once"
                first.kill()
                assert second.communicate(timeout=60)[0] == "held\n"
            with alone_in(folder):
                assert not list(folder.iterdir())
        finally:
            first.kill()


if __name__ == "__main__":
    with TemporaryDirectory() as place:
        check(Path(place))
    print("locks end with their processes")
