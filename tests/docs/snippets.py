"""The snippets of Markdown pages, run one after the other as a reader would."""

import os
import re
import shlex
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

from comparisons.cli import main

ROOT = Path(__file__).parents[2]
SLOW = tuple(f"crossval {command}" for command in ("compare", "run", "view"))
"""Commands of many seconds, left to the slow tests."""
TARGETS = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))


def pages() -> dict[str, str]:
    """Return the texts of the README and of the pages that are written by hand, by their paths."""
    files = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return {str(path.relative_to(ROOT)): path.read_text() for path in files if "_generated" not in path.parts}


def blocks(markdown: str) -> list[tuple[str, str]]:
    """Return language and text of every fenced block that is no directive."""
    fences = re.findall(r"^```(\S*)[^\n]*\n(.*?)^```$", markdown, re.DOTALL | re.MULTILINE)
    return [(kind, text) for kind, text in fences if not kind.startswith("{")]


def run_line(line: str) -> str:
    """Run one line of a shell block in this process and return what it printed; its exit status is 0 or as its comment says."""
    program, *arguments = shlex.split(line, comments=True)
    if program == "make":
        assert set(arguments) <= TARGETS, line
        return ""
    assert program == "crossval", line
    stated = re.search(r"# exit status (\d+)$", line)
    out, err = StringIO(), StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            status = main(arguments)
        except SystemExit as ended:  # argparse's own, of --version
            status = ended.code
    assert status == (int(stated[1]) if stated else 0), f"{line}: {err.getvalue()}"
    return out.getvalue() + err.getvalue()


def run_python(source: str, folder: Path) -> str:
    """Run a Python block in a process of its own and return what it printed; warnings are errors."""
    path = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(folder)])}
    command = [sys.executable, "-W", "error", "-c", source]
    run = subprocess.run(command, cwd=folder, env=path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout


def shows(printed: str, stated: str) -> bool:
    """Whether output is as stated, ``...`` standing for anything.

    >>> shows("force 2.2882 N", "force 2.28... N"), shows("force 2.2882 N", "force 2.29")
    (True, False)
    """
    pattern = ".*?".join(re.escape(part) for part in stated.strip().split("..."))
    return re.fullmatch(pattern, printed.strip(), re.DOTALL) is not None


def run_page(markdown: str, folder: Path, *, slow: bool) -> None:
    """Run the blocks of a page in `folder`, the current one.

    A block whose first line is ``# NAME.toml``, ``# NAME.py`` or ``# NAME.sh`` is that file; a ``py`` or ``bash`` block is not run itself. A ``text`` block behind code is what the code prints.
    """
    printed: str | None = None
    for kind, text in blocks(markdown):
        name = re.match(r"# ([\w-]+\.(?:toml|py|sh))\n", text)
        if name:
            (folder / name[1]).write_text(text)
        if kind == "python":
            printed = run_python(text, folder)
        elif kind == "sh":
            lines = [line for line in text.splitlines() if line]
            left_out = not slow and any(line.startswith(SLOW) for line in lines)
            printed = None if left_out else "".join(run_line(line) for line in lines)
        elif kind == "toml":
            assert name, f"a scene needs a first line with its file: {text[:60]}"
        elif kind == "text" and printed is not None:
            assert shows(printed, text), f"printed:\n{printed}\nstated:\n{text}"
