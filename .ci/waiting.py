"""Run an installer behind one line of text, on a terminal with a bar: ``waiting.py TEXT ENVIRONMENT COMMAND...``.

What the installer prints is shown only if it fails. The bar counts the libraries that the installer has named and those that are in
the environment, over the lines of ``.constraints.txt``.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

REDRAW = 0.2
"""Seconds between two drawings."""
PATIENCE = 2.0
"""Seconds without a bar."""
WIDTH = 30


def part(printed: str, installed: int, libraries: int) -> float:
    """Return the part of the work that is done: to find and load the libraries is one half of it, to install them the other."""
    named = sum(line.lstrip().startswith("Collecting ") for line in printed.splitlines())
    return min(1.0, (max(named, installed) + installed) / (2 * libraries))


def main(text: str, environment: str, *command: str) -> int:
    """Run the command; return its exit status."""
    libraries = len(Path(".constraints.txt").read_text(encoding="utf-8").splitlines())
    began, terminal = time.monotonic(), sys.stderr.isatty()
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        with log.open("wb") as output:
            child = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)  # noqa: S603
        try:
            while child.poll() is None:
                time.sleep(REDRAW)
                if terminal and time.monotonic() - began > PATIENCE:
                    found = len(list(Path(environment).glob("lib/python*/site-packages/*.dist-info")))
                    done = part(log.read_text(encoding="utf-8", errors="replace"), found, libraries)
                    filled = int(WIDTH * done)
                    sys.stderr.write(f"\r[{'#' * filled}{'.' * (WIDTH - filled)}] {done:.0%}\x1b[K")
                    sys.stderr.flush()
        finally:
            if child.poll() is None:
                child.kill()
            if terminal:
                sys.stderr.write("\r\x1b[K")
        if child.returncode:
            sys.stderr.write(log.read_text(encoding="utf-8", errors="replace"))
    return child.returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
