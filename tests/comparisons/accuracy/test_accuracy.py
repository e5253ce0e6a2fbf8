"""An accuracy instead of a mesh: the choice, the estimates, and whether the promise is kept."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.accuracy import solve_to
from comparisons.accuracy.require import without_idle
from comparisons.accuracy.theory import beam_theory
from comparisons.errors import difference
from comparisons.models import solve
from comparisons.models.options import ModelError, Options
from comparisons.quantities import QUANTITIES
from comparisons.scene import (
    SPECIAL,
    BeamSpec,
    ContactSpec,
    LoadSpec,
    PinSpec,
    Scene,
    load_scene,
    read_scene,
)
from tests.comparisons.scene.test_special_keys import BEAM, USES

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5)
KS = load_scene("ks-cantilever")
TIP = LoadSpec(beam="a", end="end", force=(0.0, -1.0))
LATER = 'load = [{ beam = "a", end = "end", force = [0.0, 2.0] }]'
IDLE = '[[spring]]\nbeam = "idle"\nend = "end"\nstiffness = [0.0, 3.0]\n'


@pytest.fixture(scope="module")
def rod():
    return solve(KS, "rod")


def random_scene(rng):
    """One clamped beam under a pin: h/L .001 to .1, any place, direction, depth, on the axis or the face."""
    height, x, angle = 10 ** rng.uniform(-3, -1), rng.uniform(0.2, 1), math.radians(rng.uniform(20, 160))
    depth, face = rng.uniform(0.02, 0.6), bool(rng.integers(2))
    return Scene(
        name="random",
        load_parameters=20,
        beams=(
            BeamSpec(
                name="b",
                start=(0.0, 0.0),
                end=(1.0, 0.0),
                clamped=("start",),
                width=height,
                height=height,
                youngs_modulus=1.0,
                poissons_ratio=0.3,
            ),
        ),
        pins=(
            PinSpec(
                name="p",
                start=(x, -height / 2 if face else 0.0),
                displacement=(depth * math.cos(angle), depth * math.sin(angle)),
            ),
        ),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface="face" if face else "axis"),),
    )


def kept_promises(count, element):
    rng, kept = np.random.default_rng(0), []
    while len(kept) < count * len(ACCURACIES):
        scene = random_scene(rng)
        exact = solve(scene, "rod")
        if not exact.completed:
            continue
        for accuracy in ACCURACIES:
            answer = solve_to(scene, accuracy, element=element)
            error = difference(answer.response, exact, scene, "force")
            kept.append(answer.reached and error <= accuracy)
    return kept


@pytest.mark.parametrize("element", [None, pytest.param("mixed", marks=pytest.mark.slow)])
def test_the_promise_is_kept(element):
    assert all(kept_promises(5, element))


@pytest.mark.slow
@pytest.mark.parametrize("element", [None, "mixed"])
def test_the_promise_is_kept_on_random_scenes(element, stated):
    kept = kept_promises(50, element)
    assert np.mean(kept) >= 0.99
    stated(f"accuracy.{element or 'free'}", sum(kept), len(kept))


@pytest.mark.slow_at(
    "mixed-shape",
    "mixed-shape_mean",
    "timoshenko-arc",
    "timoshenko-force",
    "timoshenko-friction",
    "timoshenko-moment",
    "timoshenko-shape",
    "timoshenko-shape_mean",
    "timoshenko-tip",
)
@pytest.mark.parametrize("quantity", [name for name in QUANTITIES if name != "stress"])
@pytest.mark.parametrize("element", ["mixed", "timoshenko"])
def test_every_quantity(rod, quantity, element):
    """The accuracy holds; the estimate bounds the true error, but for the scatter that the paper's element has at its nodes."""
    answer = solve_to(KS, 1e-3, quantity, element=element)
    error = difference(answer.response, rod, KS, quantity)
    assert answer.reached
    assert error <= 1e-3
    assert error <= answer.found.estimate * (1.0 if element == "mixed" else 1.5)
    assert answer.found.estimate <= 20 * error


def test_a_small_load_takes_a_sharper_integration():
    """1e-4 L deep: the force is 2e-3 EI/L^2, and an estimate in its units tells 500 times less."""
    scene = replace(KS, pins=(replace(KS.pins[0], start=(0.5, 0.0), displacement=(0.0, 1e-4)),))
    answer, exact = solve_to(scene, 1e-6), solve(scene, "rod")
    assert answer.reached
    assert difference(answer.response, exact, scene, "force") <= 1e-6
    assert not solve_to(scene, 1e-9).reached


def equal_elements_error(rod, elements):
    return difference(solve(KS, "tsm", Options(elements=elements)), rod, KS, "force")


def test_graded_elements_have_smaller_errors_than_equal_ones(rod, stated):
    answer = solve_to(KS, 1e-5, element="mixed")
    graded = len(answer.found.scene.beams[0].nodes) + 1
    error, equal = difference(answer.response, rod, KS, "force"), equal_elements_error(rod, graded)
    stated("graded.elements", graded)
    stated("graded.error", error)
    stated("graded.equal", equal)
    assert error < equal / 1.5


@pytest.mark.slow
def test_graded_elements_for_a_small_error(rod, stated):
    answer = solve_to(KS, 1e-6, element="mixed")
    assert difference(answer.response, rod, KS, "force") <= 1e-6
    stated("graded.for-1e-6", len(answer.found.scene.beams[0].nodes) + 1)
    stated("equal.for-1e-6", next(n for n in range(16, 30) if equal_elements_error(rod, n) <= 1e-6))


def test_a_tail_without_load_takes_few_elements():
    """A pin at a third of the length: what lies beyond it is straight."""
    pin = replace(KS.pins[0], start=(0.3, 0.0), displacement=(0.0, 0.15))
    scene = replace(KS, pins=(pin,))
    answer, exact = solve_to(scene, 1e-4, element="mixed"), solve(scene, "rod")
    nodes = np.array(answer.found.scene.beams[0].nodes)
    reach = np.nanmax(exact.contacts["pin->cantilever"].arc_position)
    assert np.count_nonzero(nodes > reach) <= 0.3 * len(nodes)
    assert difference(answer.response, exact, scene, "force") <= 1e-4
    equal = solve(scene, "tsm", Options(elements=len(nodes) + 1))
    assert difference(answer.response, exact, scene, "force") < difference(equal, exact, scene, "force") / 10


@pytest.mark.parametrize("element", [None, "mixed"])
@pytest.mark.parametrize("key", SPECIAL)
def test_the_promise_is_kept_with_every_special_key(key, element):
    """Curved, tapered, heavy, sprung and hinged beams, loads inside and along them, and stages."""
    scene = read_scene(USES[key], "s")
    reference = solve(scene, "rod")
    for quantity in ("force", "shape"):
        found = solve_to(scene, 1e-5, quantity, element=element)
        assert found.reached
        assert difference(found.response, reference, scene, quantity) <= 1e-5


def test_a_weight_a_later_load_and_a_spring_are_kept_with_their_beams():
    """A heavy beam and a beam that a stage loads are on a load path; what holds a beam that is left out goes with it."""
    heavy = read_scene(USES["density"], "s")
    weight_only = replace(heavy, pins=(), contacts=())
    assert without_idle(weight_only) == (weight_only, ())
    later = read_scene(
        USES["stage"].replace('pin = [{ name = "p", displacement = [0.0, -0.3] }]', LATER), "s"
    )
    kept, said = without_idle(replace(later, pins=(), contacts=()))
    assert (len(kept.beams), said) == (1, ())
    sprung = read_scene(USES["spring"] + BEAM.replace('"a"', '"idle"').replace("0.0]", "5.0]") + IDLE, "s")
    kept, said = without_idle(sprung)
    assert ([beam.name for beam in kept.beams], len(kept.springs), len(said)) == (["a"], 1, 1)


def test_the_theory_of_curved_and_tapered_beams_has_their_radius_and_local_height():
    arc, taper = (read_scene(USES[key], "s") for key in ("turn", "taper"))
    tight = replace(arc, beams=(replace(arc.beams[0], turn=-2.0),), contacts=(), pins=(), loads=(TIP,))
    assert beam_theory(solve(tight, "tsm"), tight).slenderness == pytest.approx(
        0.01 * 2.0 / tight.beams[0].length, rel=1e-12
    )
    beam = taper.beams[0]
    response = solve(taper, "tsm", Options(element="exact"))
    data = response.grid(len(response.load_parameter) - 1).point_data
    local = [
        abs(m) * beam.height_at(s) / (2 * beam.stiffness(s)[2])
        for s, m in zip(np.clip(data["arc"], 0, 1).tolist(), data["M"].tolist(), strict=True)
    ]
    assert beam_theory(response, taper).strain == pytest.approx(max(local), rel=1e-12)


@pytest.mark.slow
def test_what_a_scene_requires():
    (beam,) = KS.beams
    stocky = replace(KS, beams=(replace(beam, height=0.2),), load_parameters=2)
    assert solve_to(KS, 1e-3).model == "tsm"
    assert "exact rods suffice" in solve_to(KS, 1e-3).decisions[0]
    solid = solve_to(stocky, 1e-2)
    assert solid.model == "solid"
    assert "stocky, h/L = 0.2" in solid.decisions[0]
    assert solid.theory is None
    load = LoadSpec(beam=beam.name, end="end", moment=1e-5)
    loaded = replace(stocky, pins=(), contacts=(), loads=(load,))
    assert solve_to(loaded, 1e-2).model == "solid"
    full = replace(loaded.beams[0], solid_clamp="full")
    other = solve_to(replace(loaded, beams=(full,), loads=(load, replace(load, end="start"))), 1e-2)
    assert other.model == "tsm"
    assert "but the solid model has a full clamp at rest" in other.decisions[0]


def test_bodies_without_a_load_path_are_left_out():
    double = load_scene("double-beam")
    idle = replace(double.beams[0], name="idle", start=(0.0, 5.0), end=(1.0, 5.0))
    watched = ContactSpec(node="idle.end", beam=idle.name + "2", side="left", surface="axis")
    second = replace(idle, name="idle2", start=(0.5, 4.9), end=(1.5, 4.9))
    scene = replace(double, beams=(*double.beams, idle, second), contacts=(*double.contacts, watched))
    loaded, said = without_idle(scene)
    assert loaded == double
    assert [line.split(":")[0] for line in said] == [
        'beam "idle" lies on no load path',
        'beam "idle2" lies on no load path',
    ]
    assert without_idle(double) == (double, ())


@pytest.mark.slow_at("0.01")
@pytest.mark.parametrize("height", [0.02, 0.01])
def test_beam_theorys_own_error(height):
    """Within a factor of two of what a solid of the rod's own law shows."""
    (beam,) = KS.beams
    scene = replace(KS, beams=(replace(beam, height=height, material="biot-linear"),), load_parameters=10)
    exact = solve(scene, "rod")
    solid = solve(scene, "solid", Options(mesh=(100, 2)))
    pair = scene.contacts[0].pair
    apart = np.abs(solid.contacts[pair].force / exact.contacts[pair].force - 1)[1:].max()
    theory = solve_to(scene, 1e-3).theory
    assert theory.slenderness == pytest.approx(height)
    assert apart / 2 <= theory.error <= 2 * apart


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"quantity": "weight"}, "quantity = weight: must be one of force, arc"),
        ({"model": "rod"}, "model = rod: has no resolution to choose"),
        ({"model": "solid", "element": "mixed"}, "solid: element = mixed: not an option"),
        ({"element": "cubic"}, "element = cubic: must be one of"),
    ],
)
def test_what_cannot_be_asked(asked, sentence):
    with pytest.raises(ModelError, match=sentence):
        solve_to(KS, 1e-3, **asked)


def test_a_solution_that_stops_reaches_nothing():
    """The pin leaves the contact that must persist: the status is the solution's, not an accuracy."""
    contact = replace(KS.contacts[0], keep=True)
    scene = replace(KS, pins=(replace(KS.pins[0], displacement=(0.5, 0.2)),), contacts=(contact,))
    for element in (None, "mixed"):
        answer = solve_to(scene, 1e-3, element=element)
        assert answer.response.status == "SLIPPED_OFF"
        assert not answer.reached
