"""The models beyond the answers of the built-in scenes: what each refuses, where it stops, and what its records say."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.models import MODELS, TSM, Model, certified, find, solve
from comparisons.models.model import ModelError, Options
from comparisons.models.solid import to_solid
from comparisons.scene import (
    HingeSpec,
    LoadSpec,
    PinSpec,
    Scene,
    SpringSpec,
    SupportSpec,
    load_scene,
    read_scene,
)
from tests.problems import PROBLEMS, RUNS

KS, FACE = load_scene("ks-cantilever"), load_scene("ks-face")
BEAM = KS.beams[0]
PAIR = "pin->cantilever"
EXACT = Options(element="exact")


def support(end: str, **given: Any) -> SupportSpec:
    return SupportSpec(beam="cantilever", end=end, **given)


def on(scene: Scene, **changes: Any) -> Scene:
    return replace(scene, beams=(replace(scene.beams[0], **changes),))


def loaded(force: float, **changes: Any) -> Scene:
    """A column under an axial force in units of EI/L^2 at its free end."""
    load = LoadSpec(beam=BEAM.name, end="end", force=(force * BEAM.EI / BEAM.length**2, 0.0))
    return replace(KS, **{"pins": (), "contacts": (), "loads": (load,), **changes})


STOP = """
scene = { name = "prop", units = "N, m", load_parameters = 2 }
beam = [{ name = "strip", start = [0, 0], end = [1, 0], clamped = ["start"], width = 0.02, height = 0.01, youngs_modulus = 7e10, poissons_ratio = 0.3 }]
pin = [{ name = "stop", start = [0.7, 0], displacement = [0, 0] }]
contact = [{ node = "stop", beam = "strip", side = "right", friction = FRICTION }]
load = [{ beam = "strip", end = "end", force = [0, LOAD] }]
"""
BACK = '[[stage]]\nload_parameters = 2\nload = [{ beam = "strip", end = "end", force = [0, LOAD] }]\n'
STRIP = "stop->strip"
FREE, HELD = (replace(BEAM, clamped=()),), support("start", kind="clamped")
CURVED = load_scene(str(Path(__file__).parent / "scene" / "hook.toml"))
RUBBED = replace(CURVED, contacts=(replace(CURVED.contacts[0], friction=0.2),))
PRESSED = support("end", kind="clamped", displacement=(-1e-4, 0.0), rotation=0.01)
BOTH_ENDS = replace(KS, load_parameters=2, pins=(), contacts=(), supports=(PRESSED,))
HINGED = support("start", kind="pinned")
LOOSE = replace(KS, beams=FREE, supports=(HINGED,), pins=(replace(KS.pins[0], start=(1.0, -0.1)),))
AT_CLAMP = {"beam": "cantilever", "end": "start"}
HINGED_CLAMP = replace(KS, hinges=(HingeSpec(stiffness=5.0, **AT_CLAMP),))
MOVED_CLAMPS = [
    replace(KS, beams=FREE, **changes)
    for changes in (
        {"supports": (replace(HELD, rotation=0.1),)},
        {"supports": (HELD,), "loads": (LoadSpec(moment=1.0, **AT_CLAMP),)},
        {"supports": (HELD,), "springs": (SpringSpec(stiffness=(1.0, 1.0), **AT_CLAMP),)},
    )
]
TAPERED = 'does not state friction on the face of a beam whose height tapers; use --model solid, surface = "axis" or one height'
NO_UNKNOWNS = r"Beam\(cantilever\)\.elements = 1: every node is held.*take at least 2, or elements 'exact'"


@pytest.mark.parametrize(
    ("scene", "model", "options", "line"),
    [
        (KS, "tsm", Options(mesh=(2, 2)), "not an option of this model"),
        (BOTH_ENDS, "tsm", Options(element="mixed", elements=1), NO_UNKNOWNS),
        (RUBBED, "tsm", EXACT, TAPERED),
        (FACE, "elastica", Options(), "in contact on its axis only"),
        (MOVED_CLAMPS[0], "elastica", Options(), r'the clamp at rest, "cantilever\.start" moves'),
        (replace(KS, supports=(support("end", kind="pinned"),)), "elastica", Options(), 'one support, beam "cantilever" has two'),
        (on(KS, poissons_ratio=None, shear_modulus=1e3), "solid", Options(), "needs a Poisson's ratio between"),
        (on(KS, mesh=(1, 1)), "solid", Options(), "needs at least 2 elements along"),
        (on(KS, solid_mesh_file="nothing.msh"), "solid", Options(), r"^solid: Strip\('cantilever'\)\.mesh_file = 'nothing.msh': cannot be read"),
        (LOOSE, "solid", Options(), "must hold cantilever, with the pins that touch at the start$"),
        (HINGED_CLAMP, "solid", Options(), r"use a pinned support and a \[\[spring\]\] with a rotation"),
        (on(HINGED_CLAMP, solid_clamp="full"), "solid", Options(), 'use solid_clamp = "rod"'),
        *((on(scene, solid_clamp="full"), "solid", Options(), r'full clamp at rest .*, "cantilever\.start" is another') for scene in MOVED_CLAMPS),
    ],
)  # fmt: skip
def test_what_a_model_does_not_state_is_refused_in_one_line(scene, model, options, line):
    with pytest.raises(ModelError, match=line) as caught:
        solve(scene, model, options)
    assert len(str(caught.value).splitlines()) == 1


def test_what_lies_beside_a_refusal_is_stated():
    for scene in MOVED_CLAMPS:
        problem = to_solid(scene)
        assert problem.strips[0].clamped == ()
        assert [item.node for item in problem.supports] == ["cantilever.start"]
    for element in (Options(element="mixed", elements=2), Options(element="exact", elements=1)):
        assert solve(BOTH_ENDS, "tsm", element).completed


@pytest.mark.parametrize("model", MODELS)
def test_a_registered_model_keeps_the_contract(model):
    """Its name, its words for figures, and settings that are its options."""
    found = find(model)
    assert isinstance(found, Model)
    assert (found.name, found is MODELS[model]) == (model, True)
    for options in (*found.compared(), *found.resolutions(quick=True), found.reference or Options()):
        given = {name for name, value in vars(options).items() if value is not None}
        assert given <= {*found.options, "load_steps"}
        assert any(found.run_label(options).startswith(words) for words in found.styles())
        assert any(found.family(KS, options).startswith(words) for words in found.styles())
    families = [found.family(KS, options) for options in found.resolutions(quick=False)]
    assert all(families.count(name) in (1, *range(3, 20)) for name in families)
    assert len({found.run_label(options) for options in found.compared()}) == len(found.compared())
    assert all(style.colour.startswith("#") for style in found.styles().values())
    assert found.colour == next(iter(found.styles().values())).colour


def test_a_round_pin_on_the_face_of_a_taper_is_certified():
    """The referee makes the face and the weight in another way. The grid has the undeformed axis and the stresses of the section."""
    answer = certified(solve(CURVED, "tsm", EXACT), CURVED, allowance=1e-9)
    assert answer.completed, answer.message
    assert answer.certificate is not None
    assert answer.certificate.certified
    spec = CURVED.beams[0]
    data = answer.grid(spec.name, -1)
    arc = data.point_data["arc"] / spec.length
    assert np.abs(data.points - np.array([spec.place(part) for part in arc])).max() <= 1e-15
    width, height = 0.02 - 0.01 * arc, 0.012 - 0.008 * arc
    N, M = data.point_data["N"], data.point_data["M"]
    left = N / (width * height) - 6 * M / (width * height**2)
    assert np.abs(data.point_data["axial_stress_left"] - left).max() <= 1e-12 * np.abs(left).max()
    assert np.abs(M).max() > 0.1


@pytest.mark.parametrize(("friction", "up"), [(0.3, 1.0), (0.0, -1.0)])
def test_a_pin_that_leaves_the_beam_at_first_touches_it_again_from_its_side(friction, up):
    """On the beam a pin's side is the scene's, whatever way it moves at first."""
    pin = PinSpec(name="pin", path=((0.5, 0.0), (0.7, -0.1 * up), (0.8, 0.1 * up)))
    contact = replace(KS.contacts[0], friction=friction, side="right" if up > 0.0 else "left")
    given = replace(KS, pins=(pin,), contacts=(contact,), load_parameters=3)
    rod, beams = (solve(given, model, EXACT if model == "tsm" else Options()) for model in ("rod", "tsm"))
    assert (rod.completed, beams.completed) == (True, True)
    force = rod.contacts[PAIR].force
    np.testing.assert_array_equal(force > 0.0, [False, False, True])
    np.testing.assert_allclose(force, beams.contacts[PAIR].force, rtol=1e-9)


@pytest.mark.slow_at("solid")
@pytest.mark.parametrize("run", ["mixed", "rod", "solid"])
def test_a_round_pin_on_the_axis_is_a_point_on_the_face(run):
    """A pin of half the height's radius."""
    contact = replace(FACE.contacts[0], surface="axis", penetration=1e-10)
    pin = replace(FACE.pins[0], radius=0.01)
    response = solve(replace(FACE, load_parameters=4, pins=(pin,), contacts=(contact,)), *RUNS[run])
    assert response.completed, response.message
    assert PROBLEMS["ks-face"].mistakes(response, PROBLEMS["ks-face"].errors[run]) == []
    assert np.abs(response.contacts[PAIR].gap).max() < 1e-10


@pytest.mark.slow_at("law1")
@pytest.mark.parametrize("law", [{"penalty": 10.0}, {"penetration": 1e-6}])
def test_soft_contacts_with_friction_of_the_solid_pass_the_checks(law):
    """The tangential force acts on the surface, a gap away from the pin, and a stated penetration is not an open gap."""
    contact = replace(KS.contacts[0], friction=0.3, **law)
    response = solve(replace(KS, contacts=(contact,), load_parameters=5), "solid", Options(mesh=(30, 1)))
    assert response.completed, response.message
    assert 1e-9 < np.abs(response.contacts[PAIR].gap).max() < 1e-3


@pytest.mark.parametrize(("model", "options"), [("tsm", {"element": "exact"}), ("solid", {"mesh": (20, 1)})])
def test_every_model_states_critical_points_and_takes_a_branch(model, options):
    """A straight column at 1.3 times its Euler load: the solid within .5 % of the rod."""
    scene = on(loaded(-1.3 * np.pi**2 / 4, load_parameters=4), material="biot-linear")
    stopped = solve(scene, model, Options(**options))
    assert stopped.status == "BIFURCATION"
    (point,) = stopped.critical
    assert point.kind == "bifurcation"
    assert 1.3 * point.load_parameter == pytest.approx(1.0, rel=5e-3)
    unstable = solve(scene, model, Options(**options, branch="primary"))
    assert (unstable.status, unstable.completed) == ("UNSTABLE", False)
    assert unstable.index is not None
    assert unstable.index.tolist() == [0, 0, 0, 1]
    bent = solve(scene, model, Options(**options, branch="stable"))
    assert bent.completed, bent.message
    assert abs(bent.tips["cantilever"][-1, 1]) > 0.5


def test_exact_rods_end_where_the_path_ends():
    """A strut under twice Euler's load stops at the bifurcation below .5, and one under 100 EI/L^2 beside an open rough contact at once."""
    rods = solve(loaded(-(np.pi**2) / 2, load_parameters=10), "rod")
    assert (rods.status, rods.completed, len(rods.load_parameter)) == ("BIFURCATION", False, 4)
    assert rods.index is not None
    assert not rods.index.any()
    aside = replace(KS.pins[0], start=(0.5, -1.0))
    rough = (replace(KS.contacts[0], friction=0.3),)
    rods = solve(loaded(-100.0, pins=(aside,), contacts=rough, load_parameters=2), "rod")
    assert (rods.status, rods.completed, len(rods.load_parameter)) == ("BIFURCATION", False, 0)
    friction = rods.contacts[PAIR].friction
    assert friction is not None
    assert len(friction.dissipated) == 0


def test_an_answer_that_the_referee_refuses_ends_the_exact_rods(monkeypatch):
    """The forces of the third load parameter have the wrong sign: two equilibria are left."""
    pin = replace(KS.pins[0], start=(0.4, 0.0), displacement=(0.0, 0.05))
    held = support("end", kind="pinned")
    spring = SpringSpec(beam="cantilever", end="end", rotation=1e-5)
    scene = replace(KS, load_parameters=5, supports=(held,), pins=(pin,), springs=(spring,))
    answer = solve(scene, "tsm", EXACT)
    contact = answer.contacts[PAIR]
    assert contact.vector is not None
    sign = np.array([1.0, 1.0, -1.0, 1.0, 1.0])
    wrong = replace(contact, vector=contact.vector * sign[:, None])
    monkeypatch.setattr(type(TSM), "solve", lambda *_: replace(answer, contacts={PAIR: wrong}))
    rods = solve(scene, "rod")
    assert (rods.status, rods.completed, len(rods.load_parameter)) == ("NOT_AN_EQUILIBRIUM", False, 2)
    histories = (rods.contacts[PAIR].force, rods.tips["cantilever"], rods.springs[spring.node].moment)
    assert [len(one) for one in histories] == [2, 2, 2]


def stop(load: float, back: float | None = None, friction: float = 0.0) -> Scene:
    """A strip over a pin at rest under a load at its end, which a second stage changes."""
    text = STOP.replace("LOAD", str(load)) + ("" if back is None else BACK.replace("LOAD", str(back)))
    return read_scene(text.replace("FRICTION", str(friction)), "prop")


def judged(scene: Scene, model: str) -> Response:
    answer = certified(solve(scene, model, EXACT if model == "tsm" else Options()), scene, "all")
    verdict = "NOT_JUDGED" if MODELS[model].by_referee(scene) else "CERTIFIED"
    assert answer.certificate is not None
    assert (answer.certificate.verdict.name, answer.completed) == (verdict, True)
    return answer


@pytest.mark.parametrize("model", ["tsm", "rod", "solid"])
def test_a_propped_cantilever_has_the_reaction_of_statics_and_leaves_its_prop(model):
    """By linear theory the prop at a carries P (3 L - a)/(2 a) of the load at L; the strip is slender and the load small."""
    force = judged(stop(-1.0, 2.0), model).contacts[STRIP].force
    assert force[1] == pytest.approx((3.0 - 0.7) / (2.0 * 0.7), rel=2e-3)
    assert force[3] == 0.0


@pytest.mark.slow_at("rod")
@pytest.mark.parametrize("model", ["rod", "solid"])
def test_a_stick_that_begins_as_a_stage_ends_is_certified_without_an_event(model):
    """The exact rods and the solid state no event at the corner, where the slip rate jumps through zero."""
    friction = judged(stop(-100.0, 1.0, friction=0.3), model).contacts[STRIP].friction
    assert friction is not None
    assert (friction.slip[1] != 0, friction.slip[2]) == (True, 0)
