"""What a start imports: the modules that cost most only where they are used. `make bench` measures the times."""

import subprocess
import sys

import pytest

SOLVE = ["solve", "ks-cantilever", "--model", "tsm", "--elements", "4"]
COMMAND = "from comparisons.cli import main\ntry:\n    main({})\nexcept SystemExit:\n    pass"


def imported(code: str) -> set[str]:
    """Return the modules that a Python has imported after some code."""
    code += "\nimport sys\nprint(*sys.modules, file=sys.stderr)"
    found = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=300
    )
    return set(found.stderr.split())


@pytest.mark.parametrize(
    ("code", "there", "absent"),
    [
        ("import tsm", "numpy", {"scipy"}),
        (
            COMMAND.format(["--help"]),
            "comparisons.cli",
            {"numpy", "importlib.metadata", "psutil", "filelock"},
        ),
        (COMMAND.format(SOLVE), "tsm", {"scipy.linalg", "scipy.optimize", "scipy.sparse", "fem_reference"}),
    ],
    ids=["tsm", "help", "solve"],
)
def test_a_start_imports_what_it_uses(code: str, there: str, absent: set[str]) -> None:
    modules = imported(code)
    assert there in modules
    assert not modules & absent
