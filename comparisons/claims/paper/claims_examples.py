"""The claims of [P] on its examples: abstract, Fig. 7a, sections 4.2 and 4.3, conclusions 2 and 3."""

import numpy as np

from comparisons.claims.paper.cantilever_shapes import ELEMENTS, Lifts
from comparisons.claims.paper.double_beam import Attempt, DoubleBeam
from comparisons.claims.paper.ks_shapes import Run8, Shapes
from comparisons.claims.paper.verdict import Judgement, Verdict, claim, holds, over_readings, percent
from comparisons.claims.problems.double_beam import EVENTS, LOWER, TIP, UPPER
from comparisons.compare import PAPER, SOLID
from tsm.elements import TIMOSHENKO

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


def _paper(found: Shapes) -> list[Run8]:
    return [found.run(KS, run.label) for run in PAPER]


def _solid(found: Shapes) -> Run8:
    return found.run(KS, SOLID.label)


def followed(found: Lifts) -> Judgement:
    """Judge whether the beam follows the control node from all starting positions."""
    coarse, fine = (max(lift.slip_off_error(elements) for lift in found.lifts) for elements in ELEMENTS)
    paper = sum(
        np.isclose(lift.reached[TIMOSHENKO.name], lift.rod_slip_off, rtol=SLIP_OFF) for lift in found.lifts
    )
    return holds(
        coarse < SLIP_OFF,
        f"displacement at slip-off against the exact rod: {coarse:.1e} with {ELEMENTS[0]} and {fine:.1e} with {ELEMENTS[1]} `mixed` elements; "
        f"contact force {max(lift.force_error for lift in found.lifts):.1e}; the paper's Timoshenko element comes to the slip-off in {paper} of {len(found.lifts)}",
        "The paper gives no numbers for Fig. 7a."
        + (
            ""
            if paper == len(found.lifts)
            else " Its own element stops before the tip, in the last node's critical area."
        ),
    )


def anything(found: Shapes) -> Judgement:
    """Look for a counterexample among the readings of section 4.2."""
    runs = [run for run in found.runs if run.label in {one.label for one in PAPER}]
    failed = [run for run in runs if not run.follows]
    names = ", ".join(
        f"{run.label} on {run.reading} ({'another branch' if run.status == 'COMPLETED' else run.status})"
        for run in failed
    )
    return Judgement(
        verdict=Verdict.NOT_REPRODUCED if failed else Verdict.CANNOT_BE_TOLD,
        number=f"{len(runs) - len(failed)} of {len(runs)} runs with the paper's Timoshenko element follow the exact rod"
        + (f"; not: {names}" if failed else ""),
        why=" ".join(
            ["'Any' can be refuted, not shown.", *dict.fromkeys(WHY_NOT[run.reading] for run in failed)]
        ),
    )


def alike(found: Shapes) -> Judgement:
    """Judge whether TSM and solid give the same shapes."""
    apart = [run.shape_difference for run in _paper(found)]
    return holds(
        max(apart) < ALIKE,
        "largest distance of the axes from the solid's, TSM with "
        + ", ".join(
            f"{run.options.elements}: {percent(value)}" for run, value in zip(PAPER, apart, strict=True)
        )
        + f" of the length; the solid itself is {percent(_solid(found).error('shape'))} from the exact rod",
        "The printed scene had to be completed: the printed G contradicts E and nu, and whether the node slides or is tied to the tip "
        "is not said. Here it slides, and G follows from E and nu.",
    )


def few_elements(found: Shapes) -> Judgement:
    """Judge whether 10 and 20 elements are like the dense solid."""
    runs = _paper(found)[:2]
    return holds(
        all(run.shape_difference < ALIKE for run in runs),
        "; ".join(
            f"{run.label}: shape {percent(run.shape_difference)} from the solid, and from the exact rod contact force "
            f"{percent(run.error('force'))}, clamp moment {percent(run.error('moment'))}"
            for run in runs
        ),
        "True of the shapes that the paper shows. Forces it does not show: they are an order of magnitude less accurate, because the "
        "element has linear strains and its contact force is normal to the chord.",
    )


def simple_enough(found: Shapes) -> Judgement:
    """Judge whether the simple element gives shape, force and moment within what is alike, with each division."""
    runs, solid = _paper(found), _solid(found)
    errors = [(run.error("shape"), run.error("force"), run.error("moment")) for run in runs]
    ten = runs[0]
    return over_readings(
        [bool(value < ALIKE) for values in errors for value in values],
        f"{ten.unknowns} unknowns for a shape within {percent(ten.error('shape'))} of the length, the solid has {solid.unknowns}, "
        f"{percent(solid.error('shape'))}; errors of shape, contact force and clamp moment: "
        + "; ".join(
            f"{run.options.elements} elements {', '.join(percent(value) for value in values)}"
            for run, values in zip(PAPER, errors, strict=True)
        ),
        "Sufficient depends on the quantity, the division and the accuracy wanted, which the paper does not state; one percent is asked for here.",
    )


def less_division(found: Shapes) -> Judgement:
    """Judge whether TSM with few elements is adequate beside the solid."""
    run, solid = _paper(found)[1], _solid(found)
    errors = max(run.error("force"), run.error("arc"), run.error("shape"))
    return holds(
        errors < ALIKE,
        f"{run.label}: largest of the errors in force, place and shape {percent(errors)}; solid {percent(max(solid.error('force'), solid.error('shape')))} "
        f"(its material law, not its mesh)",
        "One percent of the exact rod is asked for; with 10 elements the contact force is "
        f"{percent(_paper(found)[0].error('force'))} off.",
    )


def cheaper(found: Shapes) -> Judgement:
    """Judge whether TSM costs less."""
    run, solid = _paper(found)[1], _solid(found)
    return holds(
        run.unknowns < solid.unknowns and run.seconds < solid.seconds,
        f"{run.label}: {run.unknowns} unknowns, {run.iterations} iterations, {run.seconds:.2f} s; solid: {solid.unknowns}, {solid.iterations}, {solid.seconds:.2f} s",
        "One machine, one run, two programs of this project; the paper gives no times.",
    )


def _located(found: DoubleBeam, kind: str, pair: str, exact: str) -> tuple[bool, str]:
    """Whether an event was found where the exact rods have it, and a sentence."""
    events = found.events_of(kind, pair)
    if not events:
        return False, f"no {kind} of {pair}"
    depth, wanted = events[0].depth, EVENTS[exact]
    return abs(
        depth - wanted
    ) < LOCATED, f"{kind} of {pair} at depth {depth:.6f} m, exact rods {wanted:.6f} m"


def begins(found: DoubleBeam) -> Judgement:
    """Judge whether both contacts of stage (b) come about."""
    ok, number = _located(found, "touch", TIP, "touch")
    coupled = (found.depth > EVENTS["touch"]) & (found.depth < EVENTS["hand-over"])
    pressed = [bool(np.isfinite(found.histories[pair].arc[coupled]).all()) for pair in (UPPER, TIP)]
    return holds(
        ok and all(pressed),
        number,
        "Lengths, spacing and the pin's place are not printed: the stage is reproduced, its depth is this scene's own.",
    )


def hands_over(found: DoubleBeam) -> Judgement:
    """Judge whether the pin goes over to the lower beam, stage (d)."""
    ok, number = _located(found, "slip-off", UPPER, "hand-over")
    released = sum(event.released for event in found.events_of("slip-off", UPPER))
    last = found.histories[TIP].exact_force
    return holds(
        ok and bool(found.events_of("touch", LOWER)),
        f"{number}; the upper beam releases {released:.4f} N m; tip force up to then {np.nanmax(last):.3f} N",
        "What ends the coupled stage is the pin at the tip: the tip still presses on the lower beam, and the pin takes over its place and force.",
    )


def leaves(found: DoubleBeam) -> Judgement:
    """Judge whether the pin leaves the lower beam, stage (f)."""
    ok, number = _located(found, "slip-off", LOWER, "slip-off")
    return holds(ok, number, "The lower beam alone under the pin is the elastica of a single rod.")


def _attempts(found: DoubleBeam) -> list[Attempt]:
    return [attempt for attempt in found.attempts if attempt.element == TIMOSHENKO.name]


def _attempts_text(found: DoubleBeam) -> str:
    return ", ".join(
        f"pin at {attempt.place:g} m: {attempt.status} at depth {attempt.depth:.2f} m, {attempt.passes} nodes passed"
        for attempt in _attempts(found)
    )


def passes_every_edge(found: DoubleBeam) -> Judgement:
    """Judge whether the paper's element carries all contacts over every node and to the end, for every place of the pin."""
    attempts = _attempts(found)
    why = "The pin's place is not printed."
    if any(attempt.to_the_end is False for attempt in attempts):
        why += " A pin that starts on a beam node is in the critical area from the start."
    if any(attempt.to_the_end is None for attempt in attempts):
        crowded = {event.element + 1 for pair in (TIP, LOWER) for event in found.at_hand_over(pair)}
        why += (
            " Beside the node both contacts pass every node until the hand-over. There pin and upper tip are on one element of the "
            f"lower beam (number {', '.join(map(str, sorted(crowded)))}), the paper's element has one contact point, and how its program went on is not said."
        )
    return over_readings(
        [attempt.to_the_end for attempt in attempts],
        f"Timoshenko, {_attempts_text(found)}; mixed: {sum(event.kind == 'pass-through' for event in found.events)} passes, all stages",
        why,
    )


def simultaneous(found: DoubleBeam) -> Judgement:
    """Judge whether two contacts are closed at the same time."""
    deepest = max(attempt.depth for attempt in _attempts(found))
    checks = [check for check in found.checks if check.stage == "coupled"]
    return holds(
        deepest > EVENTS["touch"] + LOCATED,
        f"both contacts closed from depth {EVENTS['touch']:.3f} m on; Timoshenko follows them to {deepest:.2f} m; mixed is within "
        f"{max(check.force for check in checks):.0e} of the force of two exact rods in contact",
        "Two rods, two contacts, one of them between the beams.",
    )


CLAIMS = (
    claim(
        "fig8",
        anything,
        (
            "abstract",
            "The improved equation overcomes any geometrically nonlinear analysis, extremely large displacements included.",
        ),
    ),
    claim(
        "fig7a",
        followed,
        ("4.1, Fig. 7(a)", "The beam is lifted by the control node from six starting positions."),
    ),
    claim("fig8", alike, ("4.2, Fig. 8", "The deformations of TSM and FEM are not significantly different.")),
    claim(
        "fig8",
        few_elements,
        (
            "4.2, Fig. 8",
            "TSM with 10 and 20 divisions is similar to FEM with densely partitioned solid elements.",
        ),
    ),
    claim("fig8", simple_enough, ("4.2", "A simple definition of the contact element is sufficient.")),
    claim(
        "fig9",
        begins,
        (
            "4.3, stage (b)",
            "Pin and upper beam, and the upper beam's tip and the lower beam, come into contact.",
        ),
    ),
    claim(
        "fig9", hands_over, ("4.3, stage (d)", "The control node shifts from the upper to the lower beam.")
    ),
    claim("fig9", leaves, ("4.3, stage (f)", "The control node goes on until it exceeds the lower beam.")),
    claim(
        "fig9",
        passes_every_edge,
        (
            "4.3",
            "With the Timoshenko beam the contact nodes pass through every element edge smoothly and simultaneously.",
        ),
        (
            "conclusion 3",
            "All contact nodes pass through smoothly without any divergence of the unbalanced force.",
        ),
    ),
    claim(
        "fig8",
        less_division,
        ("conclusion 2", "Very high performance with fewer elements, adequate compared with solid elements."),
    ),
    claim("fig8", cheaper, ("conclusion 2", "The cost of calculation is reduced.")),
    claim("fig9", simultaneous, ("conclusion 3", "Multiple contacts can be computed at the same time.")),
)
"""In the order of the paper, with `claims_critical_area`."""
