"""The faults that are put into a module, the draw of a sample, and that tests tell a few of the worst faults."""

import sys
from collections import Counter
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from mutants import mutants
from sample import draw, interval, population, reasons, stages
from trial import ROOT, project_copy, run_changed

SOURCE = '''
def root(x: float) -> float:
    """Not 1 + 1."""
    assert x > 0, "a length"
    if x < 2 and x:
        log(x)
        x *= 2.5
    return -x
'''
CHANGES = {
    "if (False):",
    "if (True):",
    "if (x < 2 or x):",
    "if (x <= 2) and x:",
    "if (x >= 2) and x:",
    "if x < (3) and x:",
    "pass",
    "x /= 2.5",
    "x *= (6.0)",
    "return (x)",
}
_EVENTS = "tests/tsm/test_contact_events.py"
WORST = [
    ("tsm/groups/closed_form.py", "height = ((py * tx + px * ty)) / math.hypot(tx, ty)", _EVENTS),
    ("tsm/events.py", "push = model.pairs[k].side * ((fy * dx + fx * dy))", _EVENTS),
    (
        "tsm/stepping.py",
        "changed = (0 > new != old) and (new > old or self.track.tangent.index == old)",
        "tests/tsm/test_path.py",
    ),
    ("tsm/elements/mixed_contact.py", "dot = (ax * bx - ay * by)", "tests/tsm/test_elements.py"),
    ("tsm/rods/assembly.py", "moment[s + 1] = (moment[s] - gain[s])", "tests/tsm/test_rod_element.py"),
    ("comparisons/exact/chain.py", "ny = (ny - load)", "tests/comparisons/exact/test_chain.py"),
]


def test_every_fault_is_put_in_once():
    """Operators, numbers, signs, conditions and effects; neither asserts nor annotations nor texts."""
    found = mutants("root.py", SOURCE)
    assert {mutant.after for mutant in found} == CHANGES
    assert Counter(mutant.after for mutant in found) == Counter([*CHANGES, "pass"])
    lines = SOURCE.splitlines()
    for mutant in found:
        assert " ".join(lines[mutant.line - 1].split()) == mutant.before
        changed = mutant.source.splitlines()
        assert [n + 1 for n, line in enumerate(lines) if changed[n] != line] == [mutant.line]
        compile(mutant.source, "root.py", "exec")


def test_a_sample_is_proportional_and_repeats():
    every = population()
    size = Counter(mutant.module for mutant in every)
    drawn = draw(every, 5, 200)
    assert len({id(mutant) for mutant in drawn}) == 200
    for module, count in Counter(mutant.module for mutant in drawn).items():
        assert abs(count - 200 * size[module] / len(every)) < 2
    assert draw(every, 5, 200) == drawn
    assert draw(every, 6, 200) != drawn


def test_the_interval_is_wilsons():
    """Newcombe, Statistics in Medicine 17 (1998) 857, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29."""
    for killed, count, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ):
        assert interval(killed, count) == pytest.approx((low, high), abs=5e-5)


def test_every_module_has_tests_and_every_reason_its_mutant():
    every = population()
    for files in (files for module in {mutant.module for mutant in every} for files in stages(module)):
        assert all((ROOT / file).exists() for file in files)
    assert set(reasons()) <= {(mutant.module, mutant.before, mutant.after) for mutant in every}


@pytest.fixture(scope="module")
def copy():
    with project_copy() as folder:
        yield folder


@pytest.mark.slow
@pytest.mark.parametrize(("module", "after", "file"), WORST)
def test_a_fault_is_told(copy, module, after, file):
    (mutant,) = [
        one for one in mutants(module, (ROOT / module).read_text(encoding="utf-8")) if one.after == after
    ]
    assert run_changed(copy, module, mutant.source, [file], seconds=300.0).by.startswith(file)
