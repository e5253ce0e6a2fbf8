"""Every verdict on the paper follows from numbers: each judge says something else about other numbers; the floor of round-off below them."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

# not public: judges of numbers that no run gives, and the floor of an element's forces, which no solution shows
from comparisons.claims.paper import claims_critical_area as critical
from comparisons.claims.paper import claims_examples as examples
from comparisons.claims.paper.approach import NEAREST, Approach, approaches
from comparisons.claims.paper.claims import CLAIMS, COARSE, Findings, claims_text, judged
from comparisons.claims.paper.critical_area import (
    PRINTED,
    PRINTED_SHEAR_PSI,
    PSI,
    RATIOS,
    SCENE,
    CriticalAreas,
    Floor,
    Measured,
)
from comparisons.claims.paper.double_beam import Attempt, Check, Happened, History
from comparisons.claims.paper.force_floor import force_floor
from comparisons.claims.paper.ks_shapes import Run8
from comparisons.claims.paper.turned_frame import NAME as TURNED
from comparisons.claims.paper.verdict import Verdict, in_size, over_readings
from comparisons.claims.problems.double_beam import LOWER, TIP, UPPER
from comparisons.compare import PAPER, SOLID
from comparisons.models.translate import to_structure
from comparisons.quantities import KEPT
from comparisons.scene import load_scene
from tests.comparisons.claims.paper.test_reproduce import PAPER as STATED

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


def costs(seconds: float) -> Any:
    """The same study with other seconds of the paper's element."""
    study = shapes()
    runs = {one.label: one for one in study.runs}
    runs[PAPER[1].label] = replace(runs[PAPER[1].label], seconds=seconds)
    return SimpleNamespace(run=lambda _, label: runs[label])


def lifts(error: float) -> Any:
    lift = SimpleNamespace(
        slip_off_error=lambda _: error, reached={TIMOSHENKO: 1.0}, rod_slip_off=1.0, force_error=error
    )
    return SimpleNamespace(lifts=(lift, lift))


EXACT = {"touch": 0.15, "hand-over": 0.54, "slip-off": 0.74}
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
        ("touch", TIP): EXACT["touch"],
        ("slip-off", UPPER): EXACT["hand-over"],
        ("touch", LOWER): EXACT["hand-over"],
        ("slip-off", LOWER): EXACT["slip-off"],
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
        exact_events=EXACT,
        events=tuple(events),
        end="pin at the tip",
        attempts=attempts,
        checks=(Check(stage="coupled", pair=UPPER, force=1e-7, arc=1e-7),),
        events_of=lambda kind, pair: [one for one in events if (one.kind, one.pair) == (kind, pair)],
        at_hand_over=lambda pair: [
            one for one in events if one.pair == pair and one.depth == EXACT["hand-over"]
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


JUDGED = [
    *ON_CRITICAL_AREA,
    *ON_SHAPES,
    *ON_BEAMS,
    (examples.cheaper, costs(0.1), REPRODUCED),
    (examples.cheaper, costs(2.0), NOT),
    (examples.followed, lifts(1e-5), REPRODUCED),
    (examples.followed, lifts(1e-3), NOT),
]


@pytest.mark.parametrize(("judge", "study", "verdict"), JUDGED)
def test_a_verdict_follows_from_the_numbers(judge: Any, study: Any, verdict: Verdict) -> None:
    assert judge(study).verdict is verdict


def test_every_claim_is_judged_once_and_no_judge_always_says_the_same() -> None:
    """Two of the 25 claims are made twice in the paper."""
    given: dict[str, set[Verdict]] = {}
    for judge, _, verdict in JUDGED:
        given.setdefault(judge.__qualname__, set()).add(verdict)
    assert {claim.judge.__qualname__ for claim in CLAIMS} == set(given)
    assert all(len(verdicts) > 1 for verdicts in given.values())
    for claim, (where, words, figure, _) in zip(CLAIMS, STATED, strict=True):
        assert (claim.source, claim.figure, len(claim.stated)) == (where, figure, len(words))
        assert all(word in text for word, (_, text) in zip(words, claim.stated, strict=True))
    assert (len(CLAIMS), sum(len(claim.stated) for claim in CLAIMS)) == (25, 27)
    assert "0 of 25 claims judged (27 statements)." in claims_text(Findings(quick=True))


def test_direction_and_order_agree() -> None:
    """Both look at the same pairs: where the order is reproduced, the cantilever's area is the smaller one."""
    for part in (0.3, 0.9, 0.999, 1.0, 1.001, 2.0):
        study = areas({CANTILEVER: (part * 0.004, part * 0.04)})
        smaller = critical.cantilever_reduces(study).verdict is not NOT
        assert (critical.order(study).verdict is REPRODUCED) == smaller


def test_readings() -> None:
    def verdict(*cases: bool | None) -> Verdict:
        return over_readings(cases, "", "").verdict

    assert verdict(True, True) is REPRODUCED
    assert verdict(False, False) is NOT
    assert verdict(True, False) is verdict(True, None) is verdict(None, False) is verdict(None) is OPEN
    with pytest.raises(ValueError, match="cases"):
        verdict()
    assert in_size(direction=False, size=True, number="", why="").verdict is NOT


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


def ways(element: str, tolerance: float) -> tuple[Approach, ...]:
    """The ways of the contact to the beam's nodes at a fixed tolerance."""
    scene = load_scene(SCENE)
    scene = replace(scene, pins=(replace(scene.pins[0], start=(4.2, 0.0)),))
    return approaches(to_structure(scene, element=element), tolerance)


@pytest.mark.slow
def test_the_critical_area_grows_with_the_sharpness_of_the_tolerance() -> None:
    """``b^-3`` and ``b^-1``: a tolerance 1e4 times sharper widens it by about 20 and 1e4; `mixed` has none."""
    for element, factor in ((SIMPLE, 1e4 ** (1 / 3)), (TIMOSHENKO, 1e4)):
        loose, sharp = (ways(element, tolerance)[0].smallest for tolerance in (1e-7, 1e-11))
        assert factor / 6 < sharp / loose < 6 * factor
    for tolerance in (1e-6, 1e-12):
        assert all(way.smallest <= NEAREST for way in ways(MIXED, tolerance))


def test_the_way_ends_where_the_pin_slips_off() -> None:
    """Section 4.1: the exact rod slips off a pin at 4.2 m at 1.4716026278 m."""
    found = ways(MIXED, 1e-9)
    assert [way.node for way in found] == [4.25, 4.5]
    assert all(way.smallest <= NEAREST for way in found)
    last = found[-1]
    assert 1.8 * last.load_parameter[-1] == pytest.approx(1.4716026278, rel=2e-5)
    assert np.all(np.diff(last.load_parameter) > 0)
    assert np.all(np.diff(last.ratio) < 0)


def slope(element: str, end: Any, ratios: Any = 10.0 ** -np.arange(1, 14, 2), **options: float) -> float:
    floors = [force_floor(element, float(ratio), end=end, samples=25, **options) for ratio in ratios]
    return float(np.polyfit(np.log10(ratios), np.log10(floors), 1)[0])


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("element", [*SLOPES, "mixed-no-bow"])
def test_slope(element: str, end: str) -> None:
    expected = SLOPES.get(element, 0.0)
    assert slope(element, end) == pytest.approx(expected, abs={-3.0: 0.3, -1.0: 0.2, 0.0: 0.1}[expected])


def test_timoshenko_is_euler_bernoulli_until_the_distance_falls_below_the_shear_length() -> None:
    """``sqrt(Psi)`` = 1e-3 of the element: the same cubic floor above, a linear one below."""
    above = [force_floor(name, 1e-2, Psi=1e-6, samples=200) for name in (TIMOSHENKO, SIMPLE)]
    assert above[0] == pytest.approx(above[1], rel=0.25)
    assert slope(TIMOSHENKO, "start", 10.0 ** -np.arange(4, 13), Psi=1e-6) == pytest.approx(-1, abs=0.2)


def test_mixed_has_the_floor_of_mid_element_everywhere() -> None:
    middle = force_floor(MIXED, 0.5)
    for end, ratio in (
        ("start", 0.0),
        ("end", 0.0),
        ("start", 1e-300),
        ("end", 1e-16),
        ("start", 1e-8),
        ("end", 1e-2),
    ):
        assert force_floor(MIXED, ratio, end=end) <= 1.5 * middle


@pytest.mark.parametrize("elements", [10, 100, 1000])
def test_the_size_is_the_contact_stiffness_times_the_last_bit_of_a_coordinate(elements: int) -> None:
    """``3 EI/b^3`` times ``eps L/10`` (half a last bit, root mean square, of coordinates up to L), in EI/L^2."""
    ratio = 1e-4
    expected = 3 / ratio**3 * np.finfo(float).eps * elements / 10 * elements**2
    floor = force_floor(SIMPLE, ratio, elements=elements, samples=200)
    assert 0.5 < floor / expected < 2


@pytest.mark.parametrize(
    ("arguments", "options", "field"),
    [
        (("spring", 0.1), {}, "element"),
        ((MIXED, 1.5), {}, "ratio"),
        ((MIXED, float("nan")), {}, "ratio"),
        *(((MIXED, 0.1), {name: value}, name) for name, value in {"end": "middle", "Psi": 0.0, "elements": 0, "samples": 0}.items()),
    ],
)  # fmt: skip
def test_the_input_of_a_floor_is_checked(arguments: Any, options: Any, field: str) -> None:
    with pytest.raises(ValueError, match=field):
        force_floor(*arguments, **options)
