"""Material force: zero of frictionless answers, a model's error of direction, and every seeded fault of a contact."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.answer.errors import difference

# the coefficient of friction that a clamp shows is in no answer
from comparisons.answer.material import frictions_found, material_forces
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import LoadSpec, Scene, SupportSpec, load_scene

KS = replace(load_scene("ks-cantilever"), load_parameters=10)
CANTILEVER, CLAMP, PAIR = "cantilever", "cantilever.start", "pin->cantilever"
EXACT = Options(element="exact")


@cache
def answer(model: str, options: Options | None = None) -> Response:
    response = solve(KS, model, options)
    assert response.completed, response.message
    return response


def friction(response: Response, scene: Scene = KS) -> float:
    """Largest sum of tangential forces over the force of the contact, which the material force is at its clamp."""
    none = replace(
        response, material_force={name: 0.0 * force for name, force in response.material_force.items()}
    )
    return difference(response, none, scene, "friction")


def test_the_exact_answers_have_no_friction(stated):
    for name, given in {"rod": ("rod",), "elastica": ("elastica",), "exact": ("tsm", EXACT)}.items():
        stated(f"friction.{name}", friction(answer(*given)), bound=True)


def test_the_friction_of_the_elements(stated):
    stated("friction.mixed", friction(answer("tsm", Options(element="mixed", elements=10))))
    for elements in (10, 20, 50):
        paper = answer("tsm", Options(element="timoshenko", elements=elements))
        stated(f"friction.paper-{elements}", friction(paper))


@pytest.mark.slow_at("mesh1", "mesh2")
@pytest.mark.parametrize("mesh", [(25, 1), (50, 2), (100, 4)])
def test_the_friction_of_the_solid_by_its_j_integral(mesh, stated):
    solid = answer("solid", Options(mesh=mesh))
    stated(f"friction.solid-{mesh[0]}x{mesh[1]}", friction(solid))
    if mesh == (50, 2):
        # the rod's formula carries the rod's material law: at the last load parameter it has the error of the law
        rods = replace(solid, material_force=material_forces(solid, KS))
        last = rods.material_force[CANTILEVER][-1] / rods.contacts[PAIR].force[-1]
        stated("friction.solid-by-rod", abs(last))


@pytest.mark.parametrize("clamp", ["start", "end"])
def test_a_naturally_curved_beam_has_no_friction(clamp):
    """Its H has the part of the natural curvature: without it the friction is more than one percent."""
    beam = replace(KS.beams[0], turn=0.8)
    if clamp == "end":
        beam = replace(beam, start=beam.end, end=beam.start, turn=-0.8, clamped=("end",))
    pin = replace(KS.pins[0], start=beam.place(0.9 if clamp == "start" else 0.1), displacement=(-0.3, 0.4))
    contact = replace(KS.contacts[0], side="right" if clamp == "start" else "left")
    scene = replace(KS, beams=(beam,), pins=(pin,), contacts=(contact,))
    response = solve(scene, "tsm", EXACT)
    assert friction(response, scene) <= 1e-10
    (support,) = response.supports.values()
    assert abs(beam.curvature * support.moment[-1]) > 0.01 * response.contacts[PAIR].force[-1]


OTHERS = {
    "tip load": {"loads": (LoadSpec(beam=CANTILEVER, end="end", force=(0.0, 1e-4)),)},
    "second support": {"supports": (SupportSpec(beam=CANTILEVER, end="end", kind="roller", free="x"),)},
    "no contact": {"pins": (), "contacts": (), "loads": (LoadSpec(beam=CANTILEVER, end="end", moment=1e-4),)},
}


@pytest.mark.parametrize("kind", [*OTHERS, "own end touches"])
def test_where_there_is_no_material_force(kind):
    scene = load_scene("double-beam") if kind == "own end touches" else replace(KS, **OTHERS[kind])
    few = solve(replace(scene, load_parameters=2), "tsm", Options(elements=4))
    assert set(few.material_force) == ({"lower"} if kind == "own end touches" else set())


@pytest.mark.slow_at("axis-0.1", "axis-0.5", "face-0.1", "face-0.3", "face-0.5")
@pytest.mark.parametrize("friction", [0.1, 0.3, 0.5])
@pytest.mark.parametrize("surface", ["axis", "face"])
def test_the_clamp_shows_the_friction_of_the_contact(friction, surface):
    (pin,), (contact,) = KS.pins, KS.contacts
    pin = replace(pin, start=(1.0, 0.0 if surface == "axis" else -0.01))
    scene = replace(KS, pins=(pin,), contacts=(replace(contact, surface=surface, friction=friction),))
    response = solve(scene, "tsm", EXACT)
    found, history = frictions_found(response, scene)[CANTILEVER], response.contacts[PAIR].friction
    assert history is not None
    slips = history.slip != 0
    assert np.count_nonzero(slips) >= 8
    assert found[slips] == pytest.approx(friction * history.slip[slips], abs=1e-10)
    assert np.all(np.abs(found[~slips]) < friction)
