"""The findings of a comparison: every sentence changes with its data."""

import csv
from dataclasses import replace
from itertools import pairwise
from math import inf, nan

import numpy as np
import pytest

from comparisons.budget import PARTS, Budget
from comparisons.compare import ROD, RUNS, SOLID, Run, _row, run_of
from comparisons.models import ELASTICA, TSM, certified, solve
from comparisons.models import SOLID as SOLID_MODEL
from comparisons.models.options import Options
from comparisons.referee import Verdict
from comparisons.scene import load_scene
from comparisons.show.findings import BUDGET, findings
from comparisons.show.table import Row, table_csv

KS = replace(load_scene("ks-cantilever"), load_parameters=5)
LABEL = ROD.label


def beams(element: str, elements: int) -> Run:
    return run_of(TSM, Options(element=element, elements=elements))


CHOSEN = (
    beams("timoshenko", 10), beams("timoshenko", 20), beams("exact", 1),
    run_of(SOLID_MODEL, Options(mesh=(24, 1))), run_of(ELASTICA, Options()), ROD,
)  # fmt: skip


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    responses = {run.label: certified(solve(KS, run.model, run.options), KS) for run in CHOSEN}
    return [_row(run, responses, KS) for run in CHOSEN]


def budget(**parts: float) -> Budget:
    """Difference at the third load parameter, of the parts given, of one pair of two."""
    at = np.array([0.0, 0.0, 1.0, 0.5])
    pair, other = "contact_force a->b", "contact_force c->d"
    values = {name: parts.get(name.replace(" ", "_"), 0.0) * at for name in PARTS}
    total = np.sum(list(values.values()), axis=0)
    return Budget(
        scene=KS.name,
        total={other: 0.1 * total, pair: total},
        parts={other: {name: 0.1 * value for name, value in values.items()}, pair: values},
    )


def told(rows: list[Row], made: Budget | None = None, left_out: dict[str, str] | None = None) -> list[str]:
    return findings(KS, rows, LABEL, made, left_out or {})


def sentence(begin: str, found: list[str]) -> str:
    [one] = [words for words in found if words.startswith(begin)]
    return one


def changed(rows: list[Row], number: int, **fields: object) -> list[Row]:
    """Return rows of which one has another response."""
    other = replace(rows[number], response=replace(rows[number].response, **fields))
    return [*rows[:number], other, *rows[number + 1 :]]


def with_error(rows: list[Row], number: int, **errors: float) -> list[Row]:
    """Return rows of which one has other errors."""
    row = rows[number]
    assert row.errors is not None
    path = {**row.errors["path"], **errors}
    return [*rows[:number], replace(row, errors={**row.errors, "path": path}), *rows[number + 1 :]]


def test_what_was_compared(rows: list[Row]) -> None:
    first = told(rows)[0]
    assert first.startswith(
        "5 runs of TSM, solid and elastica are compared with the exact rod on ks-cantilever at 5 load parameters, up to 1."
    )
    assert told([rows[0], rows[-1]])[0].startswith("1 run of TSM is compared with the exact rod")
    short = [replace(row, response=replace(row.response, load_parameter=KS_HALF)) for row in rows]
    assert "load parameters, up to 0.4." in told(short)[0]


KS_HALF = np.array([0.2, 0.4])


def test_how_far_a_type_of_elements_is_off_and_why(rows: list[Row]) -> None:
    """The error and the quantity of every resolution, the measured order, and the largest part that theory allows."""
    made = with_error(with_error(rows, 0, moment=0.016), 1, moment=0.004, force=0.001)
    assert sentence("TSM timoshenko", told(made)) == (
        "TSM timoshenko is off by at most 1.6 % (support moment) with 10 elements and 0.4 % with 20 elements; the error falls with "
        "the power 2.0 of the length of the elements. Theory expects most of it from this cause: second order of the element."
    )
    other = with_error(made, 1, moment=0.0001, force=0.002)
    assert "and 0.2 % (contact force) with 20 elements; the error falls with the power 3.0" in " ".join(
        told(other)
    )
    growing = with_error(made, 1, tip=0.5)
    assert "the error falls" not in " ".join(told(growing))
    alone = [replace(row, cause="") for row in made]
    assert "Theory expects" not in " ".join(told(alone))


def test_the_measured_order_is_that_of_the_element(rows: list[Row]) -> None:
    words = sentence("TSM timoshenko", told(rows))
    assert "the power 2.0 of" in words or "the power 1.9 of" in words, words


def test_an_answer_that_agrees_says_so(rows: list[Row]) -> None:
    assert sentence("TSM exact", told(rows)).startswith("TSM exact agrees with the exact rod to ")
    assert sentence("TSM exact", told(with_error(rows, 2, force=1e-3))).startswith(
        "TSM exact is off by at most 0.1 % (contact force) with 1 element. Theory expects most of it from this cause: accuracy"
    )


def test_the_difference_of_beams_and_solid_is_that_of_the_budget(rows: list[Row]) -> None:
    found = told(rows, budget(material_law=0.003, solid_mesh=-0.0005, penalty=0.00001))
    assert sentence("In the error budget", found) == (
        "In the error budget, beams and solid differ most in the contact force a->b at load parameter 0.75: by 0.25 %, made of 0.3 % "
        "material law and -0.05 % solid mesh."
    )
    assert "Theory" not in sentence("The solid", found)
    without = sentence("The solid", told(rows))
    assert (
        "Theory expects most of it from this cause: a bent strip, softer" in without
        or "cause: shear" in without
    ), without
    assert not any(words.startswith("In the error budget") for words in told(rows))
    law = sentence("In the error budget", told(rows, budget(load_steps=0.5)))
    assert law.endswith("by 50 %, made of 50 % load steps.")
    small = sentence("In the error budget", told(rows, budget(solid_mesh=1e-11)))
    assert small.startswith("In the error budget, beams and solid agree to "), small
    given = budget(solid_mesh=0.01)
    pair = "contact_force a->b"
    bent = replace(
        given, total={"clamp_moment": given.total[pair]}, parts={"clamp_moment": given.parts[pair]}
    )
    assert "differ most in the clamp moment" in sentence("In the error budget", told(rows, bent))


def test_the_elastica_has_neither_stretch_nor_shear(rows: list[Row]) -> None:
    assert sentence("The elastica is off", told(rows)).endswith("from this cause: stretch and shear.")


def test_an_open_contact_that_the_rod_has_closed(rows: list[Row]) -> None:
    words = "solid and the exact rod disagree on whether a contact is closed."
    assert words not in told(rows)
    assert words in told(with_error(rows, 3, arc=inf))
    assert sentence("The solid", told(with_error(rows, 3, arc=inf))) == sentence("The solid", told(rows))


def test_a_run_that_stopped(rows: list[Row]) -> None:
    assert not any("did not complete" in words for words in told(rows))
    stopped = changed(
        rows, 1, completed=False, status="CUTBACK_FLOOR", message="no step", load_parameter=KS_HALF
    )
    assert (
        "TSM timoshenko, 20 elements did not complete (CUTBACK_FLOOR: no step); its errors are those up to load parameter 0.4."
    ) in told(stopped)
    nothing = with_error(rows, 1, force=nan, arc=nan, moment=nan, tip=nan)
    assert "20 elements" not in sentence("TSM timoshenko", told(nothing))


def test_what_was_not_stated_and_by_whom(rows: list[Row]) -> None:
    assert not any(words.startswith(("Not stated", "There is no error budget")) for words in told(rows))
    found = told(
        rows,
        left_out={"elastica": "two pins", "mine": "two pins", "solid Q2": "no height", BUDGET: "no solid"},
    )
    assert "Not stated by elastica and mine: two pins." in found
    assert "Not stated by solid Q2: no height." in found
    assert "There is no error budget: no solid." in found


def test_stability(rows: list[Row]) -> None:
    assert sentence("Stability", told(rows)) == (
        "Stability is not stated by TSM timoshenko, elastica and exact rod."
    )
    stated = [replace(row, response=replace(row.response, index=np.zeros(5, dtype=int))) for row in rows]
    assert not any(words.startswith(("Stability", "Unstable")) for words in told(stated))
    assert "Unstable equilibria are on the path of TSM exact." in told(
        changed(stated, 2, index=np.array([0, 0, 1, 0, 0]))
    )


def test_stability_that_is_judged_in_part_is_said_to_be_so(rows: list[Row]) -> None:
    """With friction in closed contacts the index is -1; where no contact is closed, the state is judged."""
    stated = [replace(row, response=replace(row.response, index=np.zeros(5, dtype=int))) for row in rows]
    part = changed(stated, 2, index=np.array([0, -1, -1, -1, 0]))
    assert "Stability is stated at a part of the load parameters by TSM exact." in told(part)
    cells = [row["stable"] for row in csv.DictReader(table_csv(part).splitlines())]
    assert cells == ["in part" if n == 2 else "yes" for n in range(len(part))]


def test_certificates(rows: list[Row]) -> None:
    assert told(rows)[-1] == "The referee certified every answer."
    certificate = rows[0].response.certificate
    assert certificate is not None
    refused = replace(certificate, verdict=Verdict.UNSTABLE, reason="index 1")
    silent = replace(certificate, verdict=Verdict.NOT_JUDGED, reason="no search")
    found = changed(
        changed(changed(rows, 0, certificate=refused), 1, certificate=silent), 2, certificate=None
    )
    assert told(found)[-1] == (
        "The referee certified 3 of 6 answers; TSM timoshenko, 10 elements was refused (index 1); TSM timoshenko, 20 elements was not "
        "judged (no search); TSM exact, 1 element was not judged."
    )


def test_every_run_of_a_comparison_has_a_family() -> None:
    """The sentences group neighbours, so runs of a family must follow each other."""
    families = [TSM.family(KS, run.options) for run in RUNS if run.model == TSM.name]
    assert len([a for a, b in pairwise(families) if a != b]) == len(set(families)) - 1
    assert SOLID in RUNS
