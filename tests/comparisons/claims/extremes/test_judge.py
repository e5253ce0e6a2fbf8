"""What is right, stopped and wrong, and what theory allows."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure
from comparisons.cases.store import ERROR, WORKER_LOST
from comparisons.claims.claim import Verdict
from comparisons.claims.extremes.allowance import LARGEST, allowance
from comparisons.claims.extremes.cell import Cell, Judgement, judged
from comparisons.claims.extremes.checks import Against
from comparisons.claims.extremes.rows import against_rod, beam_case, exact_rod
from comparisons.claims.extremes.scenes import cantilever, half_circle, sheared
from comparisons.models.options import Options
from comparisons.models.theory import Bending
from comparisons.models.verify import CHECK_FAILED
from tsm.elements import ELEMENTS

SCENE = half_circle(cantilever())
CASE = beam_case(SCENE, ELEMENTS["mixed"], 10)
CELL = Cell(axis="elements", row="mixed", column="10", case=CASE, checks=(against_rod(CASE),))
ROD = exact_rod(SCENE)
Change = Callable[[Measurement], Measurement]


@cache
def measured(case: Case) -> Measurement:
    return measure(case, repeats=0)


def judge(own: Measurement, cell: Cell = CELL) -> Judgement:
    needed = {case: measured(case) for case in cell.cases[1:]}
    return judged(cell, {**needed, cell.case: own})


def off(measurement: Measurement, part: float) -> Measurement:
    """Return a measurement whose contact forces are off by `part` of themselves."""
    response = measurement.response
    contacts = {pair: replace(one, force=(1 + part) * one.force) for pair, one in response.contacts.items()}
    return replace(measurement, response=replace(response, contacts=contacts))


def stopped(measurement: Measurement, status: str = "CUTBACK_FLOOR") -> Measurement:
    """Return what is left of a measurement that stopped half-way."""
    response = measurement.response
    half = replace(response, status=status, completed=False, load_parameter=response.load_parameter[:5])
    return replace(measurement, response=half)


def empty(measurement: Measurement, status: str) -> Measurement:
    """Return a measurement that stopped before the first load parameter."""
    nothing = replace(measurement.response, status=status, load_parameter=np.zeros(0))
    return replace(measurement, response=nothing)


def test_an_answer_within_its_theory_is_right() -> None:
    found = judge(measured(CASE))
    assert found.verdict is Verdict.RIGHT
    assert found.decisive is not None
    assert 1e-6 < found.decisive.error < found.decisive.allowed < 1e-3
    assert found.reached == 1.0


BECOMES: dict[str, tuple[Change, Verdict]] = {
    "off": (lambda m: off(m, 1e-3), Verdict.WRONG),
    "not a number": (lambda m: off(m, np.nan), Verdict.WRONG),
    "stopped": (stopped, Verdict.STOPPED),
    "stopped, and off before": (lambda m: stopped(off(m, 1e-3)), Verdict.WRONG),
    "withdrawn by its own checks": (lambda m: stopped(off(m, 1e-3), CHECK_FAILED), Verdict.WITHDRAWN),
    "raised": (lambda m: stopped(m, ERROR), Verdict.WRONG),
    "died": (lambda m: stopped(m, WORKER_LOST), Verdict.WRONG),
}


@pytest.mark.parametrize("case", BECOMES)
def test_verdict(case: str) -> None:
    change, verdict = BECOMES[case]
    found = judge(change(measured(CASE)))
    assert found.verdict is verdict
    assert found.status in found.sentence


def test_a_check_that_refuses_a_right_answer_is_needless() -> None:
    own = measured(CASE)
    assert judge(stopped(own, CHECK_FAILED)).needless
    assert not judge(stopped(off(own, 1e-3), CHECK_FAILED)).needless
    assert not judge(own).needless
    nothing = empty(own, CHECK_FAILED)
    assert not judge(nothing).needless


def test_whatever_goes_on_where_its_reference_stopped_is_wrong() -> None:
    found = judged(CELL, {CASE: measured(CASE), ROD: stopped(measured(ROD), "LOST")})
    assert found.verdict is Verdict.WRONG
    assert found.decisive is not None
    assert found.decisive.error == np.inf


def test_a_stop_at_the_start_claims_nothing() -> None:
    nothing = empty(measured(CASE), "SINGULAR_TANGENT")
    found = judge(nothing)
    assert (found.verdict, found.findings, found.reached) == (Verdict.STOPPED, (), 0.0)


def test_round_off_is_allowed_where_a_stiffness_multiplies_it() -> None:
    """Lengths 1 : 1e6: `mixed`, whose force is an unknown, may be off by its order alone; a force changed by 19 % is wrong."""
    nodes = tuple((1 - np.cumsum(np.logspace(0, 6, 20) / np.logspace(0, 6, 20).sum())[:-1][::-1]).tolist())
    scene = half_circle(cantilever(nodes=nodes))
    assert 1 - nodes[-1] < 1e-6
    assert nodes[0] > 0.5
    mixed, paper = (
        allowance(beam_case(scene, ELEMENTS[element], None), BENT) for element in ("mixed", "timoshenko")
    )
    assert mixed.why == "fourth order of the element"
    assert mixed.error == pytest.approx(2 * (4.0 * nodes[0]) ** 4 / 1920, rel=1e-2)
    assert paper.error == LARGEST
    case = beam_case(scene, ELEMENTS["mixed"], None)
    cell = Cell(axis="ratio", row="mixed", column="1e6", case=case, checks=(against_rod(case),))
    assert judge(measured(case), cell).verdict is Verdict.RIGHT
    assert judge(off(measured(case), 0.19), cell).verdict is Verdict.WRONG
    assert judge(off(measured(case), 0.05), cell).verdict is Verdict.WRONG


BENT = Bending(force=8.0, curvature=4.0, turn=2.5, nearest=0.6)


def allowed(element: str, elements: int) -> float:
    return allowance(
        beam_case(half_circle(cantilever(slenderness=1e4)), ELEMENTS[element], elements), BENT
    ).error


def test_allowed_errors_fall_with_the_order_of_the_element() -> None:
    assert allowed("timoshenko", 10) / allowed("timoshenko", 20) == pytest.approx(4, rel=0.01)
    assert allowed("mixed", 10) / allowed("mixed", 20) == pytest.approx(16, rel=0.01)
    assert allowed("exact", 1) == allowed("exact", 7) < 1e-7


def test_no_theory_allows_more_than_the_cap() -> None:
    most = allowance(beam_case(half_circle(sheared(25.0)), ELEMENTS["mixed"], 20), BENT)
    assert most.error == LARGEST
    assert "third power of the shear strain" in most.why


def test_the_inner_moment_counts_where_the_beam_turns_by_more_than_a_right_angle() -> None:
    """At the end of the half circle the clamp's moment is pi EI/L, the largest is the square root of 2 F EI."""
    last = half_circle(cantilever(slenderness=1e5), steps=1)
    check = Against(case=exact_rod(last))
    coarse = Case(scene=last, model="tsm", options=Options(element="timoshenko", elements=20))
    found = check.finding(coarse, measured(coarse).response, {check.case: measured(check.case)})
    assert found is not None
    assert found.allowed == pytest.approx(4 * (np.sqrt(2 * 8.18212814018414) / 20) ** 2 / 24, rel=1e-3)
