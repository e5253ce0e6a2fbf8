"""Material force: zero of frictionless answers, a model's error of direction, and every seeded fault of a contact."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from comparisons.errors import difference
from comparisons.models import certified, solve
from comparisons.models.options import ModelError, Options
from comparisons.response import Response
from comparisons.response.material import (
    clamped,
    friction_coefficient,
    frictions,
    frictions_found,
    material_forces,
)
from comparisons.scene import BeamSpec, LoadSpec, SupportSpec, load_scene

KS = replace(load_scene("ks-cantilever"), load_parameters=10)
CANTILEVER, CLAMP, PAIR = "cantilever", "cantilever.start", "pin->cantilever"
ELEMENTS = 10


def largest(response: Response, scene: object = KS, beam: str = CANTILEVER) -> float:
    """Largest friction over the load parameters, which the response completed."""
    assert response.completed, response.message
    return float(np.nanmax(np.abs(frictions(response, scene)[beam])))  # type: ignore[arg-type]


def beams(element: str, elements: int = ELEMENTS) -> Response:
    return solve(KS, "tsm", Options(element=element, elements=elements))


def test_the_exact_answers_have_no_friction(stated: Callable[..., None]) -> None:
    stated("friction.rod", largest(solve(KS, "rod")), bound=True)
    stated("friction.elastica", largest(solve(KS, "elastica")), bound=True)
    stated("friction.exact", largest(solve(KS, "tsm", Options(element="exact"))), bound=True)


def test_the_friction_of_the_elements(stated: Callable[..., None]) -> None:
    stated("friction.mixed", largest(beams("mixed")))
    for elements in (10, 20, 50):
        stated(f"friction.paper-{elements}", largest(beams("timoshenko", elements)))


@pytest.mark.slow_at("mesh1", "mesh2")
@pytest.mark.parametrize("mesh", [(25, 1), (50, 2), (100, 4)])
def test_the_friction_of_the_solid_by_its_j_integral(
    mesh: tuple[int, int], stated: Callable[..., None]
) -> None:
    stated(f"friction.solid-{mesh[0]}x{mesh[1]}", largest(solve(KS, "solid", Options(mesh=mesh))))


def test_the_rods_formula_is_not_the_solids(stated: Callable[..., None]) -> None:
    """It carries the rod's material law: at the last load parameter it has the error of the law."""
    solid = solve(KS, "solid", Options(mesh=(50, 2)))
    rods = replace(solid, material_force=material_forces(solid, KS))
    stated("friction.solid-by-rod", abs(frictions(rods, KS)[CANTILEVER][-1]))


@pytest.mark.parametrize("clamp", ["start", "end"])
def test_a_naturally_curved_beam_has_no_friction(clamp: str) -> None:
    """Its H has the part of the natural curvature: without it the friction is more than one percent."""
    beam = replace(KS.beams[0], turn=0.8 if clamp == "start" else -0.8, clamped=("start",))
    pin = replace(KS.pins[0], start=beam.place(0.9), displacement=(-0.3, 0.4))
    contact = KS.contacts[0]
    if clamp == "end":
        beam = replace(beam, start=beam.end, end=beam.start, clamped=("end",), turn=0.8)
        contact = replace(contact, side="left")
    scene = replace(KS, beams=(beam,), pins=(pin,), contacts=(contact,))
    response = solve(scene, "tsm", Options(element="exact"))
    assert largest(response, scene) <= 1e-10
    (support,) = response.supports.values()
    assert abs(beam.curvature * support.moment[-1]) > 0.01 * response.contacts[PAIR].force[-1]


def unit(angle: float) -> NDArray[np.float64]:
    return np.array([math.cos(angle), math.sin(angle)])


def tangent(beam: BeamSpec, n: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Return ``r' = (1 + N/EA) d1 + (Q/GA) d2``."""
    d1, d2 = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    return np.asarray((1.0 + n @ d1 / beam.EA) * d1 + n @ d2 / beam.GA * d2)


@pytest.mark.parametrize("coefficient", [-0.5, -0.1, 0.0, 0.05, 0.3, 2.0])
@pytest.mark.parametrize("lever", [0.0, 0.05])
def test_the_coefficient_of_friction_found(coefficient: float, lever: float) -> None:
    """From H at the clamp of a rod that stretches and shears strongly, under forces at every angle, with the couple of a face."""
    beam = BeamSpec(
        name="b",
        start=(0.0, 0.0),
        end=(1.0, 0.0),
        youngs_modulus=1.0,
        poissons_ratio=0.3,
        width=0.1,
        height=0.1,
    )
    for size in 10.0 ** np.arange(-6.0, 0.0) * 0.1 * beam.EA:
        angle = 0.3
        for _ in range(200):
            force = size * unit(math.pi / 2.0 + angle - math.atan(coefficient))
            g = (tangent(beam, force, 0.3) + unit(0.3)) / 2.0
            angle = math.atan2(g[1], g[0])
        tangential = force @ g / np.hypot(*g)
        assert tangential / math.sqrt(size**2 - tangential**2) == pytest.approx(coefficient, abs=1e-12)
        moment, N, Q = tangential * lever, force @ unit(0.3), force @ unit(0.3 + math.pi / 2.0)
        H = moment**2 / 2 / beam.EI + N + N**2 / 2 / beam.EA + Q**2 / 2 / beam.GA
        found = friction_coefficient(np.array([size, 0.0]), np.array([H, 0.0]), beam, lever=lever)
        assert found[0] == pytest.approx(coefficient, rel=1e-9, abs=1e-9)
        assert np.isnan(found[1])


@pytest.mark.parametrize("kind", ["tip load", "second support", "no contact", "own end touches"])
def test_where_there_is_no_material_force(kind: str) -> None:
    if kind == "own end touches":
        assert set(clamped(load_scene("double-beam"))) == {"lower"}
        return
    other = {
        "tip load": {"loads": (LoadSpec(beam=CANTILEVER, end="end", force=(0.0, 1e-4)),)},
        "second support": {"supports": (SupportSpec(beam=CANTILEVER, end="end", kind="roller", free="x"),)},
        "no contact": {
            "pins": (),
            "contacts": (),
            "loads": (LoadSpec(beam=CANTILEVER, end="end", moment=1e-4),),
        },
    }[kind]
    scene = replace(KS, **other)  # type: ignore[arg-type]
    assert clamped(KS)
    assert not clamped(scene)
    assert not solve(scene, "tsm", Options(elements=4)).material_force


def test_the_error_of_the_friction() -> None:
    """Against the exact rod it is the friction; a response without a material force has an infinite one."""
    rod, response = solve(KS, "rod"), beams("timoshenko")
    assert difference(response, rod, KS, "friction") == pytest.approx(largest(response), rel=1e-9)
    assert difference(replace(response, material_force={}), rod, KS, "friction") == np.inf
    assert difference(response, replace(rod, material_force={}), KS, "friction") == np.inf
    assert difference(response, response, KS, "friction") == 0.0


def test_a_bound_on_a_friction_that_is_not_there_is_refused() -> None:
    from comparisons.accuracy import solve_to
    from comparisons.claims.gate import gate

    scene = load_scene("two-pins")
    with pytest.raises(ModelError, match="one clamp alone"):
        gate(scene, "tsm", Options(), {"friction": 1e-3})
    with pytest.raises(ModelError, match="one clamp alone"):
        solve_to(scene, 1e-3, "friction")
    assert gate(KS, "tsm", Options(elements=10), {"friction": 1e-5}).held
    assert not gate(KS, "tsm", Options(elements=10), {"friction": 1e-6}).held


def test_a_certificate_does_not_replace_the_material_force() -> None:
    """The paper's element is certified within a coarse allowance, with a friction of two hundredths."""
    response = certified(beams("timoshenko"), KS)
    assert response.certificate is not None
    assert response.certificate.certified
    assert largest(response) > 1e-2


@pytest.mark.slow_at("axis-0.1", "axis-0.3", "axis-0.5", "face-0.1", "face-0.5")
@pytest.mark.parametrize("friction", [0.1, 0.3, 0.5])
@pytest.mark.parametrize("surface", ["axis", "face"])
def test_the_clamp_shows_the_friction_of_the_contact(friction: float, surface: str) -> None:
    (pin,), (contact,) = KS.pins, KS.contacts
    below = 0.0 if surface == "axis" else -0.01
    scene = replace(
        KS,
        pins=(replace(pin, start=(1.0, below)),),
        contacts=(replace(contact, surface=surface, friction=friction),),
    )
    response = solve(scene, "tsm", Options(element="exact"))
    found, history = frictions_found(response, scene)[CANTILEVER], response.contacts[PAIR].friction
    assert history is not None
    slips = history.slip != 0
    assert np.count_nonzero(slips) >= 8
    assert found[slips] == pytest.approx(friction * history.slip[slips], abs=1e-10)
    assert np.all(np.abs(found[~slips]) < friction)
