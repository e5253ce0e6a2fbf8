"""The claims of [P] on the critical area: abstract, section 4.1, conclusion 1. A judge's docstring is what the paper says."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.critical_area import PRINTED, PRINTED_SHEAR_PSI
from comparisons.claims.paper.figure_study import Study
from comparisons.claims.paper.formulations import CANTILEVER, MIXED, SIMPLE, TIMOSHENKO
from comparisons.claims.paper.turned_frame import NAME as TURNED
from comparisons.claims.paper.verdict import Judge, Judgement, claim, holds, percent

MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
CURED = -1.5
"""Slope of a floor over l_i/l, in logarithms. A less steep floor cannot come from a stiffness with the third power of l/l_i."""
CLEARLY = 2.0 / 3.0
"""Part of the cases that is more than chance: single critical areas scatter by a factor of two."""


def _areas(found: Study, element: str, part: str) -> dict[str, float]:
    """Smallest, median or largest critical area by tolerance."""
    return {tolerance: one[part] for tolerance, one in found.numbers["critical_area"][element].items()}


def _range(found: Study, element: str, tolerance: str) -> str:
    low, high = (_areas(found, element, part)[tolerance] for part in ("smallest", "largest"))
    return f"{percent(low)} to {percent(high)}{' (nowhere in the element)' if high == 1.0 else ''}"


def _slopes(found: Study, *elements: str) -> list[float]:
    return [slope for element in elements for slope in found.numbers["slopes_of_the_floor"][element]]


def _both(found: Study, element: str) -> str:
    return " and ".join(f"{round(slope, 3) + 0.0:.3f}" for slope in _slopes(found, element))


def _usable(found: Study) -> list[str]:
    """Tolerances at which the Euler-Bernoulli contact still moves."""
    return [tolerance for tolerance, area in _areas(found, SIMPLE, "median").items() if area < MOVES]


def _factors(found: Study, larger: str, smaller: str) -> list[float]:
    above, below = (_areas(found, element, "median") for element in (larger, smaller))
    return [above[tolerance] / max(below[tolerance], NEAREST) for tolerance in _usable(found)]


def _pairs(found: Study, larger: str, smaller: str) -> list[bool]:
    """Whether the critical area is the larger one, for every way to a node on which both formulations found equilibrium."""
    areas: dict[str, dict[tuple[float, float, float], float]] = {larger: {}, smaller: {}}
    usable = _usable(found)
    for row in found.tables["fig7b-tolerance"]:
        known = f"{row['tolerance']:.0e}" in usable and np.isfinite(row["smallest"])
        if row["element"] in areas and known:
            areas[row["element"]][row["tolerance"], row["start"], row["node"]] = row["smallest"]
    return [bool(area > areas[smaller][way]) for way, area in areas[larger].items() if way in areas[smaller]]


def _passes(found: Study, element: str) -> tuple[int, int]:
    """Beam nodes passed, and all that stood in the way: an approach with a successor, which has equilibria."""
    own = [row for row in found.tables["fig7b-tolerance"] if row["element"] == element]
    behind = [
        np.isfinite(after["smallest"])
        for before, after in pairwise(own)
        if (before["start"], before["tolerance"]) == (after["start"], after["tolerance"])
    ]
    return int(sum(behind)), len(behind)


def _printed_factor(larger: str, smaller: str) -> float:
    """Ratio of two printed ranges, by the geometric means of their ends."""
    return float(np.sqrt(np.prod(PRINTED[larger]) / np.prod(PRINTED[smaller])))


def _tolerance(found: Study, element: str) -> str:
    """The tolerance that the printed range takes."""
    value = found.numbers["tolerance_for_the_printed"][element]
    return "beyond those measured" if np.isnan(value) else f"{value:.0e} EI/L^2"


@claim("fig7b", "abstract")
def exists(found: Study) -> Judgement:
    """Close to the element edge no stable, accurate convergence is obtained: the critical area."""
    areas = _areas(found, SIMPLE, "smallest")
    first, *_, last = areas
    return holds(
        min(areas.values()) > NEAREST,
        f"Euler-Bernoulli, simple: {_range(found, SIMPLE, first)} of the element at tolerance {first} EI/L^2, "
        f"{_range(found, SIMPLE, last)} at {last}",
        "The force is a stiffness that grows without bound times a deflection that vanishes; the last bit of a coordinate is "
        "enough to unbalance it. It is round-off at a fixed tolerance, not a property of the beam.",
    )


@claim("fig7b", "abstract")
def cantilever_effective(found: Study) -> Judgement:
    """The earlier modification (cantilever basic system) makes the unbalanced force converge at the element edge."""
    return holds(
        [slope > CURED for slope in _slopes(found, CANTILEVER, TURNED)],
        f"slope of the floor before the clamped and before the free end: {_both(found, CANTILEVER)} with deformations from the chord, "
        f"{_both(found, TURNED)} in a frame that turns with the clamped section; simply supported {_both(found, SIMPLE)}",
        "Neither the frame of (7) nor the node that is clamped is printed, so both frames and both ends are measured. From the chord, (7) "
        "is (5) in exact arithmetic; in the turned frame it is another element, and K_cc times the last bit of a coordinate is left all "
        "the same. A step that is longer than the critical area carries the contact over the node with either.",
    )


@claim("fig7b", "abstract", "conclusion 1")
def shear_effective(found: Study) -> Judgement:
    """Shear deformation in the simply supported basic system avoids the divergence in the critical area.

    The convergence shows the effectiveness of applying shear deformation.
    """
    floors = [row for row in found.tables["fig7b-floor"] if row["end"] == "end"]
    small = min((row["ratio"] for row in floors), key=lambda ratio: abs(ratio - 1e-3))
    floor = {(row["element"], row["psi"]): row["floor"] for row in floors if row["ratio"] == small}
    stiff = floor[TIMOSHENKO, PRINTED_SHEAR_PSI] / floor[SIMPLE, max(psi for _, psi in floor)]
    return holds(
        all(abs(slope + 1.0) < 0.2 for slope in _slopes(found, TIMOSHENKO))
        and min(_factors(found, CANTILEVER, TIMOSHENKO)) > 10.0,
        f"slope {_both(found, TIMOSHENKO)} in place of {_both(found, CANTILEVER)}; with the G printed in section 4.2 the "
        f"floor at l_i/l = 1e-3 is {stiff:.2g} times that of Euler-Bernoulli",
        "The stiffness at the contact is G A_e/b in place of 3 EI/b^3 as long as b is small against sqrt(EI/G A_e). That is "
        "so in section 4.1, whose section has no slender rectangle; for a slender beam nothing is gained.",
    )


@claim("fig7b", "4.1")
def singular(found: Study) -> Judgement:
    """The matrices (5) and (7) become singular as l_i or l_j vanishes, so the unbalanced force hardly converges."""
    return holds(
        all(abs(slope + 3.0) < 0.3 for slope in _slopes(found, SIMPLE, CANTILEVER)),
        f"slope of log(floor) over log(l_i/l): {_both(found, SIMPLE)} and {_both(found, CANTILEVER)}",
        "The floor of the unbalanced force follows K_cc = 3 EI l^3/(a b)^3.",
    )


def _printed_ranges() -> Iterator[tuple[str, Judge]]:
    names = ("of Euler-Bernoulli, simply supported", "of Euler-Bernoulli, cantilever", "of Timoshenko")
    for element, name in zip(PRINTED, names, strict=True):
        low, high = PRINTED[element]

        def judge(found: Study, element: str = element, low: float = low, high: float = high) -> Judgement:
            tolerance = f"{found.numbers['tolerance_of_the_curves']:.0e}"
            smallest, largest = (_areas(found, element, part) for part in ("smallest", "largest"))
            cases = [least <= high and largest[at] >= low for at, least in smallest.items()]
            between = np.isfinite(found.numbers["tolerance_for_the_printed"][element])
            return holds(
                [*cases, True] if between else cases,
                f"{_range(found, element, tolerance)} at {tolerance} EI/L^2; the printed range takes a tolerance of {_tolerance(found, element)}",
                "The paper gives neither tolerance nor step, and the range follows the tolerance over several powers of ten.",
            )

        judge.__doc__ = f"Critical area {name}: {100 * low:.3f} % to {100 * high:.3f} %."
        yield element, claim("fig7b", "4.1, Fig. 7(b)")(judge)


PRINTED_RANGES = dict(_printed_ranges())
"""The judges of the printed ranges by formulation."""


@claim("fig7b", "4.1, Fig. 7(b)")
def order(found: Study) -> Judgement:
    """The three ranges are ordered: simply supported, cantilever, Timoshenko."""
    upper, lower = _pairs(found, SIMPLE, CANTILEVER), _pairs(found, CANTILEVER, TIMOSHENKO)
    return holds(
        sum(upper) > CLEARLY * len(upper) and all(lower),
        f"before the same node, at the same tolerance: simple above cantilever in {sum(upper)} of {len(upper)}, cantilever above "
        f"Timoshenko in {sum(lower)} of {len(lower)}; the three printed ranges take tolerances of "
        + ", ".join(_tolerance(found, element) for element in PRINTED),
        "The order is that of the round-off. The printed figures do not belong to one tolerance of this solver, so step or "
        "scaling differed between the paper's programs.",
    )


@claim("fig7b", "4.1")
def cantilever_reduces(found: Study) -> Judgement:
    """The cantilever coordinate system reduces the range of the critical area."""
    factors, smaller = _factors(found, SIMPLE, CANTILEVER), _pairs(found, SIMPLE, CANTILEVER)
    printed = _printed_factor(SIMPLE, CANTILEVER)
    return holds(
        sum(smaller) > CLEARLY * len(smaller),
        f"smaller in {sum(smaller)} of {len(smaller)}; medians by a factor of {min(factors):.1f} to {max(factors):.1f}, "
        f"depending on the tolerance; the paper's by {printed:.1f}",
        "Both are one element in exact arithmetic; how often an iteration hits the tolerance by luck differs with the order "
        "of operations, and the gain is gone at sharp tolerances.",
        in_size=max(factors) >= printed,
    )


@claim("fig7b", "4.1")
def shear_reduces(found: Study) -> Judgement:
    """With the Timoshenko beam the critical area is significantly reduced."""
    factors, printed = _factors(found, CANTILEVER, TIMOSHENKO), _printed_factor(CANTILEVER, TIMOSHENKO)
    return holds(
        all(_pairs(found, CANTILEVER, TIMOSHENKO)),
        f"medians smaller than the cantilever's by a factor of {min(factors):.0e} to {max(factors):.0e}; the paper's by {printed:.0f}",
        "First power of 1/b in place of the third, with EI/(G A_e l^2) = 9.",
        in_size=min(factors) >= printed,
    )


@claim("fig7b", "4.1")
def passes(found: Study) -> Judgement:
    """The reduction makes it easier for the contact node to pass through the element edge."""
    counts = {element: _passes(found, element) for element in (SIMPLE, CANTILEVER, TIMOSHENKO, MIXED)}
    parts = {element: passed / of for element, (passed, of) in counts.items()}
    return holds(
        parts[TIMOSHENKO] > max(parts[SIMPLE], parts[CANTILEVER]),
        "nodes passed over all starting positions and tolerances: "
        + ", ".join(f"{element} {passed} of {of}" for element, (passed, of) in counts.items()),
        "The contact is carried over the node by a step longer than the critical area, and a smaller area takes a smaller step.",
    )


@claim("fig7b", "conclusion 1")
def discontinuity_solved(found: Study) -> Judgement:
    """Smooth pass-through solves the problem of discontinuous element boundaries."""
    passed, of = _passes(found, TIMOSHENKO)
    largest, mixed = (max(_areas(found, element, "largest").values()) for element in (TIMOSHENKO, MIXED))
    low, high = PRINTED[TIMOSHENKO]
    return holds(
        passed == of,
        f"{passed} of {of} nodes passed; largest critical area over all tolerances {percent(largest)}, the paper leaves "
        f"{percent(low)} to {percent(high)}; mixed {percent(mixed)} (the search ends at {percent(NEAREST)})",
        "Remark: inside the critical area there is no equilibrium at the tolerance, and the contact force is normal to the chord, so its direction "
        "jumps at the node. An element with the force as an unknown has neither.",
    )


@claim("fig7b", "conclusion 1")
def every_edge(found: Study) -> Judgement:
    """The critical area at every element edge is reduced to 0.067 %."""
    low, high = PRINTED[TIMOSHENKO]
    largest = _areas(found, TIMOSHENKO, "largest")
    below = [tolerance for tolerance, area in largest.items() if area <= low]
    at = f"at {below[-1]} EI/L^2 and looser" if below else "at no tolerance measured"
    sharpest = list(largest)[-1]
    return holds(
        [area <= low for area in largest.values()],
        f"all edges lie below {percent(low)} {at}; at {sharpest} they are {_range(found, TIMOSHENKO, sharpest)}",
        f"The tolerance is not given, and {percent(low)} is the smallest value of section 4.1, whose range goes to {percent(high)}.",
    )
