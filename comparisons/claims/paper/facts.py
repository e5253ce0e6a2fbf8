"""What the figures of [P] tell of its claims: by figure, the numbers that bounds and sentences of ``claims.toml`` name."""

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.fig7 import ELEMENTS, PRINTED, PRINTED_SHEAR_PSI, PSI
from comparisons.claims.paper.fig9 import EVENTS, LOWER, TIP, UPPER
from comparisons.claims.paper.figure import CANTILEVER, LABELS, SIMPLE, TIMOSHENKO, Study, column
from comparisons.compare import PAPER, SOLID
from comparisons.output import Row

MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
KS = "ks-cantilever"
WHY_NOT = {
    KS: "The contact node meets a beam node.",
    "ks-printed-shear": "With the printed G the beam is rigid in shear, and a pin that starts on the tip node is in the critical area.",
    "ks-tied-tip": "A tied tip makes the beam buckle, and a step may lead to another solution.",
}
"""What stands in the way of the paper's element in a reading."""
FOLLOWED = 5e-4
"""Relative error of a slip-off displacement that counts as followed."""
EXPECTED = {"touch": ("touch", TIP), "hand-over": ("slip-off", UPPER), "slip-off": ("slip-off", LOWER)}
"""Kind and pair of the events whose depths the exact rods have."""
Facts = Mapping[str, Any]
"""Numbers by name, many of them by formulation, division or event."""


def of_lifts(found: Study) -> Facts:
    """Displacements at slip-off against the exact rod."""
    lifts = found.numbers["starting_positions"]
    reached = [(lift["reached_in_contact"][TIMOSHENKO], lift["slip_off_rod"]) for lift in lifts]
    paper = sum(bool(np.isclose(own, exact, rtol=FOLLOWED)) for own, exact in reached)
    stops = " Its own element stops before the tip, in the last node's critical area."
    return {
        "slip_off": [max(lift["slip_off_error"][elements] for lift in lifts) for elements in ELEMENTS],
        "elements": ELEMENTS,
        "force": max(lift["force_error"] for lift in lifts),
        "paper": (paper, len(lifts)),
        "stops": "" if paper == len(lifts) else stops,
    }


def of_critical_areas(found: Study) -> Facts:
    """Critical areas by formulation and tolerance, and slopes of the floors before both ends."""
    numbers, rows = found.numbers, found.tables["fig7b-tolerance"]
    areas, takes, slopes = (
        numbers[name] for name in ("critical_area", "tolerance_for_the_printed", "slopes_of_the_floor")
    )
    tolerances = list(areas[SIMPLE])
    smallest, median, largest = (
        {name: np.array([one[part] for one in by.values()]) for name, by in areas.items()}
        for part in ("smallest", "median", "largest")
    )
    # by tolerance and way, from a start to a node, which may have a way from the same start before it
    ways = {name: column(rows, "smallest", element=name).reshape(len(tolerances), -1) for name in LABELS}
    starts = column(rows, "start", element=SIMPLE, tolerance=rows[0]["tolerance"])
    passed = {
        name: _part(np.isfinite(one[:, 1:][:, starts[1:] == starts[:-1]])) for name, one in ways.items()
    }
    # at the tolerances at which the Euler-Bernoulli contact still moves
    usable = median[SIMPLE] < MOVES
    smaller, gain = {}, {}
    for above, below in pairwise(PRINTED):
        both = usable[:, None] & np.isfinite(ways[above] + ways[below])
        smaller[above] = _part((ways[above] > ways[below])[both])
        factors = median[above][usable] / np.maximum(median[below][usable], NEAREST)
        printed = float(np.sqrt(np.prod(PRINTED[above]) / np.prod(PRINTED[below])))
        gain[above] = factors.min(), factors.max(), printed, factors.min() / printed, factors.max() / printed
    low, high = PRINTED[TIMOSHENKO]
    under = [at for at, area in zip(tolerances, largest[TIMOSHENKO], strict=True) if area <= low]
    shown = tolerances[0], tolerances[-1], f"{numbers['tolerance_of_the_curves']:.0e}"
    floors = found.tables["fig7b-floor"]
    ratio = {"end": "end", "ratio": min(column(floors, "ratio"), key=lambda ratio: abs(ratio - 1e-3))}
    stiff = column(floors, "floor", element=TIMOSHENKO, psi=PRINTED_SHEAR_PSI, **ratio)
    return {
        "tolerance": shown,
        "range": {name: [_range(by[at]) for at in shown] for name, by in areas.items()},
        "least": {name: one.min() for name, one in smallest.items()},
        "areas": {name: one.tolist() for name, one in largest.items()},
        "largest": {name: one.max() for name, one in largest.items()},
        "slopes": slopes,
        "slope": {
            name: " and ".join(f"{round(one, 3) + 0.0:.3f}" for one in both) for name, both in slopes.items()
        },
        # with the printed G, over that of Euler-Bernoulli
        "stiff": float(stiff[0] / column(floors, "floor", element=SIMPLE, psi=PSI, **ratio)[0]),
        # where the measured range meets the printed one, and whether the printed one lies between two that do not
        "meets": {
            name: [*((smallest[name] <= most) & (largest[name] >= least)), *[True] * bool(takes[name] > 0.0)]
            for name, (least, most) in PRINTED.items()
        },
        "takes": {
            name: "beyond those measured" if np.isnan(one) else f"{one:.0e} EI/L^2"
            for name, one in takes.items()
        },
        "smaller": smaller,
        "gain": gain,
        "passed": passed,
        "ahead": passed[TIMOSHENKO][2] - max(passed[SIMPLE][2], passed[CANTILEVER][2]),
        "printed": (low, high),
        "nearest": NEAREST,
        "under": f"at {under[-1]} EI/L^2 and looser" if under else "at no tolerance measured",
    }


def _part(holds: NDArray[np.bool_]) -> tuple[int, int, float]:
    """Return how many hold, of how many, and their ratio."""
    return int(holds.sum()), holds.size, float(np.divide(holds.sum(), holds.size))


def _range(area: Mapping[str, float]) -> str:
    nowhere = " (nowhere in the element)" if area["largest"] == 1.0 else ""
    return f"{percent(area['smallest'])} to {percent(area['largest'])}{nowhere}"


def of_shapes(found: Study) -> Facts:
    """Errors of the paper's element with 10, 20 and 50 elements, and of the solid, in the main reading."""
    runs: dict[Any, Row] = {run["label"]: run for run in found.numbers["runs"] if run["reading"] == KS}
    runs |= {one.options.elements: runs[one.label] for one in PAPER}
    divisions, asked = [one.options.elements for one in PAPER], ("shape", "force", "moment")
    errors = {
        of: {name: float(runs[of][f"error_path_{name}"]) for name in (*asked, "arc")}
        for of in (*divisions, SOLID.label)
    }
    all_runs = [run for run in found.numbers["runs"] if run["label"] in {one.label for one in PAPER}]
    failed = [run for run in all_runs if not run["follows_the_rod"]]
    ends = (
        f"{run['label']} on {run['reading']} ({'another branch' if run['status'] == 'COMPLETED' else run['status']})"
        for run in failed
    )
    each = (f"{n} elements {', '.join(percent(errors[n][name]) for name in asked)}" for n in divisions)
    return {
        "follow": (len(all_runs) - len(failed), len(all_runs)),
        "refuted": [False if failed else None],
        "not": f"; not: {', '.join(ends)}" if failed else "",
        "reasons": "".join(f" {one}" for one in dict.fromkeys(WHY_NOT[run["reading"]] for run in failed)),
        "apart": {n: runs[n]["shape_difference"] for n in divisions},
        "error": errors,
        "errors": [errors[n][name] for n in divisions for name in asked],
        "each": "; ".join(each),
        "worst": [
            max(errors[of][name] for name in names)
            for of, names in ((20, ("force", "arc", "shape")), (SOLID.label, ("force", "shape")))
        ],
        "run": runs,
        "cost": [runs[20][name] / runs[SOLID.label][name] for name in ("unknowns", "seconds")],
    }


def of_double_beam(found: Study) -> Facts:
    """Events against those of the exact rods, and how far the paper's element comes."""
    events, rows = found.numbers["events"], found.tables["fig9"]
    attempts = [attempt for attempt in found.numbers["attempts"] if attempt["element"] == TIMOSHENKO]
    first = {(one["kind"], one["pair"]): one for one in reversed(events)}
    depths = {name: first[one]["depth"] if one in first else np.nan for name, one in EXPECTED.items()}
    coupled = [row for row in rows if EVENTS["touch"] < row["depth"] < EVENTS["hand-over"]]
    # a run that ends at the hand-over ends where this program does, and the paper's went on
    through = [None if one["at_hand_over"] else one["status"] == "COMPLETED" for one in attempts]
    over = [one for one in events if one["depth"] == depths["hand-over"] and one["pair"] in {TIP, LOWER}]
    crowded = ", ".join(map(str, sorted({one["element"] + 1 for one in over})))
    reasons = {
        False: " A pin that starts on a beam node is in the critical area from the start.",
        None: " Beside the node both contacts pass every node until the hand-over. There pin and upper tip are on one element of the "
        f"lower beam (number {crowded}), the paper's element has one contact point, and how its program went on is not said.",
    }
    deepest = max(attempt["depth"] for attempt in attempts)
    return {
        "event": {
            name: f"{kind} of {pair} at depth {depths[name]:.6f} m, exact rods {EVENTS[name]:.6f} m"
            if (kind, pair) in first
            else f"no {kind} of {pair}"
            for name, (kind, pair) in EXPECTED.items()
        },
        "off": {name: abs(depth - EVENTS[name]) for name, depth in depths.items()},
        "closed": [np.isfinite(column(coupled, f"{pair} arc")).all() for pair in (UPPER, TIP)],
        "taken_over": ("touch", LOWER) in first,
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
        "through": through,
        "reasons": "".join(words for end, words in reasons.items() if end in through),
        "deepest": deepest,
        "beyond": deepest - EVENTS["touch"],
        "apart": max(one["force"] for one in found.numbers["checks"] if one["stage"] == "coupled"),
    }


def percent(value: float) -> str:
    """Return a ratio in percent, with three digits."""
    return f"{100.0 * value:.3g} %" if value >= 1e-6 else f"{100.0 * value:.0e} %"


FACTS: dict[str, Callable[[Study], Facts]] = {
    "fig7a": of_lifts,
    "fig7b": of_critical_areas,
    "fig8": of_shapes,
    "fig9": of_double_beam,
}
"""By figure."""
