"""No module asks for a model or an element by its name: names stand in the registries, scenes, documents and tests."""

import ast
from collections.abc import Iterator
from pathlib import Path

import tsm
from comparisons.models import MODELS

ROOT = Path(__file__).parents[2]
NAMES = {*MODELS, *tsm.ELEMENTS}
REGISTRIES = (
    "tsm/elements/kinds/",
    *(f"comparisons/models/{name}.py" for name in ("registry", "tsm", "solid", "rod", "elastica")),
)
OTHER_WORDS = {
    "comparisons/scene/beam.py": "a material law of the solid is called rod",
    "fem_reference/statement/strip.py": "a material law of the solid is called rod",
    "comparisons/version.py": "the package tsm",
    "comparisons/cli/command.py": "the package tsm",
    "comparisons/referee/certificate.py": "a key of a certificate in JSON",
    "comparisons/suites/manual/write.py": "a column of a table",
}


def literals(path: Path) -> Iterator[tuple[int, str]]:
    """Strings of a module that are names, without docstrings and pieces of longer texts."""
    text = path.read_text()
    if not any(f'"{name}"' in text for name in NAMES):
        return
    tree = ast.parse(text)
    prose = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    pieces = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and node.value in NAMES and id(node) not in prose | pieces:
            yield node.lineno, str(node.value)


def test_names_of_models_and_elements_stand_in_their_registries_only():
    found: dict[str, list[tuple[int, str]]] = {}
    for package in ("tsm", "fem_reference", "comparisons"):
        for path in sorted((ROOT / package).rglob("*.py")):
            place = path.relative_to(ROOT).as_posix()
            if not place.startswith(REGISTRIES) and (names := list(literals(path))):
                found[place] = names
    assert found.keys() == OTHER_WORDS.keys(), found
