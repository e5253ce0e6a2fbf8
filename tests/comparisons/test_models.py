"""Every model on the same scene, in every position of the plane."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from comparisons.models import MODELS, solve
from comparisons.models.options import ModelError, Options
from comparisons.response.to_json import as_json
from comparisons.scene import LoadSpec, PinSpec, Scene, load_scene, read_scene

KS = load_scene("ks-cantilever")
SHORT = replace(KS, load_parameters=8)
PAIR = "pin->cantilever"
EXACT = Options(element="exact")


def coarse(model: str) -> Options:
    return {"tsm": Options(elements=10), "solid": Options(mesh=(16, 1))}.get(model, Options())


def moved(scene: Scene, *, mirrored: bool, from_end: bool) -> Scene:
    """The same physics turned, shifted, perhaps mirrored, with the beam perhaps running towards its clamp."""
    turn = np.array([[0.6, -0.8], [0.8, 0.6]]) @ np.diag([1.0, -1.0 if mirrored else 1.0])

    def place(point: tuple[float, float]) -> tuple[float, float]:
        x, y = turn @ np.array(point) + np.array([3.0, -2.0])
        return float(x), float(y)

    beam = scene.beams[0]
    ends = [place(beam.start), place(beam.end)]
    start, end = ends[::-1] if from_end else ends
    new = replace(beam, start=start, end=end, clamped=("end",) if from_end else ("start",))
    pin = PinSpec(name="pin", path=tuple(place(point) for point in scene.pins[0].points))
    side = "right" if mirrored == from_end else "left"
    return replace(scene, beams=(new,), pins=(pin,), contacts=(replace(scene.contacts[0], side=side),))


@pytest.mark.slow_at("solid-False-False", "solid-False-True", "solid-True-False", "solid-True-True")
@pytest.mark.parametrize("from_end", [False, True])
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("model", MODELS)
def test_response_moves_with_the_scene(model: str, mirrored: bool, from_end: bool) -> None:
    # round-off of positions (about 4 eps) times the stretching stiffness is 1e-12 of EA, 1e-8 of the force
    here, there = (
        solve(scene, model, coarse(model))
        for scene in (SHORT, moved(SHORT, mirrored=mirrored, from_end=from_end))
    )
    assert here.completed, here.message
    assert there.completed, there.message
    contact, moved_contact = here.contacts[PAIR], there.contacts[PAIR]
    arc = 1.0 - moved_contact.arc_position if from_end else moved_contact.arc_position
    sign = -1.0 if mirrored else 1.0
    turn = np.array([[0.6, -0.8], [0.8, 0.6]]) @ np.diag([1.0, sign])
    scale = contact.force.max()
    assert moved_contact.force == pytest.approx(contact.force, abs=1e-7 * scale)
    assert arc == pytest.approx(contact.arc_position, abs=1e-7)
    clamp = "cantilever.end" if from_end else "cantilever.start"
    support, moved_support = here.supports["cantilever.start"], there.supports[clamp]
    assert moved_support.moment == pytest.approx(sign * support.moment, abs=1e-7 * scale)
    assert moved_support.force == pytest.approx(support.force @ turn.T, abs=1e-7 * scale)
    tips = here.tips["cantilever"] @ turn.T + np.array([3.0, -2.0])
    assert there.tips["cantilever"] == pytest.approx(tips, abs=1e-7)


@pytest.mark.parametrize(
    ("model", "options"), [*((model, coarse(model)) for model in MODELS), ("tsm", EXACT)]
)
def test_axis_line_and_grid_agree_with_tip_and_contact(model: str, options: Options) -> None:
    response = solve(SHORT, model, options)
    for k in (0, 7):
        arc, line = response.axis_line("cantilever", k)
        assert arc[0] == 0.0
        assert arc[-1] == pytest.approx(1.0)
        assert line[-1] == pytest.approx(response.tips["cantilever"][k], abs=1e-9)
        at = response.contacts[PAIR].arc_position[k]
        touched = [np.interp(at, arc, line[:, i]) for i in range(2)]
        assert touched == pytest.approx(
            SHORT.pins[0].position(SHORT.times[k]), abs=1e-3
        )  # chords of the line
        grid = response.grid(k)
        assert grid.points + grid.point_data["displacement"] == pytest.approx(
            grid.point_data["deformed"], abs=1e-15
        )


@pytest.mark.parametrize("model", ["tsm", "rod", "elastica", "solid"])
def test_slip_off_leaves_a_straight_beam(model: str) -> None:
    pin = PinSpec(name="pin", start=(0.9, 0.0), displacement=(0.0, 0.6))
    response = solve(replace(KS, pins=(pin,), load_parameters=6), model, coarse(model))
    contact = response.contacts[PAIR]
    assert response.completed, response.message
    earliest = 0.3947 if model == "solid" else 0.39486
    assert earliest / 0.6 < contact.slip_off <= 4 / 6 + 1e-12
    assert list(contact.force[-3:]) == pytest.approx([0.0, 0.0, 0.0])
    assert np.all(np.isnan(contact.arc_position[-3:]))
    assert response.tips["cantilever"][-1] == pytest.approx([1.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_pin_that_leaves_the_beam_at_first_touches_it_again_from_its_side(
    friction: float, mirrored: bool
) -> None:
    """On the beam a pin's side is the scene's, whatever way it moves at first."""
    path = ((0.5, 0.0), (0.7, -0.1), (0.8, 0.1))
    pins, contacts = (PinSpec(name="pin", path=path),), (replace(KS.contacts[0], friction=friction),)
    given = moved(
        replace(KS, pins=pins, contacts=contacts, load_parameters=3), mirrored=mirrored, from_end=False
    )
    rod, beams = (solve(given, model, EXACT if model == "tsm" else Options()) for model in ("rod", "tsm"))
    assert rod.completed
    assert beams.completed
    force = rod.contacts[PAIR].force
    np.testing.assert_array_equal(force > 0.0, [False, False, True])
    np.testing.assert_allclose(force, beams.contacts[PAIR].force, rtol=1e-9)


def test_solid_names_why_it_stopped() -> None:
    pin = PinSpec(name="pin", start=(0.9, 0.0), displacement=(0.0, 0.6))
    contact = replace(KS.contacts[0], keep=True)
    scene = replace(KS, pins=(pin,), contacts=(contact,), load_parameters=6)
    response = solve(scene, "solid", Options(mesh=(16, 1)))
    assert (response.status, response.completed) == ("LOST_CONTACT", False)
    assert len(response.load_parameter) == 3
    assert len(response.contacts[PAIR].force) == 3


@pytest.mark.parametrize(
    ("model", "options"),
    [("rod", Options(elements=3)), ("solid", Options(element="mixed")), ("tsm", Options(mesh=(2, 2)))],
)
def test_foreign_options_are_refused(model: str, options: Options) -> None:
    with pytest.raises(ModelError, match="not an option of this model"):
        solve(KS, model, options)


def test_unknown_model_and_face_under_the_elastica() -> None:
    with pytest.raises(ModelError, match="model = nosuch: must be one of tsm, solid, rod, elastica"):
        solve(KS, "nosuch")
    with pytest.raises(ModelError, match="in contact on its axis only"):
        solve(load_scene("ks-face"), "elastica")


@pytest.mark.slow_at("solid")
@pytest.mark.parametrize("model", ["tsm", "rod", "solid"])
def test_round_pin_is_the_same_for_every_model(model: str) -> None:
    """A pin of half the height's radius on the axis: the contact of the face scene's point, to the solid's accuracy."""
    face = replace(load_scene("ks-face"), load_parameters=10)
    pin = replace(face.pins[0], radius=0.01)
    contact = replace(face.contacts[0], surface="axis", penetration=1e-10)
    response = solve(replace(face, pins=(pin,), contacts=(contact,)), model, coarse(model))
    assert response.completed, response.message
    exact = solve(face, "rod").contacts[PAIR].force
    assert response.contacts[PAIR].force == pytest.approx(
        exact, rel={"solid": 8e-3, "tsm": 1e-4}.get(model, 1e-9)
    )
    assert np.abs(response.contacts[PAIR].gap).max() < 1e-10


@pytest.mark.slow_at("law1")
@pytest.mark.parametrize("law", [{"penalty": 10.0}, {"penetration": 1e-6}])
def test_soft_contacts_with_friction_of_the_solid_pass_the_checks(law: dict[str, float]) -> None:
    """The tangential force acts on the surface, a gap away from the pin, and a stated penetration is not an open gap."""
    contact = replace(KS.contacts[0], friction=0.3, **law)
    response = solve(replace(KS, contacts=(contact,), load_parameters=5), "solid", Options(mesh=(30, 1)))
    assert response.completed, response.message
    assert 1e-9 < np.abs(response.contacts[PAIR].gap).max() < 1e-3


@pytest.mark.parametrize(("model", "options"), [("tsm", {"element": "exact"}), ("solid", {"mesh": (20, 1)})])
def test_every_model_states_critical_points_and_takes_a_branch(model: str, options: dict[str, Any]) -> None:
    """A straight column at 1.3 times its Euler load: the solid within .5 % of the rod."""
    beam = replace(KS.beams[0], material="biot-linear")
    first = np.pi**2 / 4 * beam.EI / beam.length**2
    load = LoadSpec(beam=beam.name, end="end", force=(-1.3 * first, 0.0))
    scene = replace(KS, beams=(beam,), pins=(), contacts=(), loads=(load,), load_parameters=4)
    stopped = solve(scene, model, Options(**options))
    assert stopped.status == "BIFURCATION"
    (point,) = stopped.critical
    assert point.kind == "bifurcation"
    assert json.loads(as_json(stopped))["critical"][0]["kind"] == "bifurcation"
    assert 1.3 * point.load_parameter == pytest.approx(1.0, rel=5e-3)
    unstable = solve(scene, model, Options(**options, branch="primary"))
    assert (unstable.status, unstable.completed) == ("UNSTABLE", False)
    assert unstable.index is not None
    assert unstable.index.tolist() == [0, 0, 0, 1]
    bent = solve(scene, model, Options(**options, branch="stable"))
    assert bent.completed, bent.message
    assert abs(bent.tips[beam.name][-1, 1]) > 0.5


@pytest.mark.parametrize("element", ["mixed", "timoshenko"])
def test_one_element_between_two_clamps_is_refused_in_one_line(element: str) -> None:
    """It has no unknowns; two elements and one exact one have."""
    scene = read_scene(
        """
scene = { name = "column", load_parameters = 2 }
support = [{ beam = "b", end = "end", kind = "clamped", displacement = [-0.01, 0], rotation = 0.01 }]
[[beam]]
name = "b"
start = [0, 0]
end = [1, 0]
clamped = ["start"]
width = 0.1
height = 0.1
youngs_modulus = 1e7
poissons_ratio = 0.25
""",
        "column",
    )
    with pytest.raises(
        ModelError, match=r"Beam\(b\)\.elements = 1: every node is held.*take at least 2, or elements 'exact'"
    ):
        solve(scene, "tsm", Options(element=element, elements=1))
    for options in (Options(element=element, elements=2), Options(element="exact", elements=1)):
        assert solve(scene, "tsm", options).completed
