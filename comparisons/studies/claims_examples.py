"""The claims of [P] on its examples: abstract, Fig. 7a, sections 4.2 and 4.3, conclusions 2 and 3."""

import numpy as np

from comparisons.compare import PAPER, SOLID
from comparisons.studies.cantilever_shapes import ELEMENTS, Lifts
from comparisons.studies.double_beam import LOWER, TIP, UPPER, Attempt, DoubleBeam
from comparisons.studies.ks_shapes import Run8, Shapes
from comparisons.studies.verdict import Claim, Judgement, Verdict, holds, percent

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
        np.isclose(lift.reached["timoshenko"], lift.rod_slip_off, rtol=SLIP_OFF) for lift in found.lifts
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
        + f" of the length; the solid itself is {percent(_solid(found).shape_error)} from the exact rod",
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
            f"{percent(run.errors.contact_force)}, clamp moment {percent(run.errors.clamp_moment)}"
            for run in runs
        ),
        "True of the shapes that the paper shows. Forces it does not show: they are an order of magnitude less accurate, because the "
        "element has linear strains and its contact force is normal to the chord.",
    )


def simple_enough(found: Shapes) -> Judgement:
    """State what a simple element costs and gives."""
    ten, solid = _paper(found)[0], _solid(found)
    return Judgement(
        verdict=Verdict.CANNOT_BE_TOLD,
        number=f"{ten.unknowns} unknowns for a shape within {percent(ten.shape_error)} of the length; the solid has {solid.unknowns}, {percent(solid.shape_error)}",
        why="Sufficient depends on the accuracy wanted, and how complex a setting is has no number.",
    )


def less_division(found: Shapes) -> Judgement:
    """Judge whether TSM with few elements is adequate beside the solid."""
    run, solid = _paper(found)[1], _solid(found)
    errors = max(run.errors.contact_force, run.errors.arc_position, run.shape_error)
    return holds(
        errors < ALIKE,
        f"{run.label}: largest of the errors in force, place and shape {percent(errors)}; solid {percent(max(solid.errors.contact_force, solid.shape_error))} "
        f"(its material law, not its mesh)",
        "Within one percent of the exact rod with 20 elements; with 10 the contact force is "
        f"{percent(_paper(found)[0].errors.contact_force)} off.",
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
    depth, wanted = events[0].depth, found.exact_events[exact]
    return abs(
        depth - wanted
    ) < LOCATED, f"{kind} of {pair} at depth {depth:.6f} m, exact rods {wanted:.6f} m"


def begins(found: DoubleBeam) -> Judgement:
    """Judge whether both contacts of stage (b) come about."""
    ok, number = _located(found, "touch", TIP, "touch")
    return holds(
        ok,
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
        f"What ends the coupled stage is '{found.end}': the tip still presses on the lower beam, and the pin takes over its place and force.",
    )


def leaves(found: DoubleBeam) -> Judgement:
    """Judge whether the pin leaves the lower beam, stage (f)."""
    ok, number = _located(found, "slip-off", LOWER, "slip-off")
    return holds(ok, number, "The lower beam alone under the pin is the elastica of a single rod.")


def _attempts(found: DoubleBeam) -> list[Attempt]:
    return [attempt for attempt in found.attempts if attempt.element == "timoshenko"]


def _attempts_text(found: DoubleBeam) -> str:
    return ", ".join(
        f"pin at {attempt.place:g} m: {attempt.status} at depth {attempt.depth:.2f} m, {attempt.passes} nodes passed"
        for attempt in _attempts(found)
    )


def passes_every_edge(found: DoubleBeam) -> Judgement:
    """Judge whether the paper's element carries all contacts over every node and to the end."""
    through = [attempt.status == "COMPLETED" for attempt in _attempts(found)]
    crowded = {event.element for pair in (TIP, LOWER) for event in found.at_hand_over(pair)}
    why = "It does, at every place of the pin tried."
    if not all(through):
        why = "A pin that starts on a beam node is in the critical area from the start."
    if not any(through) and len(crowded) == 1:
        why += (
            " Beside the node both contacts do pass through until the hand-over. There the pin and the upper tip are on one "
            f"element of the lower beam (number {crowded.pop() + 1}), and the paper's element has one contact point; how its program went on is not said."
        )
    return holds(
        all(through),
        f"Timoshenko, {_attempts_text(found)}; mixed: {sum(event.kind == 'pass-through' for event in found.events)} passes, all stages",
        why,
    )


def simultaneous(found: DoubleBeam) -> Judgement:
    """Judge whether two contacts are closed at the same time."""
    deepest = max(attempt.depth for attempt in _attempts(found))
    checks = [check for check in found.checks if check.stage == "coupled"]
    return holds(
        deepest > found.exact_events["touch"] + LOCATED,
        f"both contacts closed from depth {found.exact_events['touch']:.3f} m on; Timoshenko follows them to {deepest:.2f} m; mixed is within "
        f"{max(check.force for check in checks):.0e} of the force of two exact rods in contact",
        "Two rods, two contacts, one of them between the beams.",
    )


CLAIMS = (
    Claim(
        source="abstract",
        text="The improved equation overcomes any geometrically nonlinear analysis, extremely large displacements included.",
        figure="fig8",
        judge=anything,
    ),
    Claim(
        source="4.1, Fig. 7(a)",
        text="The beam is lifted by the control node from six starting positions.",
        figure="fig7a",
        judge=followed,
    ),
    Claim(
        source="4.2, Fig. 8",
        text="The deformations of TSM and FEM are not significantly different.",
        figure="fig8",
        judge=alike,
    ),
    Claim(
        source="4.2, Fig. 8",
        text="TSM with 10 and 20 divisions is similar to FEM with densely partitioned solid elements.",
        figure="fig8",
        judge=few_elements,
    ),
    Claim(
        source="4.2",
        text="A simple definition of the contact element is sufficient.",
        figure="fig8",
        judge=simple_enough,
    ),
    Claim(
        source="4.3, stage (b)",
        text="Pin and upper beam, and the upper beam's tip and the lower beam, come into contact.",
        figure="fig9",
        judge=begins,
    ),
    Claim(
        source="4.3, stage (d)",
        text="The control node shifts from the upper to the lower beam.",
        figure="fig9",
        judge=hands_over,
    ),
    Claim(
        source="4.3, stage (f)",
        text="The control node goes on until it exceeds the lower beam.",
        figure="fig9",
        judge=leaves,
    ),
    Claim(
        source="4.3",
        text="With the Timoshenko beam the contact nodes pass through every element edge smoothly and simultaneously.",
        figure="fig9",
        judge=passes_every_edge,
    ),
    Claim(
        source="conclusion 2",
        text="Very high performance with fewer elements, adequate compared with solid elements.",
        figure="fig8",
        judge=less_division,
    ),
    Claim(
        source="conclusion 2",
        text="The cost of calculation is reduced.",
        figure="fig8",
        judge=cheaper,
    ),
    Claim(
        source="conclusion 3",
        text="Multiple contacts can be computed at the same time.",
        figure="fig9",
        judge=simultaneous,
    ),
    Claim(
        source="conclusion 3",
        text="All contact nodes pass through smoothly without any divergence of the unbalanced force.",
        figure="fig9",
        judge=passes_every_edge,
    ),
)
"""In the order of the paper, with `claims_critical_area`."""
