"""What the commands say of a dozen scenes: ``python -m tests.golden.write [SCENE ...]`` writes it anew, `test_golden` holds it.

A file has a section for each command: what it prints, or the numbers of its answer at two load parameters.
"""

import csv
import json
import re
import sys
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import scipy

from comparisons.cli import main as crossval

HERE = Path(__file__).parent
MODELS = {
    "exact": ("--element", "exact"),
    "mixed": ("--element", "mixed", "--elements", "10"),
    "timoshenko": ("--element", "timoshenko", "--elements", "11"),
    "rod": ("--model", "rod"),
    "elastica": ("--model", "elastica"),
    "solid": ("--model", "solid"),
}
SOURCES = {
    "clamped-column": "tests/oracles/elastica.py, the elastica by elliptic integrals",
    "double-beam": "tests/oracles/coupled.py, two rods by collocation",
    "heavy-strip": "tests/oracles/shooting.py, shooting",
    "hinged-truss": "tests/comparisons/scene/test_built_in.py, closed form",
    "hysteresis-stages": "tests/comparisons/exact/test_friction.py, a rod's path with friction",
    "ks-cantilever": "tests/oracles/shooting.py, shooting",
    "ks-friction": "tests/comparisons/exact/test_friction.py, a rod's path with friction",
    "sleeve": "tests/problems.toml, the referee and exact elements",
    "straightened-arc": "tests/comparisons/scene/test_built_in.py, closed form",
    "tapered-spring": "tests/oracles/shooting.py, shooting",
    "tip-load": "tests/oracles/elastica.py, the elastica by elliptic integrals",
}
"""The scenes, each with the program that redoes its digits beside the referee, whose answer stands in its file."""
SLOW = {"clamped-column", "double-beam", "hysteresis-stages", "ks-friction", "tapered-spring"}
COMPARED = ("ks-cantilever", "ks-friction", "tip-load")
PAGES = ("hysteresis-stages", "sleeve")
QUANTITIES = ("arc_position", "force", "index", "moment", "strain_energy", "tips", "work")
NOISE = 1e-9
"""What is round-off, in the units of these scenes."""


def said(*arguments: str, folder: str = "") -> Iterator[str]:
    """Yield the lines that a command prints, and its exit status where it is not 0; this alone knows how a command is called."""
    text = StringIO()
    with redirect_stdout(text), redirect_stderr(text):
        status = crossval(list(arguments))
    yield from (
        line.rstrip()
        for line in text.getvalue().splitlines()
        if not (folder and folder in line) and line != "files:"
    )
    if status:
        yield f"exit status {status}"


def written(scene: str) -> str:
    """Return what stands in a scene's file."""
    return "\n".join([f"source: {SOURCES[scene]}", *_scene(scene)]) + "\n"


def _scene(scene: str) -> Iterator[str]:
    with TemporaryDirectory() as folder:
        yield "== check"
        yield from said("check", scene, "--out", f"{folder}/picture.svg", folder=folder)
    yield from solved(scene)
    yield "== certify"
    yield from list(said("certify", scene))[:2]


def solved(scene: str) -> Iterator[str]:
    """Yield the answers of all models."""
    with TemporaryDirectory() as folder:
        for model, options in MODELS.items():
            yield f"== solve {model}"
            file = Path(folder) / f"{model}.json"
            given = ("--quiet", "--certify", "none", "--out", str(file))
            printed = list(said("solve", scene, *options, *given))
            yield from (line for line in printed if line.startswith(("crossval", "exit")))
            if file.exists():
                yield from _answer(json.loads(file.read_text()))


def _answer(answer: dict[str, Any]) -> Iterator[str]:
    """Yield the status, each history at two load parameters, and the events of an answer."""
    yield f"{answer['status']}: {answer['message']}"
    yield from sorted(_histories(answer))
    for event in answer["events"] or ():
        if event["kind"] != "pass-through":
            yield f"event {event['kind']} {event.get('pair') or ''}: {round(event['load_parameter'], 9):.10g}"


def _histories(value: Any, *path: str) -> Iterator[str]:
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _histories(part, *path, key)
    elif isinstance(value, list) and value and {path[0], path[-1]} & set(QUANTITIES):
        chosen = sorted({(2 * len(value) - 1) // 3, len(value) - 1})
        yield f"{' '.join(path)}: {_flat([value[k] for k in chosen])}"


def _flat(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(_flat, value))
    return f"{value if abs(value) > NOISE else 0.0:.13g}" if isinstance(value, float) else str(value)


def compared(scene: str) -> Iterator[str]:
    """Yield a row for each model of ``compare``."""
    with TemporaryDirectory() as folder:
        yield f"== compare {scene}"
        yield from (line for line in said("compare", scene, "--quiet", "--out", folder) if "exit" in line)
        for row in csv.DictReader((Path(folder) / "table.csv").read_text().splitlines()):
            errors = {
                name: float(text) for name, text in row.items() if name.startswith("error_path") and text
            }
            numbers = (f"{name[11:]} {value:.2e}" for name, value in errors.items() if value > NOISE)
            yield f"{row['label']}, {row['status']}, {row['unknowns']}, stable {row['stable']}: {', '.join(numbers)}"


def extremes() -> Iterator[str]:
    """Yield the places on every axis of the extremes, and what scenes state otherwise than half a circle of a cantilever."""
    from comparisons.scene import Scene, to_tables
    from comparisons.suites.extremes.axes import cantilever, half_circle, matrix

    def stated(scene: Scene) -> dict[str, str]:
        tables = {name: rows if isinstance(rows, list) else [rows] for name, rows in to_tables(scene).items()}
        keys = (
            (name, key, value) for name, rows in tables.items() for row in rows for key, value in row.items()
        )
        return {
            f"{name} {key}": str(value)[:90] for name, key, value in keys if (name, key) != ("scene", "name")
        }

    places = dict.fromkeys((cell.axis, cell.column) for cell in matrix())
    for axis in dict.fromkeys(axis for axis, _ in places):
        yield f"{axis}: " + "; ".join(column for own, column in places if own == axis)
    first = stated(half_circle(cantilever()))
    own = {(cell.axis, cell.column): stated(cell.case.scene) for cell in matrix(quick=True)}
    yield "; ".join(f"{name} {value}" for name, value in first.items())
    for (axis, column), keys in own.items():
        others = (f"{name} {keys.get(name)}" for name in first | keys if keys.get(name) != first.get(name))
        yield f"{axis}, {column}: " + "; ".join(others)


def machine() -> str:
    """Return what rounds: the versions of the libraries, the processor's extensions and, behind a semicolon, the processor itself."""
    config = np.show_config(mode="dicts")
    found = " ".join(config["SIMD Extensions"]["found"])
    cpu = Path("/proc/cpuinfo")
    model = re.findall(
        r"^(?:vendor_id|cpu family|model)\s*: (.*)$", cpu.read_text() if cpu.exists() else "", re.MULTILINE
    )
    return f"numpy {np.__version__}, scipy {scipy.__version__}, {found}; {' '.join(model[:3])}"


def pages() -> dict[str, Any]:
    """Return every file by its name, and what computes it."""
    return {
        **{scene: lambda scene=scene: written(scene) for scene in SOURCES},
        **{f"compare-{scene}": lambda scene=scene: "\n".join(compared(scene)) + "\n" for scene in COMPARED},
        **{
            f"page-{scene}": lambda scene=scene: "\n".join(said("solve", scene, "--quiet")) + "\n"
            for scene in PAGES
        },
        "extremes": lambda: "\n".join(extremes()) + "\n",
    }


ROUNDED = 10
"""Most digits of a number that is shown rounded."""
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")


def differences(now: str, before: str, bound: float, solid: float = 0.0) -> list[str]:
    """Return the lines that differ: words at all, a number by more than `bound` of its line's largest, or by a unit of a rounded one."""
    lines, kept, apart, allowed = now.splitlines(), before.splitlines(), [], bound
    for a, b in zip(lines, kept, strict=False):
        if b.startswith("== "):
            allowed = max(bound, solid) if "solid" in b else bound
        if not _same(a, b, allowed):
            apart.append(f"{a}\n  was: {b}")
    return apart + [f"{len(lines)} lines, {len(kept)} before"] * (len(lines) != len(kept))


def _same(line: str, other: str, bound: float) -> bool:
    # a shorter number moves what is beside it
    if NUMBER.sub("#", line).split() != NUMBER.sub("#", other).split():
        return False
    found, kept = NUMBER.findall(line), NUMBER.findall(other)
    size = max((abs(float(text)) for text in kept), default=0.0)
    return all(
        abs(float(a) - float(b)) <= max(bound * size, _unit(b)) for a, b in zip(found, kept, strict=True)
    )


def _unit(number: str) -> float:
    """A unit of the last place of a number shown rounded; of a whole number, none."""
    mantissa, _, power = number.partition("e")
    decimals = len(mantissa.partition(".")[2])
    digits = len(mantissa.replace(".", "").lstrip("+-0"))
    return 1.01 * 10.0 ** (int(power or 0) - decimals) if (decimals or power) and digits <= ROUNDED else 0.0


if __name__ == "__main__":
    (HERE / "machine.txt").write_text(machine() + "\n", encoding="utf-8")
    for name in sys.argv[1:] or pages():
        (HERE / f"{name}.txt").write_text(pages()[name](), encoding="utf-8")
