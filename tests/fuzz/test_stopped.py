"""Scenes that were given up, though they have stable equilibria to the end."""

from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.answer import Response
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.scene import BeamSpec, HingeSpec, LoadSpec, Scene, SupportSpec, load_scene
from tests.laws.transform import Change

EXACT = Options(element="exact")


def stopped(name: str, count: int | None = None) -> Scene:
    found = load_scene(str(Path(__file__).parent / "stopped" / f"{name}.toml"))
    return replace(found, load_parameters=count or found.load_parameters)


def completed(scene: Scene, options: Options = EXACT) -> Response:
    answer = solve(scene, "tsm", options)
    assert answer.completed, answer.message
    return answer


@pytest.mark.slow
@pytest.mark.parametrize("name", ["taut", "taut-over-a-pin"])
def test_a_slender_beam_under_tension(name: str) -> None:
    """The round-off of a force of 1e6 EI/L^2 exceeds Newton's tolerance, and boundary layers take more than 96 nodes."""
    many = completed(stopped(name, 1), replace(EXACT, elements=8))
    for count in (1, 5):
        answer = completed(stopped(name, count), replace(EXACT, elements=1))
        for node, support in many.supports.items():
            assert answer.supports[node].force[-1] == pytest.approx(support.force[-1], rel=1e-8)


@pytest.mark.slow
def test_a_contact_passes_a_node_where_neither_element_has_an_equilibrium() -> None:
    """Friction on a sharply bent beam: the tangents of two elements differ at their node, and the iteration went back and forth."""
    scene = stopped("back-and-forth")
    answer, exact = completed(scene, Options(element="mixed", elements=8)), completed(scene)
    for pair, contact in exact.contacts.items():
        assert answer.contacts[pair].force == pytest.approx(contact.force, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 5, 2, 20])
def test_an_answer_does_not_hang_on_the_number_of_load_parameters(count: int) -> None:
    """A node passes beside a beam's end on a bent way, whose chord cuts the beam; a contact opens by the force of a beam that is 4e7 times softer than another."""
    for name in ("passes-by", "passes-by-under-loads", "soft-beside-stiff"):
        answer, other = completed(stopped(name, count)), completed(stopped(name, 12))
        found = certify(answer, stopped(name, count))
        assert found.certified, found.line()
        for pair, contact in answer.contacts.items():
            assert other.contacts[pair].force[-1] == pytest.approx(contact.force[-1], rel=1e-9)


@pytest.mark.parametrize("element", ["exact", "mixed"])
def test_a_stiff_hinge_that_turns_with_its_beams(element: str) -> None:
    """Its moment is the difference of two rotations by 1 rad, whose round-off times the stiffness exceeds Newton's tolerance."""
    size = {"width": 0.02, "height": 0.02, "youngs_modulus": 1e9, "poissons_ratio": 0.3}
    scene = Scene(
        name="stiff-hinge", load_parameters=4, hinges=(HingeSpec(beam="b", end="start", stiffness=1e11),),
        beams=tuple(BeamSpec(name=name, start=(x, 0.0), end=(x + 1.0, 0.0), **size) for name, x in (("a", 0.0), ("b", 1.0))),
        supports=(SupportSpec(beam="a", end="start", kind="clamped", displacement=(0.0, 0.0), rotation=1.0),),
        loads=(LoadSpec(beam="b", end="end", force=(0.0, 4.0)),),
    )  # fmt: skip
    for unit in (1.0, 1e3):
        answer = completed(Change(length=unit).scene(scene), Options(element=element))
        assert answer.supports["a.start"].moment[-1] == pytest.approx(-3.2477407512 * unit, rel=1e-7)
