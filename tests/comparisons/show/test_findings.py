"""The findings of a comparison: every sentence changes with its data."""

import csv
from dataclasses import replace
from math import inf, nan

import numpy as np
import pytest

from comparisons.budget import PARTS, Budget
from comparisons.compare import ROD, Run, _row, run_of
from comparisons.models import ELASTICA, SOLID, TSM, certified, solve
from comparisons.models.options import Options
from comparisons.referee import Verdict
from comparisons.scene import load_scene
from comparisons.show.findings import BUDGET, findings  # sentences on data that no scene gives at will
from comparisons.show.table import Row, table_csv

KS = replace(load_scene("ks-cantilever"), load_parameters=5)
HALF = {"load_parameter": np.array([0.2, 0.4])}
STABLE = {"index": np.zeros(5, dtype=int)}


def beams(element: str, elements: int) -> Run:
    return run_of(TSM, Options(element=element, elements=elements))


CHOSEN = (
    beams("timoshenko", 10), beams("timoshenko", 20), beams("exact", 1),
    run_of(SOLID, Options(mesh=(24, 1))), run_of(ELASTICA, Options()), ROD,
)  # fmt: skip


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    responses = {run.label: certified(solve(KS, run.model, run.options), KS) for run in CHOSEN}
    return [_row(run, responses, KS) for run in CHOSEN]


def budget(name: str = "contact_force a->b", **parts: float) -> Budget:
    """Difference at the third load parameter, of the parts given, of one pair of two."""
    at = np.array([0.0, 0.0, 1.0, 0.5])
    values = {part: parts.get(part.replace(" ", "_"), 0.0) * at for part in PARTS}
    small = {part: 0.1 * value for part, value in values.items()}
    both = {name: values} if "moment" in name else {"contact_force c->d": small, name: values}
    return Budget(
        scene=KS.name,
        total={one: np.sum(list(own.values()), axis=0) for one, own in both.items()},
        parts=both,
    )


def told(rows: list[Row], made: Budget | None = None, left_out: dict[str, str] | None = None) -> list[str]:
    return findings(KS, rows, ROD.label, made, left_out or {})


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
    other = replace(row, errors={**row.errors, "path": {**row.errors["path"], **errors}})
    return [*rows[:number], other, *rows[number + 1 :]]


def test_what_was_compared(rows: list[Row]) -> None:
    begin = "5 runs of TSM, solid and elastica are compared with the exact rod on ks-cantilever at 5 load parameters, up to 1."
    assert told(rows)[0].startswith(begin)
    assert told([rows[0], rows[-1]])[0].startswith("1 run of TSM is compared with the exact rod")
    short = [replace(row, response=replace(row.response, **HALF)) for row in rows]
    assert "load parameters, up to 0.4." in told(short)[0]


def test_how_far_a_type_of_elements_is_off_and_why(rows: list[Row]) -> None:
    """The error and the quantity of every resolution, the measured order, and the largest part that theory allows."""
    measured = sentence("TSM timoshenko", told(rows))
    assert "the power 2.0 of" in measured or "the power 1.9 of" in measured, measured
    made = with_error(with_error(rows, 0, moment=0.016), 1, moment=0.004, force=0.001)
    assert sentence("TSM timoshenko", told(made)) == (
        "TSM timoshenko is off by at most 1.6 % (support moment) with 10 elements and 0.4 % with 20 elements; the error falls with "
        "the power 2.0 of the length of the elements. Theory expects most of it from this cause: second order of the element."
    )
    other = sentence("TSM timoshenko", told(with_error(made, 1, moment=0.0001, force=0.002)))
    assert "and 0.2 % (contact force) with 20 elements; the error falls with the power 3.0" in other
    assert "the error falls" not in sentence("TSM timoshenko", told(with_error(made, 1, tip=0.5)))
    assert not any("Theory expects" in words for words in told([replace(row, cause="") for row in made]))
    assert sentence("TSM exact", told(rows)).startswith("TSM exact agrees with the exact rod to ")
    assert sentence("TSM exact", told(with_error(rows, 2, force=1e-3))).startswith(
        "TSM exact is off by at most 0.1 % (contact force) with 1 element. Theory expects most of it from this cause: accuracy"
    )
    assert sentence("The elastica is off", told(rows)).endswith("from this cause: stretch and shear.")


def test_the_difference_of_beams_and_solid_is_that_of_the_budget(rows: list[Row]) -> None:
    found = told(rows, budget(material_law=0.003, solid_mesh=-0.0005, penalty=0.00001))
    assert sentence("In the error budget", found) == (
        "In the error budget, beams and solid differ most in the contact force a->b at load parameter 0.75: by 0.25 %, made of 0.3 % "
        "material law and -0.05 % solid mesh."
    )
    assert "Theory" not in sentence("The solid", found)
    assert "Theory expects most of it from this cause: " in sentence("The solid", told(rows))
    assert not any(words.startswith("In the error budget") for words in told(rows))
    for made, words in (
        (budget(load_steps=0.5), "by 50 %, made of 50 % load steps."),
        (budget(solid_mesh=1e-11), "beams and solid agree to 1e-11."),
        (
            budget("clamp_moment", solid_mesh=0.01),
            "differ most in the clamp moment at load parameter 0.75: by 1 %",
        ),
    ):
        assert words in sentence("In the error budget, ", told(rows, made))


def test_what_was_not_reached_or_not_stated(rows: list[Row]) -> None:
    apart = "solid and the exact rod disagree on whether a contact is closed."
    opened = told(with_error(rows, 3, arc=inf))
    assert apart in opened
    assert sentence("The solid", opened) == sentence("The solid", told(rows))
    stopped = changed(rows, 1, completed=False, status="CUTBACK_FLOOR", message="no step", **HALF)
    assert (
        "TSM timoshenko, 20 elements did not complete (CUTBACK_FLOOR: no step); its errors are those up to load parameter 0.4."
    ) in told(stopped)
    nothing = with_error(rows, 1, force=nan, arc=nan, moment=nan, tip=nan)
    assert "20 elements" not in sentence("TSM timoshenko", told(nothing))
    left_out = {"elastica": "two pins", "mine": "two pins", "solid Q2": "no height", BUDGET: "no solid"}
    found = told(rows, left_out=left_out)
    assert {
        "Not stated by elastica and mine: two pins.", "Not stated by solid Q2: no height.", "There is no error budget: no solid.",
    } <= {*found}  # fmt: skip
    for words in (apart, "did not complete", "Not stated", "There is no error budget"):
        assert words not in " ".join(told(rows))


def test_stability_and_its_part_that_is_judged(rows: list[Row]) -> None:
    """With friction in closed contacts the index is -1; where no contact is closed, the state is judged."""
    assert "Stability is not stated by TSM timoshenko, elastica and exact rod." in told(rows)
    stated = [replace(row, response=replace(row.response, **STABLE)) for row in rows]
    assert not any(words.startswith(("Stability", "Unstable")) for words in told(stated))
    for index, words, cell in (
        ([0, 0, 1, 0, 0], "Unstable equilibria are on the path of TSM exact.", "no"),
        ([0, -1, -1, -1, 0], "Stability is stated at a part of the load parameters by TSM exact.", "in part"),
    ):
        part = changed(stated, 2, index=np.array(index))
        assert words in told(part)
        cells = [row["stable"] for row in csv.DictReader(table_csv(part).splitlines())]
        assert cells == [cell if n == 2 else "yes" for n in range(len(part))]


def test_certificates(rows: list[Row]) -> None:
    assert told(rows)[-1] == "The referee certified every answer."
    certificate = rows[0].response.certificate
    refused = replace(certificate, verdict=Verdict.UNSTABLE, reason="index 1")
    silent = replace(certificate, verdict=Verdict.NOT_JUDGED, reason="no search")
    found = rows
    for number, one in enumerate((refused, silent, None)):
        found = changed(found, number, certificate=one)
    assert told(found)[-1] == (
        "The referee certified 3 of 6 answers; TSM timoshenko, 10 elements was refused (index 1); TSM timoshenko, 20 elements was not "
        "judged (no search); TSM exact, 1 element was not judged."
    )
