"""The claims of [P] on its examples: abstract, Fig. 7a, sections 4.2 and 4.3, conclusions 2 and 3. A judge's docstring is what the paper says."""

import numpy as np

from comparisons.claims.paper.cantilever_shapes import ELEMENTS
from comparisons.claims.paper.figure_study import Study, column
from comparisons.claims.paper.formulations import TIMOSHENKO
from comparisons.claims.paper.verdict import Judgement, claim, holds, percent
from comparisons.claims.problems.double_beam import EVENTS, LOWER, TIP, UPPER
from comparisons.compare import PAPER, SOLID
from comparisons.output import Row

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


def _run(found: Study, label: str) -> Row:
    return next(run for run in found.numbers["runs"] if (run["reading"], run["label"]) == (KS, label))


def _paper(found: Study) -> list[Row]:
    return [_run(found, run.label) for run in PAPER]


def _error(run: Row, *quantities: str) -> float:
    """Largest error over the load parameters."""
    return max(float(run[f"error_path_{quantity}"]) for quantity in quantities)


@claim("fig8", "abstract")
def anything(found: Study) -> Judgement:
    """The improved equation overcomes any geometrically nonlinear analysis, extremely large displacements included."""
    runs = [run for run in found.numbers["runs"] if run["label"] in {one.label for one in PAPER}]
    failed = [run for run in runs if not run["follows_the_rod"]]
    names = ", ".join(
        f"{run['label']} on {run['reading']} ({'another branch' if run['status'] == 'COMPLETED' else run['status']})"
        for run in failed
    )
    reasons = dict.fromkeys(WHY_NOT[run["reading"]] for run in failed)
    return holds(
        [False if failed else None],
        f"{len(runs) - len(failed)} of {len(runs)} runs with the paper's Timoshenko element follow the exact rod"
        + (f"; not: {names}" if failed else ""),
        " ".join(["'Any' can be refuted, not shown.", *reasons]),
    )


@claim("fig7a", "4.1, Fig. 7(a)")
def followed(found: Study) -> Judgement:
    """The beam is lifted by the control node from six starting positions."""
    lifts = found.numbers["starting_positions"]
    coarse, fine = (max(lift["slip_off_error"][elements] for lift in lifts) for elements in ELEMENTS)
    paper = sum(
        bool(np.isclose(lift["reached_in_contact"][TIMOSHENKO], lift["slip_off_rod"], rtol=SLIP_OFF))
        for lift in lifts
    )
    stops = " Its own element stops before the tip, in the last node's critical area."
    return holds(
        coarse < SLIP_OFF,
        f"displacement at slip-off against the exact rod: {coarse:.1e} with {ELEMENTS[0]} and {fine:.1e} with {ELEMENTS[1]} `mixed` elements; "
        f"contact force {max(lift['force_error'] for lift in lifts):.1e}; the paper's Timoshenko element comes to the slip-off in {paper} of {len(lifts)}",
        f"The paper gives no numbers for Fig. 7a.{'' if paper == len(lifts) else stops}",
    )


@claim("fig8", "4.2, Fig. 8")
def alike(found: Study) -> Judgement:
    """The deformations of TSM and FEM are not significantly different."""
    apart = {
        one.options.elements: run["shape_difference"] for one, run in zip(PAPER, _paper(found), strict=True)
    }
    return holds(
        all(value < ALIKE for value in apart.values()),
        "largest distance of the axes from the solid's, TSM with "
        + ", ".join(f"{elements}: {percent(value)}" for elements, value in apart.items())
        + f" of the length; the solid itself is {percent(_error(_run(found, SOLID.label), 'shape'))} from the exact rod",
        "The printed scene had to be completed: the printed G contradicts E and nu, and whether the node slides or is tied to the tip "
        "is not said. Here it slides, and G follows from E and nu.",
    )


@claim("fig8", "4.2, Fig. 8")
def few_elements(found: Study) -> Judgement:
    """TSM with 10 and 20 divisions is similar to FEM with densely partitioned solid elements."""
    runs = _paper(found)[:2]
    return holds(
        all(run["shape_difference"] < ALIKE for run in runs),
        "; ".join(
            f"{run['label']}: shape {percent(run['shape_difference'])} from the solid, and from the exact rod contact force "
            f"{percent(_error(run, 'force'))}, clamp moment {percent(_error(run, 'moment'))}"
            for run in runs
        ),
        "True of the shapes that the paper shows. Forces it does not show: they are an order of magnitude less accurate, because the "
        "element has linear strains and its contact force is normal to the chord.",
    )


@claim("fig8", "4.2")
def simple_enough(found: Study) -> Judgement:
    """A simple definition of the contact element is sufficient."""
    runs, solid = _paper(found), _run(found, SOLID.label)
    errors = {
        one.options.elements: [_error(run, name) for name in ("shape", "force", "moment")]
        for one, run in zip(PAPER, runs, strict=True)
    }
    texts = (f"{count} elements {', '.join(map(percent, values))}" for count, values in errors.items())
    return holds(
        [bool(value < ALIKE) for values in errors.values() for value in values],
        f"{runs[0]['unknowns']} unknowns for a shape within {percent(_error(runs[0], 'shape'))} of the length, the solid has {solid['unknowns']}, "
        f"{percent(_error(solid, 'shape'))}; errors of shape, contact force and clamp moment: {'; '.join(texts)}",
        "Sufficient depends on the quantity, the division and the accuracy wanted, which the paper does not state; one percent is asked for here.",
    )


@claim("fig8", "conclusion 2")
def less_division(found: Study) -> Judgement:
    """Very high performance with fewer elements, adequate compared with solid elements."""
    ten, run, _ = _paper(found)
    errors, solid = _error(run, "force", "arc", "shape"), _error(_run(found, SOLID.label), "force", "shape")
    return holds(
        errors < ALIKE,
        f"{run['label']}: largest of the errors in force, place and shape {percent(errors)}; solid {percent(solid)} "
        f"(its material law, not its mesh)",
        f"One percent of the exact rod is asked for; with 10 elements the contact force is {percent(_error(ten, 'force'))} off.",
    )


@claim("fig8", "conclusion 2")
def cheaper(found: Study) -> Judgement:
    """The cost of calculation is reduced."""
    run, solid = _paper(found)[1], _run(found, SOLID.label)
    return holds(
        run["unknowns"] < solid["unknowns"] and run["seconds"] < solid["seconds"],
        f"{run['label']}: {run['unknowns']} unknowns, {run['iterations']} iterations, {run['seconds']:.2f} s; "
        f"solid: {solid['unknowns']}, {solid['iterations']}, {solid['seconds']:.2f} s",
        "One machine, one run, two programs of this project; the paper gives no times.",
    )


def _events(found: Study, kind: str, pair: str) -> list[Row]:
    return [one for one in found.numbers["events"] if (one["kind"], one["pair"]) == (kind, pair)]


def _located(found: Study, kind: str, pair: str, exact: str) -> tuple[bool, str]:
    """Whether an event was found where the exact rods have it, and a sentence."""
    events = _events(found, kind, pair)
    if not events:
        return False, f"no {kind} of {pair}"
    depth, wanted = events[0]["depth"], EVENTS[exact]
    words = f"{kind} of {pair} at depth {depth:.6f} m, exact rods {wanted:.6f} m"
    return bool(abs(depth - wanted) < LOCATED), words


@claim("fig9", "4.3, stage (b)")
def begins(found: Study) -> Judgement:
    """Pin and upper beam, and the upper beam's tip and the lower beam, come into contact."""
    ok, number = _located(found, "touch", TIP, "touch")
    coupled = [row for row in found.tables["fig9"] if EVENTS["touch"] < row["depth"] < EVENTS["hand-over"]]
    return holds(
        ok and all(bool(np.isfinite(column(coupled, f"{pair} arc")).all()) for pair in (UPPER, TIP)),
        number,
        "Lengths, spacing and the pin's place are not printed: the stage is reproduced, its depth is this scene's own.",
    )


@claim("fig9", "4.3, stage (d)")
def hands_over(found: Study) -> Judgement:
    """The control node shifts from the upper to the lower beam."""
    ok, number = _located(found, "slip-off", UPPER, "hand-over")
    released = sum(event["released"] for event in _events(found, "slip-off", UPPER))
    last = np.nanmax(column(found.tables["fig9"], f"{TIP} exact_force"))
    return holds(
        ok and bool(_events(found, "touch", LOWER)),
        f"{number}; the upper beam releases {released:.4f} N m; tip force up to then {last:.3f} N",
        "What ends the coupled stage is the pin at the tip: the tip still presses on the lower beam, and the pin takes over its place and force.",
    )


@claim("fig9", "4.3, stage (f)")
def leaves(found: Study) -> Judgement:
    """The control node goes on until it exceeds the lower beam."""
    why = "The lower beam alone under the pin is the elastica of a single rod."
    return holds(*_located(found, "slip-off", LOWER, "slip-off"), why)


def _attempts(found: Study) -> list[Row]:
    return [attempt for attempt in found.numbers["attempts"] if attempt["element"] == TIMOSHENKO]


@claim("fig9", "4.3", "conclusion 3")
def passes_every_edge(found: Study) -> Judgement:
    """With the Timoshenko beam the contact nodes pass through every element edge smoothly and simultaneously.

    All contact nodes pass through smoothly without any divergence of the unbalanced force.
    """
    attempts = _attempts(found)
    # a run that ends at the hand-over ends where this program does, and the paper's went on
    through = [None if one["at_hand_over"] else one["status"] == "COMPLETED" for one in attempts]
    why = "The pin's place is not printed."
    if False in through:
        why += " A pin that starts on a beam node is in the critical area from the start."
    if None in through:
        over = [event["depth"] for event in _events(found, "slip-off", UPPER)]
        crowded = {
            event["element"] + 1
            for event in found.numbers["events"]
            if event["pair"] in {TIP, LOWER} and event["depth"] in over
        }
        why += (
            " Beside the node both contacts pass every node until the hand-over. There pin and upper tip are on one element of the "
            f"lower beam (number {', '.join(map(str, sorted(crowded)))}), the paper's element has one contact point, and how its program went on is not said."
        )
    texts = (
        f"pin at {one['place']:g} m: {one['status']} at depth {one['depth']:.2f} m, {one['passes']} nodes passed"
        for one in attempts
    )
    passed = sum(event["kind"] == "pass-through" for event in found.numbers["events"])
    return holds(through, f"Timoshenko, {', '.join(texts)}; mixed: {passed} passes, all stages", why)


@claim("fig9", "conclusion 3")
def simultaneous(found: Study) -> Judgement:
    """Multiple contacts can be computed at the same time."""
    deepest = max(attempt["depth"] for attempt in _attempts(found))
    apart = max(check["force"] for check in found.numbers["checks"] if check["stage"] == "coupled")
    return holds(
        bool(deepest > EVENTS["touch"] + LOCATED),
        f"both contacts closed from depth {EVENTS['touch']:.3f} m on; Timoshenko follows them to {deepest:.2f} m; mixed is within "
        f"{apart:.0e} of the force of two exact rods in contact",
        "Two rods, two contacts, one of them between the beams.",
    )
