"""Every verdict on the paper follows from numbers, and is another one with other numbers; the floor of round-off below them."""

import numpy as np
import pytest

from comparisons.answer.quantities import KEPT
from comparisons.models.tsm import to_structure
from comparisons.suites.compare import PAPER, SOLID

# not public: verdicts on numbers that no run gives, and the floor of an element's forces, which no solution shows
from comparisons.suites.paper import fig7 as study
from comparisons.suites.paper import fig8, fig9
from comparisons.suites.paper.approach import NEAREST, approaches
from comparisons.suites.paper.fig9 import EVENTS as EXACT
from comparisons.suites.paper.fig9 import LOWER, TIP, UPPER
from comparisons.suites.paper.figure import CANTILEVER, MIXED, SIMPLE, TIMOSHENKO
from comparisons.suites.paper.force_floor import TURNED
from comparisons.suites.paper.reproduce import CLAIMS, Verdict, claims_text, judged
from comparisons.suites.paper.reproduce import verdict as verdict_of

REPRODUCED, IN_DIRECTION, NOT, OPEN = list(Verdict)[:4]
SLOPES = {SIMPLE: -3.0, CANTILEVER: -3.0, TURNED: -3.0, TIMOSHENKO: -1.0, MIXED: 0.0}
TOLERANCES = (1e-6, 1e-8)


def areas(sizes=None, slopes=None, blocked=()):
    """The numbers of one start, three nodes and two tolerances: critical areas per tolerance, slopes per end, who does not pass a node."""
    chosen = {SIMPLE: (0.004, 0.04), CANTILEVER: (0.003, 0.02), TIMOSHENKO: (1e-7, 1e-4), MIXED: (1e-8, 1e-8)}
    found = [
        {
            "element": element, "tolerance": tolerance, "start": 4.05, "node": node,
            "smallest": np.nan if element in blocked and node == 3.0 else pair[number],
        }
        for number, tolerance in enumerate(TOLERANCES)
        for element, pair in (chosen | (sizes or {})).items()
        for node in (1.0, 2.0, 3.0)
    ]  # fmt: skip
    steep = {element: (slope, slope) for element, slope in SLOPES.items()} | (slopes or {})
    before = [steep[of["element"]][of["end"] == "end"] for of in study.FLOORS[:-1]]
    floors = np.array([study.RATIOS**slope for slope in (*before, -3.0)])
    return study.measured(found, floors, TOLERANCES[1])


def shapes(status="COMPLETED", error=(4e-3, 1e-3, 5e-4), force=3.0, seconds=0.1):
    """The numbers of the paper's element with 10, 20 and 50 elements, and the solid; `force` is the error of the force over the shape's."""

    def run(label, value, unknowns=30, seconds=seconds, status="COMPLETED"):
        errors = {f"error_path_{name}": force * value for name in KEPT} | {"error_path_shape": value}
        return errors | {
            "reading": fig8.KS, "label": label, "status": status, "unknowns": unknowns, "iterations": 1, "seconds": seconds,
            "shape_difference": value, "follows_the_rod": status == "COMPLETED" and value < 0.05,
        }  # fmt: skip

    runs = [run(one.label, value) for one, value in zip(PAPER[:2], error, strict=False)]
    runs += [run(PAPER[2].label, error[2], status=status), run(SOLID.label, 5e-4, 1004, 1.0)]
    return {"readings": fig8.READINGS, **fig8.of_shapes(runs)}


def lifts(error=1e-5):
    lift = {
        "slip_off_error": {18: error, 72: error}, "paper_followed": True, "force_error": error,
    }  # fmt: skip
    return {"starting_positions": [lift, lift]}


THROUGH = {
    "element": TIMOSHENKO, "place": 0.81, "status": "COMPLETED", "depth": 0.76, "passes": 5, "through": True,
}  # fmt: skip
AT_EVENT = THROUGH | {"status": "TWO_CONTACTS", "depth": 0.53, "passes": 2, "through": None}
AT_NODE = THROUGH | {"place": 0.8, "status": "CUTBACK_FLOOR", "depth": 0.0, "passes": 0, "through": False}


def beams(*attempts, late="", open_pair="", without=""):
    """The numbers of a run whose events are where the exact rods have them, but for those that come `late`, and one kind that does not."""
    at = {
        f"touch {TIP}": "touch",
        f"slip-off {UPPER}": "hand-over",
        f"touch {LOWER}": "hand-over",
        f"slip-off {LOWER}": "slip-off",
    }
    events = [
        dict(zip(("kind", "pair"), one.split(), strict=True), depth=EXACT[name] + 0.01 * (one == late), element=8, released=0.2)
        for one, name in at.items()
        if one != without
    ]  # fmt: skip
    columns = {"depth": np.linspace(0.0, 0.76, 77), f"{TIP} exact_force": np.ones(77)}
    columns |= {
        f"{pair} arc": np.full(77, np.nan if pair == open_pair else 1.0) for pair in (UPPER, TIP, LOWER)
    }
    return {
        "exact_events": EXACT, "events": events, "attempts": attempts or (AT_NODE, AT_EVENT),
        "checks": [{"stage": "coupled", "pair": UPPER, "force": 1e-7, "arc": 1e-7}], **fig9.of_events(columns, events),
    }  # fmt: skip


LOW, _ = study.PRINTED[TIMOSHENKO]
TWICE = 2 * LOW
BOTH = {CANTILEVER: (-1, -1), TURNED: (-1, -1)}
BASE = {"fig7a": lifts(), "fig7b": areas(), "fig8": shapes(), "fig9": beams()}
OTHERS = [
    ("exists", REPRODUCED, [(areas({SIMPLE: (1e-8, 1e-8)}), NOT)]),
    ("cantilever-effective", NOT, [(areas(slopes=BOTH), REPRODUCED), (areas(slopes={TURNED: (-1, -1)}), OPEN)]),
    ("cantilever-effective", NOT, [(areas(slopes=dict.fromkeys(BOTH, (-1, -3))), OPEN)]),
    ("shear-effective", REPRODUCED, [(areas(slopes={TIMOSHENKO: (-1, -3)}), NOT), (areas({TIMOSHENKO: (0.002, 0.02)}), NOT)]),
    ("singular", REPRODUCED, [(areas(slopes={CANTILEVER: (-3, -2)}), NOT)]),
    # the second is between two tolerances
    (f"range-{SIMPLE}", NOT, [(areas({SIMPLE: (0.01, 0.1)}), OPEN), (areas({SIMPLE: (0.01, 0.5)}), OPEN)]),
    (f"range-{SIMPLE}", NOT, [(areas({SIMPLE: (0.1, 0.1)}), REPRODUCED)]),
    (f"range-{CANTILEVER}", NOT, [(areas({CANTILEVER: (0.03, 0.03)}), REPRODUCED)]),
    (f"range-{TIMOSHENKO}", NOT, [(areas({TIMOSHENKO: (TWICE, TWICE)}), REPRODUCED)]),
    ("order", REPRODUCED, [(areas({CANTILEVER: (0.005, 0.05)}), NOT), (areas({TIMOSHENKO: (0.0035, 0.03)}), NOT)]),
    ("cantilever-reduces", IN_DIRECTION, [(areas({CANTILEVER: (0.001, 0.02)}), REPRODUCED), (areas({CANTILEVER: (0.005, 0.05)}), NOT)]),
    ("shear-reduces", REPRODUCED, [(areas({TIMOSHENKO: (0.001, 0.01)}), IN_DIRECTION), (areas({TIMOSHENKO: (0.1, 0.01)}), NOT)]),
    ("passes", NOT, [(areas(blocked=(SIMPLE, CANTILEVER)), REPRODUCED), (areas(blocked=(SIMPLE, CANTILEVER, TIMOSHENKO)), NOT)]),
    ("discontinuity-solved", REPRODUCED, [(areas(blocked=(TIMOSHENKO,)), NOT)]),
    ("every-edge", REPRODUCED, [(areas({TIMOSHENKO: (1e-7, TWICE)}), OPEN), (areas({TIMOSHENKO: (TWICE, TWICE)}), NOT)]),
    ("anything", OPEN, [(shapes(status="CUTBACK_FLOOR"), NOT), (shapes(error=(4e-3, 1e-3, 0.1)), NOT)]),
    ("alike", REPRODUCED, [(shapes(error=(0.02, 1e-3, 5e-4)), NOT), (shapes(error=(np.nan, 1e-3, 5e-4)), NOT)]),
    ("few-elements", REPRODUCED, [(shapes(error=(4e-3, 0.02, 5e-4)), NOT)]),
    ("simple-enough", OPEN, [(shapes(force=1.0), REPRODUCED), (shapes(error=(0.03, 0.02, 0.015)), NOT)]),
    ("less-division", REPRODUCED, [(shapes(force=20.0), NOT)]),
    ("cheaper", REPRODUCED, [(shapes(seconds=2.0), NOT)]),
    ("followed", REPRODUCED, [(lifts(1e-3), NOT)]),
    ("begins", REPRODUCED, [(beams(late=f"touch {TIP}"), NOT), (beams(without=f"touch {TIP}"), NOT), (beams(open_pair=UPPER), NOT)]),
    ("hands-over", REPRODUCED, [(beams(late=f"slip-off {UPPER}"), NOT), (beams(without=f"touch {LOWER}"), NOT)]),
    ("leaves", REPRODUCED, [(beams(without=f"slip-off {LOWER}"), NOT)]),
    ("passes-every-edge", OPEN, [(beams(THROUGH, THROUGH), REPRODUCED), (beams(AT_NODE, AT_NODE), NOT)]),
    ("passes-every-edge", OPEN, [(beams(THROUGH, AT_EVENT), OPEN), (beams(AT_EVENT, AT_EVENT), OPEN)]),
    ("simultaneous", REPRODUCED, [(beams(AT_NODE), NOT)]),
]  # fmt: skip
"""Claims, with their verdicts on the studies without changes and with them."""


def test_every_claim_is_judged_by_its_numbers():
    """Two of the 25 claims are made twice in the paper; no verdict is always the same."""
    assert set(CLAIMS) == {name for name, *_ in OTHERS}
    for name, verdict, others in OTHERS:
        figure = CLAIMS[name]["figure"]
        for found, expected in ((BASE[figure], verdict), *others):
            told = judged({figure: found}, quick=False)[name]
            assert told["verdict"] is expected, told
            assert "{" not in told["number"] + told["why"]
    assert (len(CLAIMS), sum(len(claim["stated"]) for claim in CLAIMS.values())) == (25, 27)
    quick = claims_text(judged({"fig7b": BASE["fig7b"]}, quick=True), quick=True)
    assert "13 of 25 claims judged (27 statements): 7 reproduced; 1 reproduced in direction" in quick
    assert "With coarse settings; a full run may decide otherwise." in quick
    assert verdict_of(()) is OPEN


def ways(element, tolerance):
    """The ways of the contact to the beam's nodes at a fixed tolerance."""
    return list(approaches(to_structure(study.lifted(4.2), element=element), tolerance))


@pytest.mark.slow
def test_the_critical_area_grows_with_the_sharpness_of_the_tolerance():
    """``b^-3`` and ``b^-1``: a tolerance 1e4 times sharper widens it by about 20 and 1e4; `mixed` has none."""
    for element, factor in ((SIMPLE, 1e4 ** (1 / 3)), (TIMOSHENKO, 1e4)):
        loose, sharp = (ways(element, tolerance)[0].smallest for tolerance in (1e-7, 1e-11))
        assert factor / 6 < sharp / loose < 6 * factor
    for tolerance in (1e-6, 1e-12):
        assert all(way.smallest <= NEAREST for way in ways(MIXED, tolerance))


def test_the_way_ends_where_the_pin_slips_off():
    """Section 4.1: the exact rod slips off a pin at 4.2 m at 1.4716026278 m."""
    found = ways(MIXED, 1e-9)
    assert [way.node for way in found] == [4.25, 4.5]
    assert all(way.smallest <= NEAREST for way in found)
    last = found[-1]
    assert 1.8 * last.load_parameter[-1] == pytest.approx(1.4716026278, rel=2e-5)
    assert np.all(np.diff(last.load_parameter) > 0)
    assert np.all(np.diff(last.ratio) < 0)
