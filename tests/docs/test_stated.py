"""Every measured number of the results has a mark, and every mark has a test that measures its numbers."""

import ast
import re
from collections.abc import Iterator
from functools import cache

import pytest

from tests.benchmarks.measure import slug
from tests.stated import LOOSE, MARK, NUMBER, ROOT, Stated, holds, marked, pages

RESULTS = [ROOT / "README.md", *sorted((ROOT / "docs" / "results").glob("*.md"))]


COMPUTED = {
    "accuracy.{}": "free mixed",
    "bench.assembly-over-factorisation-{}": "200x4",
    "bench.bilinearform-over-batched-products-{}": "50x2 200x4 1000x20",
    "bench.iteration-of-the-solid-over-superlu-with-four-solutions-{}": "50x2 200x4",
    "bench.mixed-{}-over-exact-1-at-error-1e-6-seconds": "20",
    "bench.solid-over-tsm-at-.1-of-f-{}-seconds": "end-state 50-load-parameters",
    "budget.rest-{}": "ks-cantilever ks-face",
    "calculix.{}-{}": "rod-50x2 rod-100x4 full-50x2 full-100x4",
    "calculix.largest-{}": "0.02 0.01 0.005 0.0025",
    "calculix.pin-{}": "0.02 0.01 0.005 0.0025",
    "double-beam.mixed-{}": "3 10 40",
    "errors.{}": "timoshenko-10 timoshenko-20 timoshenko-50 mixed-10 mixed-20 exact-1 solid elastica",
    "exact.places-{}": "4.1 4.2 4.3",
    "extremes.{}": "right stopped withdrawn",
    "friction-over-mu.mixed-{}": "10 20",
    "friction-over-mu.solid-{}": "st-venant-kirchhoff biot-linear",
    "friction.paper-{}": "10 20 50",
    "friction.{}": "rod elastica exact",
    "friction.solid-{}x{}": "25x1 50x2 100x4",
    "ks.mixed-{}": "5 10 20 40 200",
    "paper.tolerance-{}": "euler-bernoulli-simple euler-bernoulli-cantilever timoshenko",
    "paper.{}": "reproduced in-direction not-reproduced open",
    "sliding.places-{}": "4.1 4.2 4.3",
    "solid.double-beam-{}": "axis face",
    "solid.finer-{}": "ks-cantilever ks-face",
    "solid.last-{}": "ks-cantilever ks-face",
    "solid.locking-{}": "0.02-0.3 0.02-0.49 0.02-0.4999 0.002-0.3 0.002-0.49 0.002-0.4999",
    "solid.rods-law-{}": "ks-cantilever ks-face",
    "solid.scatter-{}": "ks-cantilever ks-face",
    "solid.thin-{}": "0.02 0.01 0.005",
    "verify.{}": "INSIDE MOTION STRAIN",
    "unknowns.{}": "timoshenko-10 timoshenko-20 timoshenko-50 mixed-10 mixed-20 exact-1 solid elastica",
}
"""Names that tests compute, and what takes the place of what they compute. `make test-all` fails at a name that none has computed."""


@cache
def names_in_tests() -> frozenset[str]:
    """Return the first argument of every call of ``stated``, and the mark of every `Gate`, with {} for what is computed."""
    found = set()
    texts = [path.read_text() for path in (ROOT / "tests").rglob("*.py")]
    for call in (
        node for text in texts if "stated(" in text or "Gate(" in text for node in ast.walk(ast.parse(text))
    ):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") in ("stated", "Gate"):
            parts = getattr(call.args[0], "values", [call.args[0]])
            words = [str(part.value) if isinstance(part, ast.Constant) else "{}" for part in parts]
            if call.func.id == "Gate":
                words = ["bench.", *(word if word == "{}" else slug(word) for word in words)]
            found.add("".join(words).strip("-"))
    return frozenset(found)


def unmeasured(text: str) -> list[str]:
    """Return the marks of a text that no test measures."""
    known = set(names_in_tests())
    for name, places in COMPUTED.items():
        before, after = name[: name.index("{")], name[name.rindex("}") + 1 :]
        assert name in known, f"no test computes {name}"
        known |= {f"{before}{place}{after}" for place in places.split()}
    return sorted(set(MARK.findall(text)) - known)


def test_every_mark_has_a_test():
    text = "".join(page.read_text() for page in pages())
    assert len(MARK.findall(text)) > 150
    assert unmeasured(text) == []
    assert unmeasured("<!--errors.invented-->1 <!--invented x2-->1 2") == ["errors.invented", "invented"]


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
