"""What the figures of [P] tell of its claims: by claim, whether it holds, and the numbers that its sentences name."""

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.cantilever_shapes import ELEMENTS
from comparisons.claims.paper.critical_area import PRINTED, PRINTED_SHEAR_PSI, PSI
from comparisons.claims.paper.figure_study import Study, column
from comparisons.claims.paper.formulations import CANTILEVER, LABELS, SIMPLE, TIMOSHENKO
from comparisons.claims.paper.turned_frame import NAME as TURNED
from comparisons.claims.problems.double_beam import EVENTS, LOWER, TIP, UPPER
from comparisons.compare import PAPER, SOLID
from comparisons.output import Row

MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
CURED = -1.5
"""Slope of a floor over l_i/l, in logarithms. A less steep floor cannot come from a stiffness with the third power of l/l_i."""
CLEARLY = 2.0 / 3.0
"""Part of the cases that is more than chance: single critical areas scatter by a factor of two."""
KS = "ks-cantilever"
ALIKE = 0.01
"""Shapes nearer than this, in lengths of the beam, are not significantly different: half the beam's height."""
WHY_NOT = {
    KS: "The contact node meets a beam node.",
    "ks-printed-shear": "With the printed G the beam is rigid in shear, and a pin that starts on the tip node is in the critical area.",
    "ks-tied-tip": "A tied tip makes the beam buckle, and a step may lead to another solution.",
}
"""What stands in the way of the paper's element in a reading."""
SLIP_OFF = 5e-4
"""Relative error of a slip-off displacement that counts as followed."""
LOCATED = 1e-3
"""Distance of a located event from the exact one, in metres."""


class Facts(NamedTuple):
    """By claim, whether it holds in every reading of what the paper does not say; the numbers by the names of the sentences; what holds in direction only.

    A reading is None where this program ends before it does.
    """

    readings: Mapping[str, Sequence[bool | None]]
    numbers: Mapping[str, Any]
    in_direction: Collection[str] = ()


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"


def of_lifts(found: Study) -> Facts:
    """Displacements at slip-off against the exact rod."""
    lifts = found.numbers["starting_positions"]
    coarse, fine = (max(lift["slip_off_error"][elements] for lift in lifts) for elements in ELEMENTS)
    reached = [(lift["reached_in_contact"][TIMOSHENKO], lift["slip_off_rod"]) for lift in lifts]
    paper = sum(bool(np.isclose(own, exact, rtol=SLIP_OFF)) for own, exact in reached)
    stops = " Its own element stops before the tip, in the last node's critical area."
    numbers = {
        "slip_off": (coarse, fine),
        "elements": ELEMENTS,
        "force": max(lift["force_error"] for lift in lifts),
        "paper": f"{paper} of {len(lifts)}",
        "stops": "" if paper == len(lifts) else stops,
    }
    return Facts({"followed": [coarse < SLIP_OFF]}, numbers)


def of_critical_areas(found: Study) -> Facts:
    """Critical areas by formulation and tolerance, and slopes of the floors before both ends."""
    given, slopes = found.numbers, found.numbers["slopes_of_the_floor"]
    tolerances = list(given["critical_area"][SIMPLE])
    smallest, median, largest = (
        {name: np.array([one[part] for one in by.values()]) for name, by in given["critical_area"].items()}
        for part in ("smallest", "median", "largest")
    )
    usable = median[SIMPLE] < MOVES
    ways = _ways(found, {tolerance for tolerance, moves in zip(tolerances, usable, strict=True) if moves})
    smaller, factors = {}, {}
    for above, below in pairwise(PRINTED):
        pairs = [area > ways[below][way] for way, area in ways[above].items() if way in ways[below]]
        smaller[above] = sum(pairs), len(pairs)
        gain = median[above][usable] / np.maximum(median[below][usable], NEAREST)
        printed = float(np.sqrt(np.prod(PRINTED[above]) / np.prod(PRINTED[below])))
        factors[above] = float(gain.min()), float(gain.max()), printed
    (count, of), (fewer, all_ways) = smaller[SIMPLE], smaller[CANTILEVER]
    clearly, always = count > CLEARLY * of, fewer == all_ways
    passed = {name: _passed(found, name) for name in LABELS}
    parts = {name: count / of for name, (count, of) in passed.items()}
    low, high = PRINTED[TIMOSHENKO]
    under = [at for at, area in zip(tolerances, largest[TIMOSHENKO], strict=True) if area <= low]
    readings: dict[str, Sequence[bool | None]] = {
        "exists": [smallest[SIMPLE].min() > NEAREST],
        "cantilever-effective": [slope > CURED for slope in (*slopes[CANTILEVER], *slopes[TURNED])],
        "shear-effective": [
            all(abs(slope + 1.0) < 0.2 for slope in slopes[TIMOSHENKO]) and factors[CANTILEVER][0] > 10.0
        ],
        "singular": [all(abs(slope + 3.0) < 0.3 for slope in (*slopes[SIMPLE], *slopes[CANTILEVER]))],
        "order": [clearly and always],
        "cantilever-reduces": [clearly],
        "shear-reduces": [always],
        "passes": [parts[TIMOSHENKO] > max(parts[SIMPLE], parts[CANTILEVER])],
        "discontinuity-solved": [parts[TIMOSHENKO] == 1.0],
        "every-edge": list(largest[TIMOSHENKO] <= low),
    }
    takes = given["tolerance_for_the_printed"]
    for name, (least, most) in PRINTED.items():
        between = [True] if np.isfinite(takes[name]) else []
        readings[f"range-{name}"] = [*((smallest[name] <= most) & (largest[name] >= least)), *between]
    in_size = {
        "cantilever-reduces": factors[SIMPLE][1] >= factors[SIMPLE][2],
        "shear-reduces": factors[CANTILEVER][0] >= factors[CANTILEVER][2],
    }
    shown = tolerances[0], tolerances[-1], f"{given['tolerance_of_the_curves']:.0e}"
    numbers = {
        "tolerance": shown,
        "range": {name: [_range(by[at]) for at in shown] for name, by in given["critical_area"].items()},
        "slope": {
            name: " and ".join(f"{round(one, 3) + 0.0:.3f}" for one in both) for name, both in slopes.items()
        },
        "stiff": _stiff(found.tables["fig7b-floor"]),
        "takes": {
            name: "beyond those measured" if np.isnan(one) else f"{one:.0e} EI/L^2"
            for name, one in takes.items()
        },
        "smaller": {name: f"{count} of {of}" for name, (count, of) in smaller.items()},
        "factor": factors,
        "passed": {name: f"{count} of {of}" for name, (count, of) in passed.items()},
        "largest": {name: percent(one.max()) for name, one in largest.items()},
        "printed": (percent(low), percent(high)),
        "nearest": percent(NEAREST),
        "under": f"at {under[-1]} EI/L^2 and looser" if under else "at no tolerance measured",
    }
    return Facts(readings, numbers, [name for name, size in in_size.items() if not size])


def _stiff(floors: list[Row]) -> float:
    """Floor of Timoshenko's element with the printed G, over that of Euler-Bernoulli, at the ratio nearest to 1e-3."""
    ratio = min((row["ratio"] for row in floors), key=lambda ratio: abs(ratio - 1e-3))
    near = [row for row in floors if (row["end"], row["ratio"]) == ("end", ratio)]
    floor = {(row["element"], row["psi"]): row["floor"] for row in near}
    return float(floor[TIMOSHENKO, PRINTED_SHEAR_PSI] / floor[SIMPLE, PSI])


def _ways(found: Study, usable: Collection[str]) -> dict[str, dict[tuple[float, ...], float]]:
    """By formulation, critical areas by tolerance, start and node, at the tolerances at which the Euler-Bernoulli contact still moves."""
    ways: dict[str, dict[tuple[float, ...], float]] = {name: {} for name in LABELS}
    for row in found.tables["fig7b-tolerance"]:
        if f"{row['tolerance']:.0e}" in usable and np.isfinite(row["smallest"]):
            ways[row["element"]][row["tolerance"], row["start"], row["node"]] = row["smallest"]
    return ways


def _passed(found: Study, element: str) -> tuple[int, int]:
    """Beam nodes passed, and all that stood in the way: an approach with a successor, which has equilibria."""
    own = [row for row in found.tables["fig7b-tolerance"] if row["element"] == element]
    behind = [
        bool(np.isfinite(after["smallest"]))
        for before, after in pairwise(own)
        if (before["start"], before["tolerance"]) == (after["start"], after["tolerance"])
    ]
    return sum(behind), len(behind)


def _range(area: Mapping[str, float]) -> str:
    nowhere = " (nowhere in the element)" if area["largest"] == 1.0 else ""
    return f"{percent(area['smallest'])} to {percent(area['largest'])}{nowhere}"


def of_shapes(found: Study) -> Facts:
    """Errors of the paper's element with 10, 20 and 50 elements, and of the solid, in the main reading."""
    main = {run["label"]: run for run in found.numbers["runs"] if run["reading"] == KS}
    runs: dict[Any, Row] = {one.options.elements: main[one.label] for one in PAPER}
    solid = main[SOLID.label]
    names = ("shape", "force", "arc", "moment")
    errors = {
        count: {name: float(run[f"error_path_{name}"]) for name in names} for count, run in runs.items()
    }
    errors[SOLID.label] = {name: float(solid[f"error_path_{name}"]) for name in ("shape", "force")}
    apart = {count: run["shape_difference"] for count, run in runs.items()}
    all_runs = [run for run in found.numbers["runs"] if run["label"] in {one.label for one in PAPER}]
    failed = [run for run in all_runs if not run["follows_the_rod"]]
    ends = (
        f"{run['label']} on {run['reading']} ({'another branch' if run['status'] == 'COMPLETED' else run['status']})"
        for run in failed
    )
    asked = ("shape", "force", "moment")
    worst = max(errors[20][name] for name in ("force", "arc", "shape"))
    readings: dict[str, Sequence[bool | None]] = {
        "anything": [False if failed else None],
        "alike": [all(value < ALIKE for value in apart.values())],
        "few-elements": [apart[10] < ALIKE and apart[20] < ALIKE],
        "simple-enough": [errors[count][name] < ALIKE for count in runs for name in asked],
        "less-division": [worst < ALIKE],
        "cheaper": [all(runs[20][name] < solid[name] for name in ("unknowns", "seconds"))],
    }
    words = {of: {name: percent(value) for name, value in one.items()} for of, one in errors.items()}
    numbers = {
        "follow": f"{len(all_runs) - len(failed)} of {len(all_runs)}",
        "not": f"; not: {', '.join(ends)}" if failed else "",
        "reasons": "".join(f" {one}" for one in dict.fromkeys(WHY_NOT[run["reading"]] for run in failed)),
        "apart": {count: percent(value) for count, value in apart.items()},
        "error": words,
        "each": "; ".join(f"{n} elements {', '.join(words[n][name] for name in asked)}" for n in runs),
        "worst": (percent(worst), percent(max(errors[SOLID.label].values()))),
        "run": {**runs, SOLID.label: solid},
    }
    return Facts(readings, numbers)


EXPECTED = {"touch": ("touch", TIP), "hand-over": ("slip-off", UPPER), "slip-off": ("slip-off", LOWER)}
"""Kind and pair of the events whose depths the exact rods have."""


def of_double_beam(found: Study) -> Facts:
    """Events against those of the exact rods, and how far the paper's element comes."""
    events, rows = found.numbers["events"], found.tables["fig9"]
    attempts = [attempt for attempt in found.numbers["attempts"] if attempt["element"] == TIMOSHENKO]
    first = {(one["kind"], one["pair"]): one for one in reversed(events)}
    depths = {name: first[one]["depth"] if one in first else np.nan for name, one in EXPECTED.items()}
    located = {name: bool(abs(depth - EVENTS[name]) < LOCATED) for name, depth in depths.items()}
    coupled = [row for row in rows if EVENTS["touch"] < row["depth"] < EVENTS["hand-over"]]
    closed = all(np.isfinite(column(coupled, f"{pair} arc")).all() for pair in (UPPER, TIP))
    # a run that ends at the hand-over ends where this program does, and the paper's went on
    through = [None if one["at_hand_over"] else one["status"] == "COMPLETED" for one in attempts]
    crowded = {
        one["element"] + 1
        for one in events
        if one["pair"] in {TIP, LOWER} and one["depth"] == depths["hand-over"]
    }
    deepest = max(attempt["depth"] for attempt in attempts)
    readings: dict[str, Sequence[bool | None]] = {
        "begins": [located["touch"] and closed],
        "hands-over": [located["hand-over"] and ("touch", LOWER) in first],
        "leaves": [located["slip-off"]],
        "passes-every-edge": through,
        "simultaneous": [deepest > EVENTS["touch"] + LOCATED],
    }
    reasons = {
        False: " A pin that starts on a beam node is in the critical area from the start.",
        None: " Beside the node both contacts pass every node until the hand-over. There pin and upper tip are on one element of the "
        f"lower beam (number {', '.join(map(str, sorted(crowded)))}), the paper's element has one contact point, and how its program "
        "went on is not said.",
    }
    numbers = {
        "event": {
            name: f"{kind} of {pair} at depth {depths[name]:.6f} m, exact rods {EVENTS[name]:.6f} m"
            if (kind, pair) in first
            else f"no {kind} of {pair}"
            for name, (kind, pair) in EXPECTED.items()
        },
        "expected": EVENTS,
        "released": sum(
            one["released"] for one in events if (one["kind"], one["pair"]) == EXPECTED["hand-over"]
        ),
        "last": np.nanmax(column(rows, f"{TIP} exact_force")),
        "attempts": ", ".join(
            f"pin at {one['place']:g} m: {one['status']} at depth {one['depth']:.2f} m, {one['passes']} nodes passed"
            for one in attempts
        ),
        "passed": sum(one["kind"] == "pass-through" for one in events),
        "reasons": "".join(words for end, words in reasons.items() if end in through),
        "deepest": deepest,
        "apart": max(one["force"] for one in found.numbers["checks"] if one["stage"] == "coupled"),
    }
    return Facts(readings, numbers)


FACTS: dict[str, Callable[[Study], Facts]] = {
    "fig7a": of_lifts,
    "fig7b": of_critical_areas,
    "fig8": of_shapes,
    "fig9": of_double_beam,
}
"""By figure."""
