"""Material force: zero of frictionless answers, a model's error of direction, and every seeded fault of a contact."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

from comparisons.errors import difference
from comparisons.models import certified, solve
from comparisons.models.options import ModelError, Options
from comparisons.response import Response, SupportHistory
from comparisons.response.from_json import restated
from comparisons.response.material import (
    clamped,
    friction_coefficient,
    frictions,
    frictions_found,
    material_forces,
)
from comparisons.response.to_json import as_json
from comparisons.scene import BeamSpec, LoadSpec, SupportSpec, load_scene
from tests.comparisons.drawn_cantilevers import BEAM, drawn_cantilevers
from tests.comparisons.shooting import Array, Shot, rod_with_direction, shoot, tangent

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


def test_linear_elements_of_the_solid_lock_and_rub() -> None:
    coarse = replace(KS, beams=(replace(KS.beams[0], solid_element="Q1"),))
    assert largest(solve(coarse, "solid", Options(mesh=(50, 2)))) > 0.1


def exact_frictions(count: int) -> tuple[float, int]:
    """Largest friction of exact elements over drawn cantilevers, and the number of closed load parameters."""
    found = []
    for scene in drawn_cantilevers(count):
        response = solve(scene, "tsm", Options(element="exact"))
        if len(response.load_parameter):
            values = frictions(response, scene)[BEAM]
            found.append(values[np.isfinite(values)])
    every = np.abs(np.concatenate(found))
    return float(every.max()), len(every)


@pytest.mark.slow
def test_exact_elements_have_no_friction_at_drawn_cantilevers() -> None:
    worst, count = exact_frictions(20)
    assert count > 150
    assert worst <= 1e-10


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


@pytest.mark.slow
def test_exact_elements_have_no_friction_at_many_drawn_cantilevers() -> None:
    worst, count = exact_frictions(150)
    assert count > 1200
    assert worst <= 1e-10


@dataclass(frozen=True)
class Fault:
    """A wrong contact: the tangent that its force is normal to, and the distance of the force from the point of the axis."""

    direction: Callable[[Shot], Array]
    lever: Callable[[Shot], float] = lambda _: 0.0


def unit(angle: float) -> Array:
    return np.array([math.cos(angle), math.sin(angle)])


def at_end_of_last_step(_: Shot) -> Array:
    """Tangent at the load parameter before: the projection is frozen during the step."""
    force = solve(KS, "rod").contacts[PAIR].vector
    assert force is not None
    return np.array([force[-2, 1], -force[-2, 0]])


def interpolated(shot: Shot) -> Array:
    """Linear interpolation between the rotations of the element's ends."""
    a, b = shot.node(ELEMENTS, 0), shot.node(ELEMENTS, 1)
    part = (shot.arc - a) / (b - a)
    return unit((1.0 - part) * shot.rotation(a) + part * shot.rotation(b))


FAULTS = {
    "chord of the element": Fault(
        lambda shot: shot.position(shot.node(ELEMENTS, 1)) - shot.position(shot.node(ELEMENTS, 0))
    ),
    "chord of the beam": Fault(lambda shot: shot.position(shot.beam.length)),
    "loaded side of the kink": Fault(lambda shot: shot.loaded),
    "free side of the kink": Fault(lambda shot: shot.tail),
    "kink with the wrong sign": Fault(lambda shot: 2.0 * shot.loaded - shot.tail),
    "projection of the last step": Fault(at_end_of_last_step),
    "mean of the end normals": Fault(
        lambda shot: unit(
            (shot.rotation(shot.node(ELEMENTS, 0)) + shot.rotation(shot.node(ELEMENTS, 1))) / 2.0
        )
    ),
    "rotations interpolated": Fault(interpolated),
    "undeformed axis": Fault(lambda _: np.array([1.0, 0.0])),
    "normal at the nearest node": Fault(
        lambda shot: unit(
            shot.rotation(round(shot.arc * ELEMENTS / shot.beam.length) * shot.beam.length / ELEMENTS)
        )
    ),
    "foot of the normal off by a hundredth": Fault(lambda shot: unit(shot.rotation(shot.arc - 0.01))),
    "line of action beside the contact": Fault(lambda shot: shot.mean, lambda shot: 0.01 * shot.beam.length),
}
"""Seeded faults of a contact, by what the force is taken normal to or where it acts."""


@pytest.fixture(scope="module")
def true_shot() -> Shot:
    """The rod's answer at the last load parameter, as a first guess."""
    rod = solve(KS, "rod")
    support = rod.supports[CLAMP]
    return shoot(
        KS.beams[0],
        -support.force[-1],
        -float(support.moment[-1]),
        float(rod.contacts[PAIR].arc_position[-1]),
    )


def answered(shot: Shot) -> Response:
    """The rod's response with the reactions and the contact of another equilibrium at the last load parameter."""
    rod = solve(KS, "rod")
    support, contact = rod.supports[CLAMP], rod.contacts[PAIR]
    size = np.append(contact.force[:-1], np.hypot(*shot.force))
    changed = replace(
        rod,
        supports={
            CLAMP: SupportHistory(
                force=np.vstack([support.force[:-1], -shot.force]),
                moment=np.append(support.moment[:-1], -shot.moment),
            )
        },
        contacts={PAIR: replace(contact, force=size)},
    )
    return replace(changed, material_force=material_forces(changed, KS))


def solved(fault: Fault, start: Shot) -> tuple[Shot, float]:
    """The equilibrium with a fault, and its friction."""
    touched = np.array(KS.pin("pin").position(1.0))
    shot = rod_with_direction(KS.beams[0], touched, start, fault.direction, fault.lever)
    return shot, float(frictions(answered(shot), KS)[CANTILEVER][-1])


def test_the_true_direction_has_no_friction(true_shot: Shot) -> None:
    """The mean of the tangents on both sides of the kink, with the exact rod's force."""
    shot, friction = solved(Fault(lambda shot: shot.mean), true_shot)
    assert abs(friction) < 1e-10
    assert np.hypot(*shot.force) == pytest.approx(solve(KS, "rod").contacts[PAIR].force[-1], rel=1e-9)


@pytest.mark.slow_at("projection of the last step")
@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_of_a_contact_is_a_material_force(name: str, true_shot: Shot) -> None:
    """H is what the fault makes it, a tangential force or the moment of a lever, and a million times what the true contact has."""
    shot, friction = solved(FAULTS[name], true_shot)
    size, moment = np.hypot(*shot.force), shot.line(shot.arc)[3]
    made = (shot.force @ shot.mean + moment**2 / (2.0 * shot.beam.EI)) / size
    assert friction == pytest.approx(made, rel=1e-6)
    assert abs(friction) > 1e-4


@pytest.mark.parametrize("coefficient", [-0.5, -0.1, 0.0, 0.05, 0.3, 2.0])
@pytest.mark.parametrize("lever", [0.0, 0.05])
def test_the_coefficient_of_friction_found(coefficient: float, lever: float) -> None:
    """From H at the clamp of a rod that stretches and shears strongly, under forces at every angle, with the couple of a face."""
    beam = BeamSpec(
        name=BEAM,
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


def test_two_beams_joined_have_no_material_force() -> None:
    tail = replace(KS.beams[0], name="tail", start=KS.beams[0].end, end=(2.0, 0.0), clamped=())
    assert not clamped(replace(KS, beams=(*KS.beams, tail)))


def test_the_quantity_in_files() -> None:
    response = beams("mixed")
    again = restated(json.loads(as_json(response)))
    assert np.array_equal(again.material_force[CANTILEVER], response.material_force[CANTILEVER])
    without = {
        name: value for name, value in json.loads(as_json(response)).items() if name != "material_force"
    }
    assert restated(without).material_force == {}


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
