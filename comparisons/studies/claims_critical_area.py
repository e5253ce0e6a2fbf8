"""The claims of [P] on the critical area: abstract, section 4.1, conclusion 1."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from comparisons.studies.approach import NEAREST
from comparisons.studies.critical_area import PRINTED, PRINTED_SHEAR_PSI, RATIOS, CriticalAreas
from comparisons.studies.critical_area_plot import nearest_tolerance
from comparisons.studies.verdict import Claim, Judgement, Verdict, holds, percent

SIMPLE, CANTILEVER, TIMOSHENKO, MIXED = (
    "euler-bernoulli-simple",
    "euler-bernoulli-cantilever",
    "timoshenko",
    "mixed",
)
MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
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
    """Judge whether the cantilever basic system removes what stops the iteration."""
    return holds(
        min(found.slopes(CANTILEVER)) > -1.5,
        f"slope of the floor {_slopes(found, CANTILEVER)}, as with the simple one ({_slopes(found, SIMPLE)})",
        "In exact arithmetic the two basic systems are the same element; the floor of the unbalanced force grows with the "
        "same third power. A step that is longer than the critical area carries the contact over the node with either.",
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
        at = f"a tolerance of {_tolerance(wanted)}"
        return Judgement(
            verdict=Verdict.CANNOT_BE_TOLD,
            number=f"{_range(found, element, tolerance)} at {tolerance:.0e} EI/L^2; the printed range takes {at}",
            why="The paper gives neither tolerance nor step, and the range follows the tolerance over several powers of ten.",
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


def order(found: CriticalAreas) -> Judgement:
    """Judge whether the three ranges follow one another as printed."""
    upper, lower = _pairs(found, SIMPLE, CANTILEVER), _pairs(found, CANTILEVER, TIMOSHENKO)
    needed = [
        found.tolerance_for(element, float(np.sqrt(low * high))) for element, (low, high) in PRINTED.items()
    ]
    return holds(
        sum(upper) > CLEARLY * len(upper) and all(lower),
        f"before the same node, at the same tolerance: simple above cantilever in {sum(upper)} of {len(upper)}, cantilever above "
        f"Timoshenko in {sum(lower)} of {len(lower)}; the three printed ranges take tolerances of {', '.join(_tolerance(value) for value in needed)}",
        "The order is that of the round-off. The printed figures do not belong to one tolerance of this solver, so step or "
        "scaling differed between the paper's programs.",
    )


def cantilever_reduces(found: CriticalAreas) -> Judgement:
    """Judge whether the cantilever's critical area is markedly smaller than the simple one's."""
    factors = _factors(found, SIMPLE, CANTILEVER)
    printed = np.sqrt(np.prod(PRINTED[SIMPLE]) / np.prod(PRINTED[CANTILEVER]))
    return holds(
        min(factors) > 1.5,
        f"medians smaller by a factor of {min(factors):.1f} to {max(factors):.1f}, depending on the tolerance; the paper's by {printed:.1f}",
        "Both are one element in exact arithmetic; how often an iteration hits the tolerance by luck differs with the order "
        "of operations, and the gain is gone at sharp tolerances.",
    )


def shear_reduces(found: CriticalAreas) -> Judgement:
    """Judge whether Timoshenko's critical area is much smaller."""
    factors = _factors(found, CANTILEVER, TIMOSHENKO)
    printed = np.sqrt(np.prod(PRINTED[CANTILEVER]) / np.prod(PRINTED[TIMOSHENKO]))
    return holds(
        min(factors) > 10.0,
        f"medians smaller than the cantilever's by a factor of {min(factors):.0e} to {max(factors):.0e}; the paper's by {printed:.0f}",
        "First power of 1/b in place of the third, with EI/(G A_e l^2) = 9.",
    )


def _passes(found: CriticalAreas, element: str) -> tuple[int, int]:
    """Beam nodes passed, and all that stood in the way: an approach with a successor, which has equilibria."""
    own = [one for one in found.measured if one.element == element]
    behind = [
        after for before, after in pairwise(own)
        if (before.start, before.tolerance) == (after.start, after.tolerance)
    ]  # fmt: skip
    return sum(len(after.ratio) > 0 for after in behind), len(behind)


def passes(found: CriticalAreas) -> Judgement:
    """Judge whether every node is passed."""
    counts = {element: _passes(found, element) for element in (SIMPLE, CANTILEVER, TIMOSHENKO, MIXED)}
    done, wanted = counts[TIMOSHENKO]
    least = max(found.median(TIMOSHENKO, tolerance) for tolerance in found.tolerances)
    shown = ", ".join(f"{element} {passed} of {all_}" for element, (passed, all_) in counts.items())
    return holds(
        done == wanted,
        f"nodes passed over all starting positions and tolerances: {shown}; Timoshenko's critical area stays at up to {percent(least)}",
        "The contact is carried over the node by a step longer than the critical area; inside it there is still no "
        "equilibrium at the tolerance. With the force as an unknown (`mixed`) there is, at any distance.",
    )


def discontinuity_solved(found: CriticalAreas) -> Judgement:
    """Judge whether there is equilibrium up to the node."""
    largest = {
        element: max(float(found.areas(element, tolerance).max()) for tolerance in found.tolerances)
        for element in (TIMOSHENKO, MIXED)
    }
    return holds(
        largest[TIMOSHENKO] <= NEAREST,
        f"largest critical area over all tolerances: Timoshenko {percent(largest[TIMOSHENKO])}, mixed {percent(largest[MIXED])} "
        f"(the search ends at {percent(NEAREST)}); slopes {_slopes(found, TIMOSHENKO)} and {_slopes(found, MIXED)}",
        "The area is smaller, not gone: the force still is a stiffness of order 1/b times a deflection. Besides, it is normal to the "
        "chord, so its direction jumps at the node. The element with the force as an unknown has neither.",
    )


def every_edge(found: CriticalAreas) -> Judgement:
    """Judge whether 0.067 % is what every edge has."""
    low, high = PRINTED[TIMOSHENKO]
    below = [tolerance for tolerance in found.tolerances if found.areas(TIMOSHENKO, tolerance).max() <= low]
    at = f"at {below[-1]:.0e} EI/L^2 and looser" if below else "at no tolerance measured"
    sharpest = found.tolerances[-1]
    return Judgement(
        verdict=Verdict.CANNOT_BE_TOLD,
        number=f"all edges lie below {percent(low)} {at}; at {sharpest:.0e} they are {_range(found, TIMOSHENKO, sharpest)}",
        why=f"The tolerance is not given, and {percent(low)} is the smallest value of section 4.1, whose range goes to {percent(high)}.",
    )


CLAIMS = (
    Claim(
        source="abstract",
        text="Close to the element edge no stable, accurate convergence is obtained: the critical area.",
        figure="fig7b",
        judge=exists,
    ),
    Claim(
        source="abstract",
        text="The earlier modification (cantilever basic system) makes the unbalanced force converge at the element edge.",
        figure="fig7b",
        judge=cantilever_effective,
    ),
    Claim(
        source="abstract",
        text="Shear deformation in the simply supported basic system avoids the divergence in the critical area.",
        figure="fig7b",
        judge=shear_effective,
    ),
    Claim(
        source="4.1",
        text="The matrices (5) and (7) become singular as l_i or l_j vanishes, so the unbalanced force hardly converges.",
        figure="fig7b",
        judge=singular,
    ),
    *(
        Claim(
            source="4.1, Fig. 7(b)",
            text=f"Critical area {name}: {100.0 * PRINTED[element][0]:.3f} % to {100.0 * PRINTED[element][1]:.3f} %.",
            figure="fig7b",
            judge=_printed_range(element),
        )
        for element, name in (
            (SIMPLE, "of Euler-Bernoulli, simply supported"),
            (CANTILEVER, "of Euler-Bernoulli, cantilever"),
            (TIMOSHENKO, "of Timoshenko"),
        )
    ),
    Claim(
        source="4.1, Fig. 7(b)",
        text="The three ranges are ordered: simply supported, cantilever, Timoshenko.",
        figure="fig7b",
        judge=order,
    ),
    Claim(
        source="4.1",
        text="The cantilever coordinate system reduces the range of the critical area.",
        figure="fig7b",
        judge=cantilever_reduces,
    ),
    Claim(
        source="4.1",
        text="With the Timoshenko beam the critical area is significantly reduced.",
        figure="fig7b",
        judge=shear_reduces,
    ),
    Claim(
        source="4.1",
        text="The reduction makes it easier for the contact node to pass through the element edge.",
        figure="fig7b",
        judge=passes,
    ),
    Claim(
        source="conclusion 1",
        text="The convergence shows the effectiveness of applying shear deformation.",
        figure="fig7b",
        judge=shear_effective,
    ),
    Claim(
        source="conclusion 1",
        text="Smooth pass-through solves the problem of discontinuous element boundaries.",
        figure="fig7b",
        judge=discontinuity_solved,
    ),
    Claim(
        source="conclusion 1",
        text="The critical area at every element edge is reduced to 0.067 %.",
        figure="fig7b",
        judge=every_edge,
    ),
)
"""In the order of the paper, with `claims_examples`."""
