"""The claims of [P] on the critical area: abstract, section 4.1, conclusion 1."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.critical_area import PRINTED, PRINTED_SHEAR_PSI, RATIOS, CriticalAreas
from comparisons.claims.paper.critical_area_plot import nearest_tolerance
from comparisons.claims.paper.turned_frame import NAME as TURNED
from comparisons.claims.paper.verdict import Judgement, claim, holds, in_size, over_readings, percent
from tsm import elements

SIMPLE, CANTILEVER, TIMOSHENKO, MIXED = (
    elements.EULER_BERNOULLI_SIMPLE.name,
    elements.EULER_BERNOULLI_CANTILEVER.name,
    elements.TIMOSHENKO.name,
    elements.MIXED.name,
)
MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
CURED = -1.5
"""Slope of a floor over l_i/l, in logarithms. A less steep floor cannot come from a stiffness with the third power of l/l_i."""
CLEARLY = 2.0 / 3.0
"""Part of the cases that is more than chance: single critical areas scatter by a factor of two."""


def _range(found: CriticalAreas, element: str, tolerance: float) -> str:
    areas = found.areas(element, tolerance)
    nowhere = " (nowhere in the element)" if areas.max() == 1.0 else ""
    return f"{percent(areas.min())} to {percent(areas.max())}{nowhere}"


def _usable(found: CriticalAreas) -> list[float]:
    """Tolerances at which the Euler-Bernoulli contact still moves."""
    return [tolerance for tolerance in found.tolerances if found.median(SIMPLE, tolerance) < MOVES]


def _slopes(found: CriticalAreas, element: str) -> str:
    return " and ".join(f"{round(slope, 3) + 0.0:.3f}" for slope in found.slopes(element))


def _factors(found: CriticalAreas, larger: str, smaller: str) -> list[float]:
    return [
        found.median(larger, tolerance) / max(found.median(smaller, tolerance), NEAREST)
        for tolerance in _usable(found)
    ]


def exists(found: CriticalAreas) -> Judgement:
    """Judge whether there is an area beside the node without equilibrium."""
    least = min(float(found.areas(SIMPLE, tolerance).min()) for tolerance in found.tolerances)
    first, last = found.tolerances[0], found.tolerances[-1]
    return holds(
        least > NEAREST,
        f"Euler-Bernoulli, simple: {_range(found, SIMPLE, first)} of the element at tolerance {first:.0e} EI/L^2, "
        f"{_range(found, SIMPLE, last)} at {last:.0e}",
        "The force is a stiffness that grows without bound times a deflection that vanishes; the last bit of a coordinate is "
        "enough to unbalance it. It is round-off at a fixed tolerance, not a property of the beam.",
    )


def cantilever_effective(found: CriticalAreas) -> Judgement:
    """Judge whether the cantilever basic system removes what stops the iteration, in both frames and at both ends."""
    slopes = found.slopes(CANTILEVER) + found.slopes(TURNED)
    return over_readings(
        [slope > CURED for slope in slopes],
        f"slope of the floor before the clamped and before the free end: {_slopes(found, CANTILEVER)} with deformations from the chord, "
        f"{_slopes(found, TURNED)} in a frame that turns with the clamped section; simply supported {_slopes(found, SIMPLE)}",
        "Neither the frame of (7) nor the node that is clamped is printed, so both frames and both ends are measured. From the chord, (7) "
        "is (5) in exact arithmetic; in the turned frame it is another element, and K_cc times the last bit of a coordinate is left all "
        "the same. A step that is longer than the critical area carries the contact over the node with either.",
    )


def shear_effective(found: CriticalAreas) -> Judgement:
    """Judge whether shear deformation cures the divergence."""
    small = int(np.argmin(np.abs(RATIOS - 1e-3)))
    floor = {(one.element, one.psi): one.floor[small] for one in found.floors if one.end == "end"}
    stiff = floor[TIMOSHENKO, PRINTED_SHEAR_PSI] / floor[SIMPLE, max(psi for _, psi in floor)]
    return holds(
        all(abs(slope + 1.0) < 0.2 for slope in found.slopes(TIMOSHENKO))
        and min(_factors(found, CANTILEVER, TIMOSHENKO)) > 10.0,
        f"slope {_slopes(found, TIMOSHENKO)} in place of {_slopes(found, CANTILEVER)}; with the G printed in section 4.2 the "
        f"floor at l_i/l = 1e-3 is {stiff:.2g} times that of Euler-Bernoulli",
        "The stiffness at the contact is G A_e/b in place of 3 EI/b^3 as long as b is small against sqrt(EI/G A_e). That is "
        "so in section 4.1, whose section has no slender rectangle; for a slender beam nothing is gained.",
    )


def singular(found: CriticalAreas) -> Judgement:
    """Judge whether the unbalanced force diverges as the matrices of (5) and (7) do."""
    slopes = found.slopes(SIMPLE) + found.slopes(CANTILEVER)
    return holds(
        all(abs(slope + 3.0) < 0.3 for slope in slopes),
        f"slope of log(floor) over log(l_i/l): {_slopes(found, SIMPLE)} and {_slopes(found, CANTILEVER)}",
        "The floor of the unbalanced force follows K_cc = 3 EI l^3/(a b)^3.",
    )


def _tolerance(value: float) -> str:
    outside = "beyond those measured"
    return outside if np.isnan(value) else f"{value:.0e} EI/L^2"


def _printed_range(element: str) -> Callable[[CriticalAreas], Judgement]:
    def judge(found: CriticalAreas) -> Judgement:
        low, high = PRINTED[element]
        tolerance = nearest_tolerance(found)
        wanted = found.tolerance_for(element, float(np.sqrt(low * high)))
        areas = [found.areas(element, one) for one in found.tolerances]
        between = [True] if np.isfinite(wanted) else []
        return over_readings(
            [*(bool(one.min() <= high and one.max() >= low) for one in areas), *between],
            f"{_range(found, element, tolerance)} at {tolerance:.0e} EI/L^2; the printed range takes a tolerance of {_tolerance(wanted)}",
            "The paper gives neither tolerance nor step, and the range follows the tolerance over several powers of ten.",
        )

    return judge


def _pairs(found: CriticalAreas, larger: str, smaller: str) -> list[bool]:
    """Whether the critical area is the larger one, for every way to a node on which both formulations found equilibrium."""
    tolerances = _usable(found)
    areas = {
        element: {
            (one.tolerance, one.start, one.node): one.smallest
            for one in found.measured
            if one.element == element and one.tolerance in tolerances and np.isfinite(one.smallest)
        }
        for element in (larger, smaller)
    }
    return [area > areas[smaller][way] for way, area in areas[larger].items() if way in areas[smaller]]


def _smaller(found: CriticalAreas) -> tuple[int, int]:
    """Places where the cantilever's critical area is smaller than the simple one's, and all that can be compared."""
    pairs = _pairs(found, SIMPLE, CANTILEVER)
    return sum(pairs), len(pairs)


def order(found: CriticalAreas) -> Judgement:
    """Judge whether the three ranges follow one another as printed."""
    (upper, of), lower = _smaller(found), _pairs(found, CANTILEVER, TIMOSHENKO)
    needed = [
        found.tolerance_for(element, float(np.sqrt(low * high))) for element, (low, high) in PRINTED.items()
    ]
    return holds(
        upper > CLEARLY * of and all(lower),
        f"before the same node, at the same tolerance: simple above cantilever in {upper} of {of}, cantilever above "
        f"Timoshenko in {sum(lower)} of {len(lower)}; the three printed ranges take tolerances of {', '.join(_tolerance(value) for value in needed)}",
        "The order is that of the round-off. The printed figures do not belong to one tolerance of this solver, so step or "
        "scaling differed between the paper's programs.",
    )


def cantilever_reduces(found: CriticalAreas) -> Judgement:
    """Judge whether the cantilever's critical area is the smaller one, and by as much as the paper prints."""
    factors, (smaller, of) = _factors(found, SIMPLE, CANTILEVER), _smaller(found)
    printed = _printed_factor(SIMPLE, CANTILEVER)
    return in_size(
        direction=smaller > CLEARLY * of,
        size=max(factors) >= printed,
        number=f"smaller in {smaller} of {of}; medians by a factor of {min(factors):.1f} to {max(factors):.1f}, depending on the tolerance; "
        f"the paper's by {printed:.1f}",
        why="Both are one element in exact arithmetic; how often an iteration hits the tolerance by luck differs with the order "
        "of operations, and the gain is gone at sharp tolerances.",
    )


def shear_reduces(found: CriticalAreas) -> Judgement:
    """Judge whether Timoshenko's critical area is much smaller."""
    factors, smaller = _factors(found, CANTILEVER, TIMOSHENKO), _pairs(found, CANTILEVER, TIMOSHENKO)
    printed = _printed_factor(CANTILEVER, TIMOSHENKO)
    return in_size(
        direction=all(smaller),
        size=min(factors) >= printed,
        number=f"medians smaller than the cantilever's by a factor of {min(factors):.0e} to {max(factors):.0e}; the paper's by {printed:.0f}",
        why="First power of 1/b in place of the third, with EI/(G A_e l^2) = 9.",
    )


def _printed_factor(larger: str, smaller: str) -> float:
    """Ratio of two printed ranges, by the geometric means of their ends."""
    return float(np.sqrt(np.prod(PRINTED[larger]) / np.prod(PRINTED[smaller])))


def _passes(found: CriticalAreas, element: str) -> tuple[int, int]:
    """Beam nodes passed, and all that stood in the way: an approach with a successor, which has equilibria."""
    own = [one for one in found.measured if one.element == element]
    behind = [
        after for before, after in pairwise(own)
        if (before.start, before.tolerance) == (after.start, after.tolerance)
    ]  # fmt: skip
    return sum(len(after.ratio) > 0 for after in behind), len(behind)


def passes(found: CriticalAreas) -> Judgement:
    """Judge whether nodes are passed more easily than with the elements before."""
    counts = {element: _passes(found, element) for element in (SIMPLE, CANTILEVER, TIMOSHENKO, MIXED)}
    shown = ", ".join(f"{element} {passed} of {of}" for element, (passed, of) in counts.items())
    parts = {element: passed / of for element, (passed, of) in counts.items()}
    return holds(
        parts[TIMOSHENKO] > max(parts[SIMPLE], parts[CANTILEVER]),
        f"nodes passed over all starting positions and tolerances: {shown}",
        "The contact is carried over the node by a step longer than the critical area, and a smaller area takes a smaller step.",
    )


def discontinuity_solved(found: CriticalAreas) -> Judgement:
    """Judge whether every boundary is passed; what the paper itself leaves beside it is a remark."""
    passed, of = _passes(found, TIMOSHENKO)
    largest = {
        element: max(float(found.areas(element, tolerance).max()) for tolerance in found.tolerances)
        for element in (TIMOSHENKO, MIXED)
    }
    low, high = PRINTED[TIMOSHENKO]
    return holds(
        passed == of,
        f"{passed} of {of} nodes passed; largest critical area over all tolerances {percent(largest[TIMOSHENKO])}, the paper leaves "
        f"{percent(low)} to {percent(high)}; mixed {percent(largest[MIXED])} (the search ends at {percent(NEAREST)})",
        "Remark: inside the critical area there is no equilibrium at the tolerance, and the contact force is normal to the chord, so its direction "
        "jumps at the node. An element with the force as an unknown has neither.",
    )


def every_edge(found: CriticalAreas) -> Judgement:
    """Judge whether 0.067 % is what every edge has."""
    low, high = PRINTED[TIMOSHENKO]
    largest = [found.areas(TIMOSHENKO, tolerance).max() for tolerance in found.tolerances]
    below = [tolerance for tolerance, area in zip(found.tolerances, largest, strict=True) if area <= low]
    at = f"at {below[-1]:.0e} EI/L^2 and looser" if below else "at no tolerance measured"
    sharpest = found.tolerances[-1]
    return over_readings(
        [bool(area <= low) for area in largest],
        f"all edges lie below {percent(low)} {at}; at {sharpest:.0e} they are {_range(found, TIMOSHENKO, sharpest)}",
        f"The tolerance is not given, and {percent(low)} is the smallest value of section 4.1, whose range goes to {percent(high)}.",
    )


CLAIMS = (
    claim(
        "fig7b",
        exists,
        (
            "abstract",
            "Close to the element edge no stable, accurate convergence is obtained: the critical area.",
        ),
    ),
    claim(
        "fig7b",
        cantilever_effective,
        (
            "abstract",
            "The earlier modification (cantilever basic system) makes the unbalanced force converge at the element edge.",
        ),
    ),
    claim(
        "fig7b",
        shear_effective,
        (
            "abstract",
            "Shear deformation in the simply supported basic system avoids the divergence in the critical area.",
        ),
        ("conclusion 1", "The convergence shows the effectiveness of applying shear deformation."),
    ),
    claim(
        "fig7b",
        singular,
        (
            "4.1",
            "The matrices (5) and (7) become singular as l_i or l_j vanishes, so the unbalanced force hardly converges.",
        ),
    ),
    *(
        claim(
            "fig7b",
            _printed_range(element),
            (
                "4.1, Fig. 7(b)",
                f"Critical area {name}: {100 * PRINTED[element][0]:.3f} % to {100 * PRINTED[element][1]:.3f} %.",
            ),
        )
        for element, name in (
            (SIMPLE, "of Euler-Bernoulli, simply supported"),
            (CANTILEVER, "of Euler-Bernoulli, cantilever"),
            (TIMOSHENKO, "of Timoshenko"),
        )
    ),
    claim(
        "fig7b",
        order,
        ("4.1, Fig. 7(b)", "The three ranges are ordered: simply supported, cantilever, Timoshenko."),
    ),
    claim(
        "fig7b",
        cantilever_reduces,
        ("4.1", "The cantilever coordinate system reduces the range of the critical area."),
    ),
    claim(
        "fig7b",
        shear_reduces,
        ("4.1", "With the Timoshenko beam the critical area is significantly reduced."),
    ),
    claim(
        "fig7b",
        passes,
        ("4.1", "The reduction makes it easier for the contact node to pass through the element edge."),
    ),
    claim(
        "fig7b",
        discontinuity_solved,
        ("conclusion 1", "Smooth pass-through solves the problem of discontinuous element boundaries."),
    ),
    claim(
        "fig7b",
        every_edge,
        ("conclusion 1", "The critical area at every element edge is reduced to 0.067 %."),
    ),
)
"""In the order of the paper, with `claims_examples`."""
