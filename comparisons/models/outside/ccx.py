"""Run ``ccx``, the solver of CalculiX (Debian's ``calculix-ccx``), on an input deck and read its printed tables."""

import re
import shutil
import subprocess
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from comparisons.models.outside.child import environment

Rows = list[list[float]]

_HEADER = re.compile(r" (displacements|forces) \(.*\) for set (\S+) and time\s+(\S+)")
_SHORT = re.compile(r"(?<=\d)(?=[+-]\d{3}$)")
"""Place of the E that Fortran leaves out before an exponent of three digits."""
_TAIL = 300


@dataclass(frozen=True, kw_only=True)
class Printed:
    """Printed tables of a run.

    Parameters
    ----------
    times
        End of every increment that converged.
    tables
        Rows of three components, one table per increment, by ``("displacements" or "forces", node set)``; the nodes in
        the order of their numbers.
    """

    times: list[float]
    tables: dict[tuple[str, str], list[Rows]]


class CalculixError(RuntimeError):
    """CalculiX is not installed, took too long or stopped early; the message is one line.

    ``reason`` is the message without the program's name. ``printed`` holds the completed increments, None if the program did not run.
    """

    def __init__(self, reason: str, printed: Printed | None = None) -> None:
        super().__init__(f"CalculiX {reason}")
        self.reason = reason
        self.printed = printed


def run(deck: str, seconds: float = 300.0) -> Printed:
    """Run a deck in a temporary folder, on one thread, for at most `seconds`.

    Raises
    ------
    CalculixError
        If ``ccx`` is not installed or does not finish. The message holds the end of its output.
    """
    program = shutil.which("ccx")
    if program is None:
        raise CalculixError("is needed: there is no program ccx on the path (Debian: calculix-ccx)")
    with tempfile.TemporaryDirectory(prefix="calculix-") as folder:
        (Path(folder) / "job.inp").write_text(deck, encoding="ascii")
        reason = _finish([program, "-i", "job"], folder, seconds)
        found = Path(folder) / "job.dat"
        printed = parse(found.read_text(encoding="ascii", errors="replace") if found.exists() else "")
    if reason:
        raise CalculixError(reason, printed)
    return printed


def parse(text: str) -> Printed:
    """Read a ``.dat`` file; an incomplete last line is skipped."""
    tables: dict[tuple[str, str], list[Rows]] = defaultdict(list)
    times: dict[float, None] = {}
    rows: Rows = []
    for line in text[: text.rfind("\n") + 1].splitlines():
        if header := _HEADER.match(line):
            rows = []
            tables[header[1], header[2]].append(rows)
            times[float(header[3])] = None
        elif line.strip():
            rows.append([float(_SHORT.sub("E", value)) for value in line.split()[1:]])
    return Printed(times=list(times), tables=dict(tables))


def _finish(command: list[str], folder: str, seconds: float) -> str:
    """Run a command; return the reason why it did not finish, empty if it did."""
    try:
        done = subprocess.run(  # noqa: S603 the program found on the path, our own deck
            command,
            cwd=folder,
            env={**environment(), "OMP_NUM_THREADS": "1"},
            capture_output=True,
            text=True,
            errors="replace",
            timeout=seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"did not finish within {seconds:g} s"
    except OSError as error:
        return f"did not start: {error.strerror}"
    if done.returncode == 0 and "Job finished" in done.stdout:
        return ""
    words = " ".join((done.stdout + done.stderr).split())
    where = words.find("*ERROR")
    return f"stopped: {words[where : where + _TAIL] if where >= 0 else words[-_TAIL:]}"
