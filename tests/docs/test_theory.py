"""Every equation of the theory names the tests that prove it, and every test named exists."""

import re

import pytest

from docs.extensions.site import mathml
from tests.docs.snippets import ROOT, pages

PAGES = pages()
THEORY = {page: text for page, text in PAGES.items() if page.startswith("docs/theory/")}
EQUATION = re.compile(r"^```\{math\}\n:label: ([\w-]+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
TEST = re.compile(r"\{test\}`([^`]+)`")


def proofs(page: str) -> dict[str, list[str]]:
    """Return the tests named behind every equation, up to the next heading; those of a group stand behind its last one."""
    found: dict[str, list[str]] = {}
    waiting: list[str] = []
    for section in re.split(r"^#+ ", page, flags=re.MULTILINE):
        parts = EQUATION.split(section)
        for label, text in zip(parts[1::3], parts[3::3], strict=True):
            waiting.append(label)
            if names := TEST.findall(text):
                found.update(dict.fromkeys(waiting, names))
                waiting = []
        assert not waiting, f"equations {waiting} name no test"
    return found


@pytest.mark.parametrize("page", THEORY)
def test_every_equation_names_its_proof_and_becomes_mathml(page):
    equations = EQUATION.findall(THEORY[page])
    assert (
        len(proofs(THEORY[page])) == len(re.findall(r"(?m)^```\{math\}", THEORY[page])) == len(equations) > 0
    )
    for formula in [text for _, text in equations] + re.findall(r"\$([^$\n]+)\$", THEORY[page]):
        made = mathml(formula, "block")
        assert made.startswith("<math")
        assert "\\" not in re.sub(r"<annotation.*?</annotation>", "", made), formula


def test_every_test_named_exists():
    named = {test for text in PAGES.values() for test in TEST.findall(text)}
    assert len(named) > 80
    files = {path: (ROOT / path).read_text() for path in {test.partition("::")[0] for test in named}}
    assert [
        one
        for one in sorted(named)
        if f"\ndef {one.partition('::')[2]}(" not in files[one.partition("::")[0]]
    ] == []
