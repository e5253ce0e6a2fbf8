"""Scenes that were given up, though they have stable equilibria to the end."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.scene import BeamSpec, HingeSpec, LoadSpec, Scene, SupportSpec, load_scene

STOPPED = Path(__file__).parent / "stopped"


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 5])
@pytest.mark.parametrize("name", ["taut", "taut-over-a-pin"])
def test_a_slender_beam_under_tension(name: str, count: int) -> None:
    """The round-off of a force of 1e6 EI/L^2 exceeds Newton's tolerance, and boundary layers take more than 96 nodes."""
    scene = replace(load_scene(str(STOPPED / f"{name}.toml")), load_parameters=count)
    answer = solve(scene, "tsm", Options(element="exact", elements=1))
    assert answer.completed, answer.message
    many = solve(scene, "tsm", Options(element="exact", elements=8))
    for node, support in many.supports.items():
        assert answer.supports[node].force[-1] == pytest.approx(support.force[-1], rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [8])
def test_a_contact_passes_a_node_where_neither_element_has_an_equilibrium(elements: int) -> None:
    """Friction on a sharply bent beam: the tangents of two elements differ at their node, and the iteration went back and forth."""
    scene = load_scene(str(STOPPED / "back-and-forth.toml"))
    answer, exact = (
        solve(scene, "tsm", Options(element=element, elements=number))
        for element, number in (("mixed", elements), ("exact", 1))
    )
    assert answer.completed, answer.message
    for pair, contact in exact.contacts.items():
        assert answer.contacts[pair].force == pytest.approx(contact.force, rel=0.05)


@pytest.mark.parametrize(
    "count", [1, 5, pytest.param(2, marks=pytest.mark.slow), pytest.param(20, marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("name", ["passes-by", "passes-by-under-loads", "soft-beside-stiff"])
def test_an_answer_does_not_hang_on_the_number_of_load_parameters(name: str, count: int) -> None:
    """A node passes beside a beam's end on a bent way, whose chord cuts the beam; a contact opens by the force of a beam that is 4e7 times softer than another."""
    scene = load_scene(str(STOPPED / f"{name}.toml"))
    answer, other = (
        solve(replace(scene, load_parameters=number), "tsm", Options(element="exact"))
        for number in (count, 12)
    )
    assert answer.completed, answer.message
    found = certify(answer, replace(scene, load_parameters=count))
    assert found.certified, found.line()
    for pair, contact in answer.contacts.items():
        assert other.contacts[pair].force[-1] == pytest.approx(contact.force[-1], rel=1e-9)


@pytest.mark.parametrize("unit", [1.0, 1e3])
@pytest.mark.parametrize("element", ["exact", "mixed"])
def test_a_stiff_hinge_that_turns_with_its_beams(element: str, unit: float) -> None:
    """Its moment is the difference of two rotations by 1 rad, whose round-off times the stiffness exceeds Newton's tolerance."""
    beams = [
        BeamSpec(name=name, start=(x * unit, 0.0), end=((x + 1.0) * unit, 0.0), width=0.02 * unit, height=0.02 * unit, youngs_modulus=1e9 / unit**2, poissons_ratio=0.3)
        for name, x in (("a", 0.0), ("b", 1.0))
    ]  # fmt: skip
    scene = Scene(
        name="stiff-hinge", load_parameters=4, beams=tuple(beams), pins=(), contacts=(),
        hinges=(HingeSpec(beam="b", end="start", stiffness=1e11 * unit),),
        supports=(SupportSpec(beam="a", end="start", kind="clamped", displacement=(0.0, 0.0), rotation=1.0),),
        loads=(LoadSpec(beam="b", end="end", force=(0.0, 4.0)),),
    )  # fmt: skip
    answer = solve(scene, "tsm", Options(element=element))
    assert answer.completed, answer.message
    assert answer.supports["a.start"].moment[-1] == pytest.approx(-3.2477407512 * unit, rel=1e-7)
