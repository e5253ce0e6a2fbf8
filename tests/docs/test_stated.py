"""Every measured number of the results has a mark, and every mark has a test that measures its numbers."""

import re
from collections.abc import Iterator
from functools import cache

import pytest

from tests.benchmarks.measure import slug
from tests.stated import LOOSE, MARK, NUMBER, ROOT, Stated, holds, marked, pages

RESULTS = [ROOT / "README.md", *sorted((ROOT / "docs" / "results").glob("*.md"))]


@cache
def names_in_tests() -> frozenset[str]:
    """Return the first argument of every call of ``stated``, and the mark of every `Gate`, with {} for what is computed."""
    found = set()
    for path in (ROOT / "tests").rglob("*.py"):
        for call, words in re.findall(r'\b(stated|Gate)\(\s*f?"([^"]*)"', path.read_text()):
            parts = re.split(r"\{[^}]*\}", words)
            named = "{}".join(parts) if call == "stated" else "bench." + "{}".join(map(slug, parts))
            found.add(named.strip("-"))
    return frozenset(found)


def unmeasured(text: str) -> list[str]:
    """Return the marks of a text that no test measures. `make test-all` also fails at one whose computed part none has computed."""
    known = "|".join(re.escape(name).replace(r"\{\}", ".+") for name in names_in_tests())
    return sorted(mark for mark in set(MARK.findall(text)) if not re.fullmatch(known, mark))


def test_every_mark_has_a_test():
    text = "".join(page.read_text() for page in pages())
    assert len(MARK.findall(text)) > 150
    assert unmeasured(text) == []
    assert unmeasured("<!--ks.invented-->1 <!--invented x2-->1 2") == ["invented", "ks.invented"]


def test_a_number_is_held_to_its_last_digit_and_a_bound_from_both_sides():
    rounded, bound = (Stated(text, percent=False, start=0, end=len(text)) for text in ("1.30e-2", "1e-12"))
    for one, rule, held, broken in (
        (rounded, {}, (0.01296, 0.01304), (0.01294, 0.01306, float("nan"))),
        (bound, {"least": 1 / LOOSE}, (1e-12, 3.4e-13), (1.01e-12, 3.3e-13)),
    ):
        assert all(holds(one, value, **rule) for value in held)
        assert not any(holds(one, value, **rule) for value in broken)


def test_no_mark_begins_a_line():
    """There a comment would end the paragraph and take its line out of Markdown."""
    assert [page.name for page in pages() if re.search(r"^\s*<!--", page.read_text(), re.MULTILINE)] == []


LABELS = re.compile(r"allowed|target|test$|clamp$|^nu$|where a model|what happens|what it does")
"""Heads of columns that say what is done or wanted, as the first column does; the numbers of all others are measured."""
ONE = r"-?(?:\d[\d,]*(?:\.\d+)?|\.\d+)(?:e-?\d+)?"
SOME = rf"{ONE}(?:(?:, | and | or | to | x |-){ONE})*"
COUNTED = "elements|load parameters|load steps|step counts|steps|cycles|scenes|scene files|random points|variants|processor seconds"
NOT_MEASURED = (
    rf"{SOME} (?:(?:new|random) )?(?:{COUNTED})\b",
    rf"(?:\bt|h/L|\$\\mu\$|coefficients of friction|accuracy|accuracies|tolerance|target|exit status)(?: =| of| from|:)? {SOME}",
    rf"(?:Python|CalculiX\]|[Ss]ection|Figures|the paper:)(?: is)? {SOME}(?: or newer)?",
    rf"{SOME} are its examples|{SOME} of the literature|from 0 to 1|199 \(2010\) 2510-2531",
    r"\^-?\d+",
)
"""Numbers in sentences that no test measures: counts, settings, versions, names, literature, powers."""


def plain(text: str) -> str:
    """Return a page without marks and the numbers that they name, code, and addresses of links."""
    named = [one for mark in MARK.finditer(text) for one in marked(text, mark)]
    for one in reversed(named):
        text = text[: one.start] + text[one.end :]
    text = MARK.sub("", text)
    text = re.sub(r"\A---\n.*?\n---\n|```.*?```", "", text, flags=re.DOTALL)
    return re.sub(r"`[^`]*`|(?<=\])\([^)]*\)", "", text)


def without_mark(text: str) -> Iterator[str]:
    """Yield what stands around every number that is neither behind a mark nor in `NOT_MEASURED`."""
    head: list[str] = []
    sentences = []
    for line in plain(text).splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if cells and head:
            measured = [
                cell for title, cell in zip(head[1:], cells[1:], strict=True) if not LABELS.search(title)
            ]
            sentences += ["", *measured, ""]
        elif not cells:
            sentences.append(line)
        head = (head or cells) if cells else []
    left = re.sub("|".join(NOT_MEASURED), "", " ".join(sentences))
    yield from (left[max(0, n.start() - 40) : n.end() + 20] for n in NUMBER.finditer(left))


@pytest.mark.parametrize("page", RESULTS, ids=lambda page: page.stem)
def test_every_number_has_a_mark(page):
    assert list(without_mark(page.read_text())) == []


def test_a_number_without_mark_is_found():
    head = "| case 1 | measured | allowed |\n|---|---|---|\n"
    for page in (f"{head}| a | 1 / <!--b-->2 | 3 |\n", "It is 3 % with 20 elements."):
        assert len(list(without_mark(page))) == 1, page
