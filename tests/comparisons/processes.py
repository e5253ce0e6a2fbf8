"""Python and ``crossval`` in processes of their own."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

COMMAND = "import sys; from comparisons.cli import main; sys.exit(main(sys.argv[1:]))"


def begun(
    code: str, *arguments: object, first: Path | None = None, env: Any = None, **options: Any
) -> "subprocess.Popen[str]":
    """Start Python on some code, in the environment of the tests with more variables; modules are looked for in `first` before."""
    path = os.pathsep.join([*([str(first)] if first else []), *sys.path])
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)], text=True, stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": path, **(env or {})}, **{"stdout": subprocess.PIPE, **options},
    )  # fmt: skip


def ended(code: str, *arguments: object, **options: Any) -> "subprocess.CompletedProcess[str]":
    """Run Python on some code to its end, which has no traceback."""
    with begun(code, *arguments, **options) as child:
        out, err = child.communicate(timeout=300)
    assert "Traceback" not in err
    return subprocess.CompletedProcess(arguments, child.returncode, out, err)
