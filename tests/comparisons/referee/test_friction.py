"""Contacts with Coulomb friction: true answers are certified."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.network import solve_network
from comparisons.models.options import Options
from comparisons.referee import Certificate, Verdict, certify
from comparisons.referee.basis import DEGREE
from comparisons.referee.elements import mesh_of, properties
from comparisons.referee.energy import dissipated
from comparisons.referee.equations import assemble
from comparisons.referee.friction import Grip, Hold
from comparisons.referee.history import History
from comparisons.referee.layout import lay_out
from comparisons.referee.phases import OPEN, UNKNOWN
from comparisons.response import Response
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, load_scene

PAIR = "pin->cantilever"
EXACT = Options(element="exact")


def rough(name: str, friction: float, load_parameters: int = 10) -> Scene:
    """A built-in scene with the same friction at all contacts."""
    scene = load_scene(name)
    contacts = tuple(replace(spec, friction=friction) for spec in scene.contacts)
    return replace(scene, load_parameters=load_parameters, contacts=contacts)


@cache
def answer(scene: Scene, element: str = "exact", elements: int | None = None) -> Response:
    return solve(scene, "tsm", Options(element=element, elements=elements))


def all_along(scene: Scene, response: Response) -> Certificate:
    return certify(response, scene, at=range(len(response.load_parameter)))


@pytest.mark.slow_at("0.3-ks-face")
@pytest.mark.parametrize("name", ["ks-cantilever", "ks-face"])
@pytest.mark.parametrize("friction", [0.3, *(pytest.param(mu, marks=pytest.mark.slow) for mu in (0.1, 0.5))])
def test_exact_elements_are_certified_to_round_off_all_along(name: str, friction: float) -> None:
    scene = rough(name, friction, 20)
    response = answer(scene)
    assert response.completed
    found = all_along(scene, response)
    assert found.certified, found.line()
    assert "stability not judged (friction)" in found.line()
    assert found.judged[-1].index == -1
    assert max(item.distance.largest[1] for item in found.judged if item.distance) < 1e-11
    assert max(item.residual for item in found.judged) < 1e-12
    assert set(response.contacts[PAIR].friction.slip) == {-1, 0, 1}


@pytest.mark.parametrize("name", ["ks-cantilever", pytest.param("ks-face", marks=pytest.mark.slow)])
def test_the_solid_is_certified_all_along(name: str) -> None:
    """With its events, and without them, so that the referee finds slip and stick itself."""
    scene = rough(name, 0.3, 20)
    response = solve(scene, "solid", Options(mesh=(50, 2)))
    assert [event.kind for event in response.events] == ["touch", "stick", "slip"]
    assert all_along(scene, response).certified
    response = replace(response, events=None)
    assert set(response.contacts[PAIR].friction.slip) == {-1, 0, 1}
    found = all_along(scene, response)
    assert found.certified, found.line()
    assert 1e-3 < max(item.distance.force for item in found.judged if item.distance) < 6e-3


def test_the_places_of_stick_are_the_tabulated_ones() -> None:
    """Reissner rod of the scene, mu = .3: slip ends at .6204977 and begins again at .6832873."""
    scene = rough("ks-cantilever", 0.3)
    history = History(answer(scene), scene)
    assert [phase.slip for phase in history.phases[PAIR]] == [-1, 0, 1]
    assert history.begin(PAIR, 1).load_parameter == pytest.approx(0.6204977, abs=5e-8)
    assert history.begin(PAIR, 2).load_parameter == pytest.approx(0.6832873, abs=5e-8)


def test_the_sign_of_a_slip_that_ends_at_a_corner() -> None:
    """A touch, a slip with the pin to the clamp, and one back from the corner of its path, all before the only load parameter."""
    scene = load_scene("hysteresis")
    pin = PinSpec(name="pin", path=((80.0, -2.0), (60.0, 18.0), (80.0, 20.0)))
    scene = replace(scene, load_parameters=1, pins=(pin,))
    response = answer(scene)
    history = History(response, scene)
    assert [phase.slip for phase in history.phases[PAIR]] == [OPEN, UNKNOWN, 0, 1]
    begin = history.begin(PAIR, 2)
    assert begin.load_parameter == pytest.approx(scene.pins[0].corners[0], abs=1e-12)
    assert begin.solution.layout.grips[PAIR].slip == -1
    found = certify(response, scene)
    assert found.certified, found.line()


@pytest.mark.parametrize("slip", [1, 0])
@pytest.mark.parametrize("seed", [0, 2])
def test_the_equations_are_differentiated(slip: int, seed: int) -> None:
    """Against central differences, off equilibrium, for a sharp and a round pin on a face."""
    scene = drawn_on_a_face(round_pin=bool(seed))
    hold = (
        None if slip else Hold(load_parameter=0.0, arc_position=0.7, stretch=1.02, shear=0.1, direction=0.3)
    )
    layout = lay_out(scene, 0.6, {"p->b": 0.72}, {"p->b": Grip(friction=0.4, slip=slip, hold=hold)})
    mesh = mesh_of(layout, [np.array([0.0, 0.6, 1.0]), np.array([0.0, 1.0])])
    rng = np.random.default_rng(seed)
    z, bubbles = rng.uniform(-0.3, 0.3, mesh.unknowns), np.zeros((3, DEGREE - 1))
    z[layout.touches[0].arc] = 0.72
    rods = properties(layout, mesh)
    for _ in range(30):
        bubbles = bubbles - assemble(layout, mesh, rods, z, bubbles).shift

    def gradient(change: np.ndarray) -> np.ndarray:
        inside = bubbles
        for _ in range(6):
            inside = inside - assemble(layout, mesh, rods, z + change, inside).shift
        return assemble(layout, mesh, rods, z + change, inside).gradient

    system, step = assemble(layout, mesh, rods, z, bubbles), 1e-5
    by = np.array([(gradient(e) - gradient(-e)) / (2.0 * step) for e in step * np.eye(len(z))]).T
    assert (np.abs(by - system.hessian) / np.abs(system.hessian).max(axis=1)[:, None]).max() < 1e-6
    assert np.abs(by - by.T).max() > 1e-2


@pytest.mark.slow
def test_without_events_the_referee_finds_them_itself() -> None:
    scene = rough("ks-face", 0.3, 20)
    response = answer(scene)
    with_events, without = History(response, scene), History(replace(response, events=None), scene)
    for number in (1, 2):
        own, stated_there = without.begin(PAIR, number), with_events.begin(PAIR, number)
        assert own.load_parameter == pytest.approx(stated_there.load_parameter, abs=1e-9)
    assert all_along(scene, replace(response, events=None)).certified


@pytest.mark.slow
def test_a_model_without_states_of_friction_is_judged_by_its_forces() -> None:
    scene = rough("ks-cantilever", 0.3, 20)
    response = answer(scene)
    silent = replace(response.contacts[PAIR], friction=None)
    mute = replace(response, contacts={PAIR: silent}, events=None, work=None)
    found = all_along(scene, mute)
    assert found.certified, found.line()
    assert f"friction of {PAIR} taken from the direction of its force" in found.line()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ks-cantilever", "ks-face"])
def test_the_dissipation_is_that_of_the_exact_elements(name: str) -> None:
    """Two quadratures of different programs; work less dissipation is the strain energy."""
    scene = rough(name, 0.3)
    response = answer(scene)
    found, history = all_along(scene, response), History(response, scene)
    own = np.cumsum([dissipated(history, k, item.exact)[PAIR] for k, item in enumerate(found.judged)])
    np.testing.assert_allclose(own, response.contacts[PAIR].friction.dissipated, rtol=1e-11)
    stored = np.array([item.exact.strain_energy for item in found.judged])
    np.testing.assert_allclose(stored + own, response.work, rtol=2e-11)


@pytest.mark.slow
def test_the_exact_rods_of_any_scene_state_their_friction() -> None:
    scene = rough("three-point-bending", 0.2, 6)
    rods, elements = solve_network(scene, "rod"), answer(scene)
    assert rods.completed, rods.message
    np.testing.assert_allclose(rods.work, elements.work, rtol=1e-9)
    for pair, history in rods.contacts.items():
        rods_friction, elements_friction = history.friction, elements.contacts[pair].friction
        np.testing.assert_allclose(rods_friction.tangential, elements_friction.tangential, rtol=1e-9)
        np.testing.assert_allclose(rods_friction.normal, elements_friction.normal, rtol=1e-9)
        np.testing.assert_allclose(rods_friction.dissipated, elements_friction.dissipated, rtol=1e-8)
        np.testing.assert_array_equal(rods_friction.slip, elements_friction.slip)


@pytest.mark.slow
def test_a_strut_buckles_in_stick_whatever_the_steps() -> None:
    """The strut of the crossed beams sticks on the lower beam; on the straight branch its force would be 5130 N instead of 2905 N."""
    for steps in (6, 12, 24):
        scene = rough("crossed-beams", 0.2, steps)
        response = answer(scene)
        assert all_along(scene, response).verdict is Verdict.CERTIFIED
        assert response.contacts["upper.end->lower"].force[-1] == pytest.approx(2904.509, rel=1e-6)


def drawn_on_a_face(*, round_pin: bool) -> Scene:
    """A thick cantilever under a sharp or a round pin, whose shear and face matter."""
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.2), clamped=("start",), width=0.1, height=0.2, youngs_modulus=1e4,
        poissons_ratio=0.3,
    )  # fmt: skip
    return Scene(
        name="face", load_parameters=1, beams=(beam,),
        pins=(PinSpec(name="p", path=((0.8, -0.2), (0.7, 0.2)), radius=0.15 if round_pin else None),),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface="face", friction=0.4),),
    )  # fmt: skip


@pytest.mark.slow_at(
    "axis-0.1-1.0-from a touch",
    "axis-0.1-1.0-from the start",
    "axis-None-1.0-from a touch",
    "face-0.1-20.0-from a touch",
    "face-0.1-20.0-from the start",
    "face-None-20.0-from a touch",
    "face-None-20.0-from the start",
)
@pytest.mark.parametrize("gap", [0.0, 0.003], ids=["from the start", "from a touch"])
@pytest.mark.parametrize(
    ("surface", "radius", "friction"),
    [("axis", None, 1.0), ("axis", 0.1, 1.0), ("face", None, 20.0), ("face", 0.1, 20.0)],
)
def test_a_pin_that_sticks_where_it_touches_is_certified(
    gap: float, surface: str, radius: float | None, friction: float
) -> None:
    """A thick beam under a pin raised square to it; with and without events."""
    offset = (0.1 if surface == "face" else 0.0) + (radius or 0.0)
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=0.2, height=0.2, youngs_modulus=1e7, poissons_ratio=0.3
    )  # fmt: skip
    scene = Scene(
        name="raised", load_parameters=8, beams=(beam,),
        pins=(PinSpec(name="p", path=((0.7, -offset - gap), (0.7, 0.01 - offset)), radius=radius),),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface=surface, friction=friction),),
    )  # fmt: skip
    response = answer(scene)
    history = History(response, scene)
    assert [phase.slip for phase in history.phases["p->b"]] == ([OPEN, 0] if gap else [0])
    for given in (response, replace(response, events=None)):
        found = all_along(scene, given)
        assert found.certified, found.line()
        # where a pin rolls, both integrate its place to 3e-14 L, which EA turns into a force
        rolls = radius is not None and surface == "axis"
        assert max(item.distance.largest[1] for item in found.judged if item.distance) < (
            4e-10 if rolls else 1e-11
        )
