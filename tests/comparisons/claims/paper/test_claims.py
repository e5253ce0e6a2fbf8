"""Every verdict on the paper follows from numbers: each judge says something else about other numbers."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from comparisons.claims.paper import claims_critical_area as critical
from comparisons.claims.paper import claims_examples as examples
from comparisons.claims.paper.claims import CLAIMS, COARSE, Findings, claims_text, judged
from comparisons.claims.paper.critical_area import (
    PRINTED,
    PRINTED_SHEAR_PSI,
    PSI,
    RATIOS,
    CriticalAreas,
    Floor,
    Measured,
)
from comparisons.claims.paper.double_beam import Attempt, Check, Happened, History
from comparisons.claims.paper.ks_shapes import Run8
from comparisons.claims.paper.turned_frame import NAME as TURNED
from comparisons.claims.paper.verdict import Verdict, in_size, over_readings
from comparisons.claims.problems.double_beam import EVENTS, LOWER, TIP, UPPER
from comparisons.compare import PAPER, SOLID
from comparisons.quantities import KEPT

REPRODUCED, IN_DIRECTION, NOT, OPEN = (
    Verdict.REPRODUCED,
    Verdict.IN_DIRECTION,
    Verdict.NOT_REPRODUCED,
    Verdict.CANNOT_BE_TOLD,
)
SIMPLE, CANTILEVER, TIMOSHENKO, MIXED = (
    critical.SIMPLE,
    critical.CANTILEVER,
    critical.TIMOSHENKO,
    critical.MIXED,
)
SLOPES = {SIMPLE: -3.0, CANTILEVER: -3.0, TURNED: -3.0, TIMOSHENKO: -1.0, MIXED: 0.0}
TOLERANCES = (1e-6, 1e-8)
NODES = (1.0, 2.0, 3.0)


def areas(
    sizes: dict[str, tuple[float, float]] | None = None,
    slopes: dict[str, tuple[float, float]] | None = None,
    blocked: tuple[str, ...] = (),
) -> CriticalAreas:
    """A study of one start, three nodes and two tolerances: critical areas per tolerance, slopes per end, who does not pass a node."""
    chosen = {SIMPLE: (0.004, 0.04), CANTILEVER: (0.003, 0.02), TIMOSHENKO: (1e-7, 1e-4), MIXED: (1e-8, 1e-8)}
    chosen |= sizes or {}
    measured = [
        Measured(
            element=element,
            start=4.05,
            tolerance=tolerance,
            node=node,
            displacement=np.array([] if element in blocked and node == NODES[-1] else [0.1]),
            ratio=np.array([] if element in blocked and node == NODES[-1] else [size]),
            smallest=np.nan if element in blocked and node == NODES[-1] else size,
        )
        for element, pair in chosen.items()
        for tolerance, size in zip(TOLERANCES, pair, strict=True)
        for node in NODES
    ]
    floors = [
        Floor(element=element, end=end, psi=PSI, floor=RATIOS**-3, slope=slope)
        for element, slope in SLOPES.items()
        for end, slope in zip(("start", "end"), (slopes or {}).get(element, (slope, slope)), strict=True)
    ]
    stiff = Floor(element=TIMOSHENKO, end="end", psi=PRINTED_SHEAR_PSI, floor=RATIOS**-3, slope=np.nan)
    return CriticalAreas(tolerances=TOLERANCES, measured=tuple(measured), floors=(*floors, stiff))


RANGE = {element: critical._printed_range(element) for element in PRINTED}
LOW, _ = PRINTED[TIMOSHENKO]
ON_CRITICAL_AREA: list[tuple[Callable[[Any], Any], CriticalAreas, Verdict]] = [
    (critical.exists, areas(), REPRODUCED),
    (critical.exists, areas({SIMPLE: (1e-8, 1e-8)}), NOT),
    (critical.cantilever_effective, areas(), NOT),
    (critical.cantilever_effective, areas(slopes={CANTILEVER: (-1, -1), TURNED: (-1, -1)}), REPRODUCED),
    (critical.cantilever_effective, areas(slopes={CANTILEVER: (-1, -3), TURNED: (-1, -3)}), OPEN),
    (critical.cantilever_effective, areas(slopes={TURNED: (-1, -1)}), OPEN),
    (critical.shear_effective, areas(), REPRODUCED),
    (critical.shear_effective, areas(slopes={TIMOSHENKO: (-1, -3)}), NOT),
    (critical.shear_effective, areas({TIMOSHENKO: (0.002, 0.02)}), NOT),
    (critical.singular, areas(), REPRODUCED),
    (critical.singular, areas(slopes={CANTILEVER: (-3, -2)}), NOT),
    (RANGE[SIMPLE], areas({SIMPLE: (0.01, 0.1)}), OPEN),
    (RANGE[SIMPLE], areas({SIMPLE: (0.01, 0.5)}), OPEN),  # between two tolerances
    (RANGE[SIMPLE], areas({SIMPLE: (0.1, 0.1)}), REPRODUCED),
    (RANGE[SIMPLE], areas({SIMPLE: (0.01, 0.02)}), NOT),
    (RANGE[CANTILEVER], areas({CANTILEVER: (0.03, 0.03)}), REPRODUCED),
    (RANGE[TIMOSHENKO], areas(), NOT),
    (critical.order, areas(), REPRODUCED),
    (critical.order, areas({CANTILEVER: (0.005, 0.05)}), NOT),
    (critical.order, areas({TIMOSHENKO: (0.0035, 0.03)}), NOT),
    (critical.cantilever_reduces, areas(), IN_DIRECTION),
    (critical.cantilever_reduces, areas({CANTILEVER: (0.001, 0.02)}), REPRODUCED),
    (critical.cantilever_reduces, areas({CANTILEVER: (0.005, 0.05)}), NOT),
    (critical.shear_reduces, areas(), REPRODUCED),
    (critical.shear_reduces, areas({TIMOSHENKO: (0.001, 0.01)}), IN_DIRECTION),
    (critical.shear_reduces, areas({TIMOSHENKO: (0.1, 0.01)}), NOT),
    (critical.passes, areas(blocked=(SIMPLE, CANTILEVER)), REPRODUCED),
    (critical.passes, areas(), NOT),
    (critical.passes, areas(blocked=(SIMPLE, CANTILEVER, TIMOSHENKO)), NOT),
    (critical.discontinuity_solved, areas(), REPRODUCED),
    (critical.discontinuity_solved, areas(blocked=(TIMOSHENKO,)), NOT),
    (critical.every_edge, areas(), REPRODUCED),
    (critical.every_edge, areas({TIMOSHENKO: (1e-7, 2 * LOW)}), OPEN),
    (critical.every_edge, areas({TIMOSHENKO: (2 * LOW, 2 * LOW)}), NOT),
]


@pytest.mark.parametrize(("judge", "study", "verdict"), ON_CRITICAL_AREA)
def test_critical_area(judge: Any, study: CriticalAreas, verdict: Verdict) -> None:
    assert judge(study).verdict is verdict


def test_direction_and_order_agree() -> None:
    """Both look at the same pairs: where the order is reproduced, the cantilever's area is the smaller one."""
    for part in (0.3, 0.9, 0.999, 1.0, 1.001, 2.0):
        study = areas({CANTILEVER: (part * 0.004, part * 0.04)})
        smaller = critical.cantilever_reduces(study).verdict is not NOT
        assert (critical.order(study).verdict is REPRODUCED) == smaller


def shapes(
    status: str = "COMPLETED", error: tuple[float, ...] = (4e-3, 1e-3, 5e-4), force: float = 3.0
) -> Any:
    """A study of the paper's element with 10, 20 and 50 elements, and the solid; `force` is the error of the force over the shape's."""

    def run(label: str, value: float, status: str, unknowns: int, seconds: float) -> Run8:
        path = dict.fromkeys(KEPT, force * value) | {"shape": value}
        return Run8(
            reading=examples.KS, label=label, status=status, unknowns=unknowns, iterations=1, seconds=seconds,
            errors={"path": path}, shape_difference=value,
        )  # fmt: skip

    runs = [
        run(one.label, value, status if k == 2 else "COMPLETED", 30, 0.1)
        for k, (one, value) in enumerate(zip(PAPER, error, strict=True))
    ]
    runs.append(run(SOLID.label, 5e-4, "COMPLETED", 1004, 1.0))
    return SimpleNamespace(
        runs=tuple(runs), run=lambda _, label: next(one for one in runs if one.label == label)
    )


COARSE_SHAPES = (0.03, 0.02, 0.015)
ON_SHAPES: list[tuple[Callable[[Any], Any], Any, Verdict]] = [
    (examples.anything, shapes(), OPEN),
    (examples.anything, shapes(status="CUTBACK_FLOOR"), NOT),
    (examples.anything, shapes(error=(4e-3, 1e-3, 0.1)), NOT),
    (examples.alike, shapes(), REPRODUCED),
    (examples.alike, shapes(error=(0.02, 1e-3, 5e-4)), NOT),
    (examples.alike, shapes(error=(np.nan, 1e-3, 5e-4)), NOT),
    (examples.few_elements, shapes(), REPRODUCED),
    (examples.few_elements, shapes(error=(4e-3, 0.02, 5e-4)), NOT),
    (examples.simple_enough, shapes(), OPEN),
    (examples.simple_enough, shapes(force=1.0), REPRODUCED),
    (examples.simple_enough, shapes(error=COARSE_SHAPES), NOT),
    (examples.less_division, shapes(), REPRODUCED),
    (examples.less_division, shapes(force=20.0), NOT),
]


@pytest.mark.parametrize(("judge", "study", "verdict"), ON_SHAPES)
def test_shapes(judge: Any, study: Any, verdict: Verdict) -> None:
    assert judge(study).verdict is verdict


def test_cost() -> None:
    study = shapes()
    assert examples.cheaper(study).verdict is REPRODUCED
    slow = replace(study.run("", PAPER[1].label), seconds=2.0)
    runs = {one.label: one for one in study.runs} | {slow.label: slow}
    assert examples.cheaper(SimpleNamespace(run=lambda _, label: runs[label])).verdict is NOT


def lifts(error: float) -> Any:
    lift = SimpleNamespace(
        slip_off_error=lambda _: error, reached={TIMOSHENKO: 1.0}, rod_slip_off=1.0, force_error=error
    )
    return SimpleNamespace(lifts=(lift, lift))


def test_slip_offs() -> None:
    assert examples.followed(lifts(1e-5)).verdict is REPRODUCED
    assert examples.followed(lifts(1e-3)).verdict is NOT


THROUGH = Attempt(
    element=TIMOSHENKO, place=0.81, status="COMPLETED", depth=0.76, passes=5, at_hand_over=False
)
AT_EVENT = replace(THROUGH, status="TWO_CONTACTS", depth=0.53, passes=2, at_hand_over=True)
AT_NODE = replace(THROUGH, place=0.8, status="CUTBACK_FLOOR", depth=0.0, passes=0)


def beams(
    *attempts: Attempt,
    late: dict[tuple[str, str], float] | None = None,
    open_pair: str = "",
    without: str = "",
) -> Any:
    """A study whose events are where the exact rods have them, but for those that come `late`, and one kind that does not."""
    at = {
        ("touch", TIP): EVENTS["touch"],
        ("slip-off", UPPER): EVENTS["hand-over"],
        ("touch", LOWER): EVENTS["hand-over"],
        ("slip-off", LOWER): EVENTS["slip-off"],
    }
    events = [
        Happened(
            kind=kind,
            pair=pair,
            depth=depth + (late or {}).get((kind, pair), 0.0),
            element=8,
            arc=0.9,
            force=1.0,
            released=0.2,
        )
        for (kind, pair), depth in at.items()
        if f"{kind} {pair}" != without
    ]
    depth = np.linspace(0.0, 0.76, 77)
    closed = np.ones(77)
    histories = {
        pair: History(
            force=closed,
            arc=np.nan * closed if pair == open_pair else closed,
            exact_force=closed,
            exact_arc=closed,
        )
        for pair in (UPPER, TIP, LOWER)
    }
    return SimpleNamespace(
        depth=depth,
        histories=histories,
        events=tuple(events),
        attempts=attempts,
        checks=(Check(stage="coupled", pair=UPPER, force=1e-7, arc=1e-7),),
        events_of=lambda kind, pair: [one for one in events if (one.kind, one.pair) == (kind, pair)],
        at_hand_over=lambda pair: [
            one for one in events if one.pair == pair and one.depth == EVENTS["hand-over"]
        ],
    )


ON_BEAMS: list[tuple[Callable[[Any], Any], Any, Verdict]] = [
    (examples.begins, beams(), REPRODUCED),
    (examples.begins, beams(late={("touch", TIP): 0.01}), NOT),
    (examples.begins, beams(without=f"touch {TIP}"), NOT),
    (examples.begins, beams(open_pair=UPPER), NOT),
    (examples.hands_over, beams(), REPRODUCED),
    (examples.hands_over, beams(late={("slip-off", UPPER): 0.01}), NOT),
    (examples.hands_over, beams(without=f"touch {LOWER}"), NOT),
    (examples.leaves, beams(), REPRODUCED),
    (examples.leaves, beams(without=f"slip-off {LOWER}"), NOT),
    (examples.passes_every_edge, beams(THROUGH, THROUGH), REPRODUCED),
    (examples.passes_every_edge, beams(THROUGH, AT_EVENT), OPEN),
    (examples.passes_every_edge, beams(AT_NODE, AT_EVENT), OPEN),
    (examples.passes_every_edge, beams(AT_EVENT, AT_EVENT), OPEN),
    (examples.passes_every_edge, beams(AT_NODE, AT_NODE), NOT),
    (examples.simultaneous, beams(AT_NODE, AT_EVENT), REPRODUCED),
    (examples.simultaneous, beams(AT_NODE), NOT),
]


@pytest.mark.parametrize(("judge", "study", "verdict"), ON_BEAMS)
def test_beams(judge: Any, study: Any, verdict: Verdict) -> None:
    assert judge(study).verdict is verdict


def test_no_judge_always_says_the_same() -> None:
    """Every claim's judge has given at least two verdicts above."""
    given: dict[str, set[Verdict]] = {}
    for judge, _, verdict in (*ON_CRITICAL_AREA, *ON_SHAPES, *ON_BEAMS):
        given.setdefault(judge.__qualname__, set()).add(verdict)
    tested_apart = {examples.cheaper.__qualname__, examples.followed.__qualname__}
    assert {claim.judge.__qualname__ for claim in CLAIMS} == set(given) | tested_apart
    assert all(len(verdicts) > 1 for verdicts in given.values())


def test_readings() -> None:
    def verdict(*cases: bool | None) -> Verdict:
        return over_readings(cases, "", "").verdict

    assert verdict(True, True) is REPRODUCED
    assert verdict(False, False) is NOT
    assert verdict(True, False) is verdict(True, None) is verdict(None, False) is verdict(None) is OPEN
    with pytest.raises(ValueError, match="cases"):
        verdict()
    assert in_size(direction=False, size=True, number="", why="").verdict is NOT


def test_a_claim_made_twice_counts_once() -> None:
    assert len(CLAIMS) == 25
    assert sum(len(claim.stated) for claim in CLAIMS) == 27
    assert len({claim.judge for claim in CLAIMS}) == len(CLAIMS)
    twice = {claim.judge.__name__: claim.source for claim in CLAIMS if len(claim.stated) > 1}
    assert twice == {
        "shear_effective": "abstract; conclusion 1",
        "passes_every_edge": "4.3; conclusion 3",
    }


def test_coarse_settings_decide_nothing() -> None:
    full, quick = (Findings(quick=quick, fig7b=areas()) for quick in (False, True))
    assert "fig7b" in COARSE
    for (claim, sure), (same, open_) in zip(judged(full), judged(quick), strict=True):
        assert claim is same
        assert sure.verdict is not Verdict.PROVISIONAL
        assert open_.verdict is Verdict.PROVISIONAL
        assert f"With coarse settings: {sure.verdict}." in open_.why
    assert "13 of 25 claims judged (27 statements): 13 provisional" in claims_text(quick)
    assert "provisional" not in claims_text(full)
