"""The findings of a comparison: every sentence changes with its data."""

from dataclasses import replace
from math import inf, nan

import numpy as np
import pytest

from comparisons.answer.quantities import names
from comparisons.models import ELASTICA, SOLID, TSM, certified, solve
from comparisons.models.model import Options
from comparisons.referee import Verdict
from comparisons.report.findings import BUDGET, findings  # sentences on data that no scene gives at will
from comparisons.scene import load_scene
from comparisons.suite import Row
from comparisons.suite.budget import PARTS, Budget
from comparisons.suites.compare import ROD, Run, line, row_of, run_of

KS = replace(load_scene("ks-cantilever"), load_parameters=5)


def beams(element: str, elements: int) -> Run:
    return run_of(TSM, Options(element=element, elements=elements))


CHOSEN = (
    beams("timoshenko", 10), beams("timoshenko", 20), beams("exact", 1),
    run_of(SOLID, Options(mesh=(16, 1))), run_of(ELASTICA, Options()), ROD,
)  # fmt: skip


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    answers = {run: certified(solve(KS, run.model, run.options), KS) for run in CHOSEN}
    return [row_of(KS, run, answers[run], answers[ROD]) for run in CHOSEN]


def budget(**parts: float) -> Budget:
    """Difference at the third load parameter, of the parts given, of one pair of two."""
    at = np.array([0.0, 0.0, 1.0, 0.5])
    values = {part: parts.get(part.replace(" ", "_"), 0.0) * at for part in PARTS}
    small = {part: 0.1 * value for part, value in values.items()}
    both = {"contact_force c->d": small, "contact_force a->b": values}
    return Budget(
        scene=KS.name,
        total={one: np.sum(list(own.values()), axis=0) for one, own in both.items()},
        parts=both,
    )


def told(rows: list[Row], made: Budget | None = None, left_out: dict[str, str] | None = None) -> str:
    bodies = rows[2].against(rows[3].response, names("mesh"))
    found = findings(rows, ROD.label, bodies, made, left_out or {})
    return " ".join([found.sentence, *found.points])


def changed(rows: list[Row], number: int, **fields: object) -> list[Row]:
    """Return rows of which one has another response."""
    response = replace(rows[number].response, **fields)
    other = replace(rows[number], response=response)
    return [*rows[:number], other, *rows[number + 1 :]]


def with_error(rows: list[Row], number: int, **errors: float) -> list[Row]:
    """Return rows of which one has other errors."""
    row = rows[number]
    other = replace(row, errors={**row.errors, "path": {**row.errors["path"], **errors}})
    return [*rows[:number], other, *rows[number + 1 :]]


DIFFER = "In the error budget, beams and solid differ most in the "
APART = "solid and the exact rod disagree on whether a contact is closed."
WITHIN = "Within 1 % of the exact rod: "
STOPPED = {"status": "CUTBACK_FLOOR", "message": "no step", "load_parameter": np.array([0.2, 0.4])}
LEFT_OUT = {"elastica": "two pins", "mine": "two pins", "solid Q2": "no height", BUDGET: "no solid"}


def test_every_sentence_is_said_of_its_data_and_of_no_other(rows):
    plain = told(rows)
    off = with_error(with_error(rows, 0, moment=0.016), 1, moment=0.004, force=0.001)
    stable = [changed(rows, k, index=np.zeros(5, dtype=int))[k] for k in range(len(rows))]
    unstable, partly = (
        changed(stable, 2, index=np.array(index)) for index in ([0, 0, 1, 0, 0], [0, -1, -1, -1, 0])
    )
    one = rows[0].response.certificate
    certificates = (
        replace(one, verdict=Verdict.UNSTABLE, reason="index 1"),
        replace(one, verdict=Verdict.NOT_JUDGED, reason="no search"),
        None,
    )
    refused = rows
    for number, certificate in enumerate(certificates):
        refused = changed(refused, number, certificate=certificate)
    nothing = with_error(rows, 1, force=nan, arc=nan, moment=nan, tip=nan)
    law = budget(material_law=0.003, solid_mesh=-0.0005, penalty=0.00001)
    for found, said in (
        (plain, "Beam and solid differ in the contact force by 0.38 % of its largest value; for 1 % a beam is enough: TSM exact, 1 element ("),
        (told(rows, law), "of its largest value, most of it by the material law (the solid's stress is not linear in the rod's strain); for 1 % a beam is enough"),
        (told(off), f"{WITHIN}TSM timoshenko with 20 elements (0.4 %), TSM exact with 1 element ("),
        (told(with_error(off, 1, tip=0.5)), "elastica (0.12 %). Beyond: TSM timoshenko (50 %). Why models are off: "),
        (told(off), "Why models are off: TSM timoshenko, second order of the element (falls with the power 2.0 of the length of the elements); "),
        (told(with_error(rows, 2, force=1e-3)), "; TSM exact, accuracy"),
        (plain, "; elastica, stretch and shear."),
        (told(rows, law), f"{DIFFER}contact force a->b, at load parameter 0.75: by 0.25 % of its value there, made of 0.3 % material law and -0.05 % solid mesh (the solid's elements)."),
        (told(rows, budget(solid_mesh=1e-11)), "In the error budget, beams and solid agree to 1e-09 %."),
        (told(with_error(rows, 3, arc=inf)), APART),
        (told(changed(rows, 1, **STOPPED)), "TSM timoshenko, 20 elements did not complete (CUTBACK_FLOOR: no step); errors are those up to load parameter 0.4."),
        (told(changed(changed(rows, 0, **STOPPED | {"message": "no step 1"}), 1, **STOPPED | {"message": "no step 2.5"})), "timoshenko (2 runs) did not complete (CUTBACK_FLOOR: no step 1); "),
        (told(rows, left_out=LEFT_OUT), "Not stated by elastica and mine: two pins. Not stated by solid Q2: no height. There is no error budget: no solid."),
        (plain, "Stability is not stated by TSM timoshenko, elastica and exact rod."),
        (told(unstable), "Unstable equilibria are on the path of TSM exact."),
        (told(partly), "Stability is stated at a part of the load parameters by TSM exact."),
        (plain, "The referee, an independent solver, certified every answer."),
        (told(refused), "The referee, an independent solver, certified 3 of 6 answers; TSM timoshenko, 10 elements was refused (index 1); TSM timoshenko, 20 elements was not judged (no search); TSM exact, 1 element was not judged."),
    ):  # fmt: skip
        assert said in found
    for found, words in (
        (plain, ("In the error budget", APART, "did not complete", "Not stated", "no error budget")),
        (told(stable), ("Stability", "Unstable")),
        (told(nothing), ("timoshenko with 20 elements", "timoshenko, second order of the element (falls")),
        (told(rows, law), ("softer", "solid Q2, ")),
    ):
        assert [word for word in words if word in found] == []
    assert "(CUTBACK_FLOOR: no step). Not stated" in told(changed(rows, 1, **STOPPED | {"load_parameter": np.zeros(0)}), None, LEFT_OUT)  # fmt: skip
    answer = findings(rows, ROD.label, rows[2], None, {}).answer
    moment = next(row for row in answer if row[""] == "support moment [N m]")
    beam, solid, percent = float(moment["beam"]), float(moment["solid Q2"]), float(moment["apart"][:-2])
    assert beam < solid < 0.0  # the smaller one is less, whatever its sign
    assert percent == pytest.approx(100 * (solid / beam - 1), abs=0.05)
    assert percent < 0.0
    for answers, cell in ((unstable, "no"), (partly, "in part")):
        assert [line(row)["stable"] for row in answers] == [
            cell if n == 2 else "yes" for n in range(len(answers))
        ]
