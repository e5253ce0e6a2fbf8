"""Put faults into the packages, one at a time, and see whether the tests find them: ``python -m tests.mutation --help``."""

import argparse
import ast
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from random import Random

ROOT = Path(__file__).parents[2]
PACKAGES = ("tsm", "fem_reference", "comparisons")
DRAWS = ("comparisons/report", "comparisons/cli", "comparisons/suites/paper")
"""Where faults are not put: pages, pictures and texts of help."""
NEAR = {
    "tsm": "tests/tsm tests/verification tests/laws tests/oracles",
    "fem_reference": "tests/fem_reference tests/laws",
    "comparisons/referee": "tests/comparisons/referee tests/laws tests/fuzz",
    "comparisons/scene": "tests/comparisons/scene tests/test_second_reader.py tests/docs",
    "comparisons": "tests/comparisons",
}
"""The tests that are tried first."""
OTHER = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Lt: ast.LtE, ast.LtE: ast.Lt,
    ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
"""An operator, and what a fault puts in its place."""
PATIENCE = 3600.0
"""Seconds after which a run of the tests is given up: the fault is found by time."""
Fault = tuple[ast.AST, str, Callable[[], None]]
"""The expression of a fault, its kind, and the function that puts it there."""


def faults(tree: ast.Module) -> Iterator[Fault]:
    """Yield every fault of one token: signs, factors, terms, indices, numbers off by one, tolerances, comparisons."""
    noted = {id(part) for node in ast.walk(tree) for hint in _hints(node) for part in ast.walk(hint)}
    for node in ast.walk(tree):
        if id(node) not in noted:
            yield from _faults(node)


def _hints(node: ast.AST) -> Iterator[ast.AST]:
    """Yield annotations, decorators and messages of assertions, which are no computation."""
    for name in ("annotation", "returns", "msg"):
        hint = getattr(node, name, None)
        if isinstance(hint, ast.AST):
            yield hint
    yield from getattr(node, "decorator_list", ())


def _faults(node: ast.AST) -> Iterator[Fault]:
    match node:
        case ast.BinOp(op=op) if type(op) in OTHER:
            yield node, "operator", lambda: setattr(node, "op", OTHER[type(op)]())
            if isinstance(op, ast.Add):
                yield node, "missing term", lambda: setattr(node, "right", ast.Constant(0))
        case ast.Compare(ops=[op]) if type(op) in OTHER:
            yield node, "comparison", lambda: setattr(node, "ops", [OTHER[type(op)]()])
        case ast.BoolOp(op=op):
            yield node, "condition", lambda: setattr(node, "op", OTHER[type(op)]())
        case ast.UnaryOp(op=ast.USub(), operand=operand) if not isinstance(operand, ast.Constant):
            yield node, "sign", lambda: setattr(node, "op", ast.UAdd())
        case ast.Constant(value=bool() | str() | None):
            return
        case ast.Constant(value=int(number)):
            yield node, "off by one", lambda: setattr(node, "value", number + 1)
        case ast.Constant(value=float(number)) if number:
            factor, kind = (1e4, "tolerance") if number < 1e-3 else (1.5, "factor")
            yield node, kind, lambda: setattr(node, "value", factor * number)


def drawn(seed: int, number: int) -> list[tuple[Path, int]]:
    """Draw faults, each a module and the number of its fault, a third of them in each package."""
    random, places = Random(seed), []  # noqa: S311 - nothing is secret
    for package in PACKAGES:
        modules = [path.relative_to(ROOT) for path in sorted((ROOT / package).rglob("*.py"))]
        own = [
            (module, k)
            for module in modules
            if not module.as_posix().startswith(DRAWS)
            for k, _ in enumerate(faults(ast.parse((ROOT / module).read_text(encoding="utf-8"))))
        ]
        share = number // 3 + (PACKAGES.index(package) < number % 3)
        places += random.sample(own, share)
    return places


def killed(folder: Path, module: Path, mark: str, jobs: int) -> str:
    """Return which tests found the fault that stands in the module: those near it, or all; nothing if they pass."""
    near = next(tests for part, tests in NEAR.items() if module.as_posix().startswith(part)).split()
    near = [path for path in near if (folder / path).exists()]
    run = [sys.executable, "-m", "pytest", "-x", "-q", "-m", mark, "-n", str(jobs), "-p", "no:cacheprovider"]
    settings = {**os.environ, "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    for name, paths in (("near", near), ("all", ["tests"])):
        with tempfile.TemporaryFile("w+") as told:
            # a fault may leave workers behind, which would hold a pipe open; they end with their group
            child = subprocess.Popen(
                [*run, *paths], cwd=folder, env=settings, stdout=told, stderr=told, start_new_session=True
            )
            try:
                status = child.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                return f"{name}, by time"
            finally:
                with suppress(ProcessLookupError):
                    os.killpg(child.pid, signal.SIGKILL)
                child.wait()
            told.seek(0)
            lines = [line for line in told if line.startswith(("FAILED", "ERROR"))]
        if status:
            return f"{name}, {next(iter(lines), '')[:110].rstrip()}"
    return ""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument(
        "--count", type=int, default=40, help="faults to draw, a third of them in each package"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slow", action="store_true", help="try the slow tests on what the fast ones leave")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of the drawn faults to try")
    given = parser.parse_args()
    # a fault may collect without end
    resource.setrlimit(resource.RLIMIT_AS, (6_000_000 * 1024,) * 2)
    left = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o755)  # one test reads as nobody
        # whole, since tests of pages follow their links
        tracked = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True)
        for part in tracked.split("\0")[:-1]:
            (folder / part).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / part, folder / part)
        for number, (module, k) in enumerate(drawn(given.seed, given.count)):
            if given.only is not None and number not in given.only:
                continue
            source = (ROOT / module).read_text(encoding="utf-8")
            tree = ast.parse(source)
            node, kind, put = list(faults(tree))[k]
            before = ast.unparse(node)
            put()
            what = f"{number} {module}:{node.lineno} {kind}: {before} -> {ast.unparse(node)}"  # type: ignore[attr-defined]
            (folder / module).write_text(ast.unparse(tree), encoding="utf-8")
            found = killed(folder, module, "not slow", given.jobs)
            if not found and given.slow:
                found = killed(folder, module, "slow", given.jobs)
            print(f"{'killed' if found else 'SURVIVES'} {what}  [{found}]", flush=True)
            left += not found
            (folder / module).write_text(source, encoding="utf-8")
    print(f"{left} survive")
    return int(left > 0)


if __name__ == "__main__":
    sys.exit(main())
