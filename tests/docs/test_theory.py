"""Every equation of the theory names the tests that prove it, and every test named exists."""

import re
import tomllib
from pathlib import Path

import pytest

from docs.extensions.site import mathml
from tests.docs.snippets import ROOT, pages

PROOFS = tomllib.loads((ROOT / "docs/theory/proofs.toml").read_text())
"""Tests by page, and by the label of an equation or the heading of a section."""
PAGES = pages()
THEORY = {Path(page).stem: text for page, text in PAGES.items() if page.startswith("docs/theory/")}
EQUATION = re.compile(r"^```\{math\}\n:label: ([\w-]+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^##+ (.*)$", re.MULTILINE)
TEST = re.compile(r"\{abbr\}`[^`]+ \((tests/[^)]+)\)`")


def test_every_page_of_the_theory_names_its_proofs():
    assert list(PROOFS) == [page for page in PROOFS if EQUATION.search(THEORY[page])]
    assert THEORY.keys() == PROOFS.keys()


@pytest.mark.parametrize("page", PROOFS)
def test_every_equation_names_its_proof_and_becomes_mathml(page):
    equations = EQUATION.findall(THEORY[page])
    assert len(equations) == len(re.findall(r"(?m)^```\{math\}", THEORY[page])) > 0
    labels = {label for label, _ in equations}
    assert labels <= PROOFS[page].keys() <= labels | {*HEADING.findall(THEORY[page])}
    assert all(PROOFS[page].values())
    for formula in [text for _, text in equations] + re.findall(r"\$([^$\n]+)\$", THEORY[page]):
        made = mathml(formula, "block")
        assert made.startswith("<math")
        assert "\\" not in re.sub(r"<annotation.*?</annotation>", "", made), formula


def test_every_test_named_exists():
    named = {test for text in PAGES.values() for test in TEST.findall(text)}
    named |= {test for rows in PROOFS.values() for tests in rows.values() for test in tests}
    assert len(named) > 80
    files = {path: (ROOT / path).read_text() for path in {test.partition("::")[0] for test in named}}
    assert [
        one
        for one in sorted(named)
        if f"\ndef {one.partition('::')[2]}(" not in files[one.partition("::")[0]]
    ] == []
