"""An accuracy instead of a mesh: the choice, the estimates, and whether the promise is kept."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.answer.errors import difference
from comparisons.answer.quantities import KEPT
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import SPECIAL, BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene, read_scene
from comparisons.suite.accuracy import solve_to
from tests.comparisons.scene.test_special_keys import BEAM, USES

KS = load_scene("ks-cantilever")
PAIR = "pin->cantilever"


@pytest.fixture(scope="module")
def rod():
    return solve(KS, "rod")


def lifted(start, displacement, **changes):
    """KS under a pin on another way."""
    return replace(KS, pins=(replace(KS.pins[0], start=start, displacement=displacement),), **changes)


def checked(scene, accuracy, quantity="force", exact=None, element=None):
    """Solve to an accuracy, which must be reached, and return the answer and its true error, which must be within it."""
    answer = solve_to(scene, accuracy, quantity, element=element)
    error = difference(answer.response, exact or solve(scene, "rod"), scene, quantity)
    assert answer.reached
    assert error <= accuracy
    return answer, error


def random_scene(rng):
    """One clamped beam under a pin: h/L .001 to .1, any place, direction, depth, on the axis or the face."""
    height, x, angle = 10 ** rng.uniform(-3, -1), rng.uniform(0.2, 1), math.radians(rng.uniform(20, 160))
    depth, face = rng.uniform(0.02, 0.6), bool(rng.integers(2))
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=height, height=height, youngs_modulus=1.0, poissons_ratio=0.3,
    )  # fmt: skip
    way = (depth * math.cos(angle), depth * math.sin(angle))
    pin = PinSpec(name="p", start=(x, -height / 2 if face else 0.0), displacement=way)
    contact = ContactSpec(node="p", beam="b", side="right", surface="face" if face else "axis")
    return Scene(name="random", load_parameters=20, beams=(beam,), pins=(pin,), contacts=(contact,))


@pytest.mark.slow_at("free-50", "mixed-50")
@pytest.mark.parametrize("count", [2, 50])
@pytest.mark.parametrize("element", [None, "mixed"], ids=["free", "mixed"])
def test_the_promise_is_kept_on_random_scenes(element, count, stated):
    rng, kept = np.random.default_rng(0), []
    accuracies = (1e-2, 1e-3, 1e-4, 1e-5) if count == 50 else (1e-4,)
    while len(kept) < count * len(accuracies):
        scene = random_scene(rng)
        exact = solve(scene, "rod")
        for accuracy in accuracies if exact.completed else ():
            answer = solve_to(scene, accuracy, element=element)
            error = difference(answer.response, exact, scene, "force")
            kept.append(answer.reached and error <= accuracy)
    assert np.mean(kept) >= 0.99
    if count == 50:
        stated(f"accuracy.{element or 'free'}", sum(kept), len(kept))


FEW = ("force", "arc", "moment")
EVERY = [(element, one) for element in ("mixed", "timoshenko") for one in KEPT]


@pytest.mark.parametrize(
    ("element", "quantity"),
    [
        pytest.param(*case, marks=[pytest.mark.slow] * (case not in [("mixed", one) for one in FEW]))
        for case in EVERY
    ],
)
def test_every_quantity(rod, element, quantity):
    """The accuracy holds; the estimate bounds the true error, but for the scatter that the paper's element has at its nodes."""
    answer, error = checked(KS, 1e-3, quantity, rod, element)
    assert error <= answer.estimate * (1.0 if element == "mixed" else 1.5)
    assert answer.estimate <= 20 * error


def test_a_small_load_takes_a_sharper_integration():
    """1e-4 L deep: the force is 2e-3 EI/L^2, and an estimate in its units tells 500 times less."""
    scene = lifted((0.5, 0.0), (0.0, 1e-4))
    checked(scene, 1e-6)
    assert not solve_to(scene, 1e-9).reached


def equal_elements_error(rod, elements):
    return difference(solve(KS, "tsm", Options(elements=elements)), rod, KS, "force")


def test_graded_elements_have_smaller_errors_than_equal_ones(rod, stated):
    answer, error = checked(KS, 1e-5, exact=rod, element="mixed")
    graded = len(answer.scene.beams[0].nodes) + 1
    equal = equal_elements_error(rod, graded)
    stated("graded.elements", graded)
    stated("graded.error", error)
    stated("graded.equal", equal)
    assert error < equal / 1.5


@pytest.mark.slow
def test_graded_elements_for_a_small_error(rod, stated):
    answer, _ = checked(KS, 1e-6, exact=rod, element="mixed")
    stated("graded.for-1e-6", len(answer.scene.beams[0].nodes) + 1)
    stated("equal.for-1e-6", next(n for n in range(16, 30) if equal_elements_error(rod, n) <= 1e-6))


def test_a_tail_without_load_takes_few_elements():
    """A pin at a third of the length: what lies beyond it is straight."""
    scene = lifted((0.3, 0.0), (0.0, 0.15))
    exact = solve(scene, "rod")
    answer, error = checked(scene, 1e-4, exact=exact, element="mixed")
    nodes = np.array(answer.scene.beams[0].nodes)
    assert np.count_nonzero(nodes > np.nanmax(exact.contacts[PAIR].arc_position)) <= 0.3 * len(nodes)
    equal = solve(scene, "tsm", Options(elements=len(nodes) + 1))
    assert error < difference(equal, exact, scene, "force") / 10


@pytest.mark.slow_at(*(f"{key}-free" for key in ("density", "turn", "force_per_length", "stage")))
@pytest.mark.slow_at(*(f"{key}-mixed" for key in ("density", "turn", "force_per_length", "hinge", "taper")))
@pytest.mark.parametrize("element", ["free", "mixed"])
@pytest.mark.parametrize("key", SPECIAL)
def test_the_promise_is_kept_with_every_special_key(key, element):
    """Curved, tapered, heavy, sprung and hinged beams, loads inside and along them, and stages."""
    scene = read_scene(USES[key], "s")
    exact = solve(scene, "rod")
    for quantity in ("force", "shape"):
        checked(scene, 1e-5, quantity, exact, None if element == "free" else element)


def test_an_answer_has_all_beams_of_its_scene_and_is_certified_from_its_file(tmp_path):
    """Also those that no load reaches."""
    idle = BEAM.replace('"a"', '"idle"').replace("0.0]", "5.0]")
    scene, file = tmp_path / "s.toml", tmp_path / "a.json"
    scene.write_text(USES["spring"] + idle)
    for more in ((), ("--element", "mixed")):
        assert main(["solve", str(scene), "--accuracy", "1e-3", *more, "--out", str(file)]) == 0
        assert main(["certify", str(file), "--scene", str(scene)]) == 0
        file.unlink()


def test_the_theory_of_curved_and_tapered_beams_has_their_radius_and_local_height():
    arc, taper = (read_scene(USES[key], "s") for key in ("turn", "taper"))
    tip = LoadSpec(beam="a", end="end", force=(0.0, -1.0))
    tight = replace(arc, beams=(replace(arc.beams[0], turn=-2.0),), contacts=(), pins=(), loads=(tip,))
    radius = tight.beams[0].length / 2.0
    assert solve_to(tight, 1e-3).beam_theory.slenderness == pytest.approx(0.01 / radius, rel=1e-12)
    answer, beam = solve_to(taper, 1e-3), taper.beams[0]
    data = answer.response.grid(beam.name, len(answer.response.load_parameter) - 1).point_data
    local = [
        abs(m) * beam.height_at(s) / (2 * beam.stiffness(s)[2])
        for s, m in zip(np.clip(data["arc"], 0, 1).tolist(), data["M"].tolist(), strict=True)
    ]
    assert answer.beam_theory.strain == pytest.approx(max(local), rel=1e-12)


@pytest.mark.slow
def test_what_a_scene_requires():
    (beam,) = KS.beams
    stocky = replace(KS, beams=(replace(beam, height=0.2),), load_parameters=2)
    slender, solid = solve_to(KS, 1e-3), solve_to(stocky, 1e-2)
    assert (slender.model, solid.model, solid.beam_theory) == ("tsm", "solid", None)
    assert "exact rods suffice" in slender.decisions[0]
    assert "stocky, h/L = 0.2" in solid.decisions[0]
    load = LoadSpec(beam=beam.name, end="end", moment=1e-5)
    loaded = replace(stocky, pins=(), contacts=(), loads=(load,))
    assert solve_to(loaded, 1e-2).model == "solid"
    full = replace(loaded.beams[0], solid_clamp="full")
    other = solve_to(replace(loaded, beams=(full,), loads=(load, replace(load, end="start"))), 1e-2)
    assert other.model == "tsm"
    assert "but the solid model has a full clamp at rest" in other.decisions[0]


@pytest.mark.slow_at("0.01")
@pytest.mark.parametrize("height", [0.02, 0.01])
def test_beam_theorys_own_error(height):
    """Within a factor of two of what a solid of the rod's own law shows."""
    beam = replace(KS.beams[0], height=height, material="biot-linear")
    scene = replace(KS, beams=(beam,), load_parameters=10)
    exact, solid = solve(scene, "rod"), solve(scene, "solid", Options(mesh=(100, 2)))
    apart = np.abs(solid.contacts[PAIR].force / exact.contacts[PAIR].force - 1)[1:].max()
    theory = solve_to(scene, 1e-3).beam_theory
    assert theory.slenderness == pytest.approx(height)
    assert apart / 2 <= theory.error <= 2 * apart


@pytest.mark.slow_at("mixed")
@pytest.mark.parametrize("element", [None, "mixed"])
def test_a_solution_that_stops_reaches_nothing(element):
    """The pin leaves the contact that must persist: the status is the solution's, not an accuracy."""
    scene = lifted(KS.pins[0].points[0], (0.5, 0.2), contacts=(replace(KS.contacts[0], keep=True),))
    answer = solve_to(scene, 1e-3, element=element)
    assert answer.response.status == "SLIPPED_OFF"
    assert not answer.reached
