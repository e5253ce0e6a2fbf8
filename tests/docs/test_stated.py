"""Every measured number of the results has a mark, and every mark has a test that measures its numbers."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.benchmarks.measure import slug
from tests.stated import MARK, NUMBER, ROOT, pages

MEASURED = re.compile(r"measured|error$|force|position|moment|^tip|unknowns|^`Q")
"""Heads of columns whose numbers are measured."""
RESULTS = sorted((ROOT / "docs" / "results").glob("*.md"))


def names_in_tests() -> list[str]:
    """Return a pattern for the first argument of every call of ``stated``, and for the mark of every `Gate`."""
    found = []
    for path in (ROOT / "tests").rglob("*.py"):
        for call in ast.walk(ast.parse(path.read_text())):
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") in ("stated", "Gate"):
                name = call.args[0]
                parts = name.values if isinstance(name, ast.JoinedStr) else [name]
                words = [str(part.value) if isinstance(part, ast.Constant) else None for part in parts]
                if getattr(call.func, "id", "") == "Gate":
                    words = ["bench.", *(word and slug(word) for word in words)]
                found.append("".join(".+" if word is None else re.escape(word) for word in words))
    return found


def test_every_mark_has_a_test() -> None:
    marks = {name for page in pages() for name in MARK.findall(page.read_text())}
    patterns = names_in_tests()
    assert len(marks) > 100
    assert [
        name for name in sorted(marks) if not any(re.fullmatch(pattern, name) for pattern in patterns)
    ] == []


def test_no_mark_begins_a_line() -> None:
    """There a comment would end the paragraph and take its line out of Markdown."""
    assert [page.name for page in pages() if re.search(r"^\s*<!--", page.read_text(), re.MULTILINE)] == []


def without_mark(text: str) -> Iterator[str]:
    """Yield rows of tables with a measured number in front of the row's first mark."""
    head: list[str] = []
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not (head and cells):
            head = cells
        elif not line.startswith("|---"):
            measured = [cell for title, cell in zip(head, cells, strict=True) if MEASURED.search(title)]
            if NUMBER.search(MARK.split("|".join(measured))[0]):
                yield line


@pytest.mark.parametrize("page", RESULTS, ids=lambda page: page.stem)
def test_every_measured_cell_has_a_mark(page: Path) -> None:
    assert list(without_mark(page.read_text())) == []


def test_a_measured_cell_without_mark_is_found() -> None:
    head = "| case | measured | allowed |\n|---|---|---|\n"
    assert list(without_mark(f"{head}| a | <!--b-->1 / 2 | 3 |\n| c | all | 3 |\n")) == []
    assert list(without_mark(f"{head}| a | 1 / <!--b-->2 | 3 |\n")) == ["| a | 1 / <!--b-->2 | 3 |"]
