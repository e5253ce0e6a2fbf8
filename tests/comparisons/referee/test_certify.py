"""`certify` on answers that no file states: sizes of differences, bounds of the caller, sides and ends of beams, what is no equilibrium at all."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.answer import Response, Sections
from comparisons.exact import rod_under_pin
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import Distance, Verdict, certify
from comparisons.scene import ContactSpec, PinMove, PinSpec, Scene, StageSpec, load_scene
from tests.comparisons.referee.forged import bent, contact, scene_of, stated
from tests.fuzz.special import drawn_special
from tests.fuzz.world import drawn

PAIR, BEAM = "pin->cantilever", "cantilever"
KS = replace(load_scene("ks-cantilever"), load_parameters=40)


@cache
def answer(scene: Scene, elements: int = 10) -> Response:
    return solve(scene, "tsm", Options(elements=elements))


def test_the_error_of_an_answer_is_judged_to_five_digits():
    """Against the exact rod of another program: quadratures."""
    scene, response, beam = KS, answer(KS), KS.beams[0]
    path = [scene.pin("pin").position(t) for t in (0.0, *scene.times)]
    rod = rod_under_pin(path, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
    found = certify(response, scene, at=[9, 19, 39])
    assert found.certified
    for k, judgement in zip([9, 19, 39], found.judged, strict=True):
        history, size = response.contacts[PAIR], rod.magnitude[k + 1]
        assert history.vector is not None
        assert judgement.distance is not None
        assert (judgement.index, judgement.residual < 1e-13) == (0, True)
        force = np.hypot(*(history.vector[k] - rod.force[k + 1])) / size
        assert judgement.distance.sizes["force"] == pytest.approx(force, rel=1e-5)
        arc = abs(history.arc_position[k] - rod.arc_position[k + 1])
        assert judgement.distance.sizes["arc_position"] == pytest.approx(arc, rel=1e-5)
        tip = np.hypot(*(response.tips[BEAM][k] - rod.tip[k + 1]))
        assert judgement.distance.sizes["tip"] == pytest.approx(tip, rel=1e-5)
    assert certify(response, scene, at=[-1], allowance=1e-4).certified
    refused = certify(response, scene, at=[-1], allowance=1e-6)
    assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert "allowed 0.0001 %" in refused.reason


def test_round_off_chooses_no_name():
    sizes = dict.fromkeys(("arc_position", "tip", "shape", "displacement"), 0.0) | {"force": 1e-3}
    found = Distance(sizes=sizes | {"reaction": 1e-3 + 1e-12}, where={"force": PAIR}, scales=(1.0, 1.0, 1.0))
    assert found.line() == "force off by 0.1 % (pin->cantilever)"
    assert replace(found, sizes=sizes | {"reaction": 1.1e-3}).largest == ("reaction", 1.1e-3)


def bent_more(response: Response) -> Response:
    sections = response.sections
    assert sections is not None

    def larger(beam: str, k: int) -> Sections:
        there = sections(beam, k)
        return replace(there, M=1.1 * there.M)

    return replace(response, sections=larger)


IMPOSSIBLE: dict[str, tuple[Callable[[Response], Response], str]] = {
    "no load parameter": (lambda r: replace(r, load_parameter=np.zeros(0)), "NOT_JUDGED: no load parameter was reached"),
    "a support of another name": (lambda r: replace(r, supports={"other.end": r.supports["cantilever.start"]}), "the supported ends are not the scene's"),
    "a moment along the beam that is a tenth larger": (bent_more, "sections off by"),
}  # fmt: skip


@pytest.mark.parametrize("case", IMPOSSIBLE)
def test_what_is_no_answer_to_the_scene_is_refused(case):
    spoil, words = IMPOSSIBLE[case]
    found = certify(spoil(answer(KS)), KS, at=[-1])
    assert not found.certified
    assert words in found.line()


@pytest.mark.parametrize(
    ("beyond", "force", "true"),
    [(0.0, 1e-14, True), (1e-12, 1e-14, True), (1e-3, 1e-14, False), (0.0, 1e-6, False)],
)
def test_a_contact_without_force_at_a_tip_is_open(beyond, force, true):
    """A stage takes the pin back to the tip, where it touches without force; a place beyond round-off, or a force, is refused."""
    (pin,) = KS.pins
    back = StageSpec(load_parameters=2, pin=(PinMove(name=pin.name, path=(pin.points[0],)),))
    scene = replace(KS, load_parameters=4, stages=(back,))
    response = answer(scene)
    own = response.contacts[PAIR]
    assert own.vector is not None
    arc, size, vector = own.arc_position.copy(), own.force.copy(), own.vector.copy()
    arc[-1], size[-1], vector[-1] = 1.0 + beyond, force, (0.0, force)
    assert certify(contact(response, arc_position=arc, force=size, vector=vector), scene).certified == true


CORNER = 4.0 - 0.4 - np.sqrt(2.5**2 - 0.5**2)
"""Rise at which the ball touches the corner (40, -.4)."""


@pytest.mark.parametrize(
    ("x", "rise", "radius", "surface", "words"),
    [
        (40.5, CORNER - 1e-7, 2.5, "face", ""),
        (40.5, CORNER + 1e-7, 2.5, "face", "overlaps the end of the beam"),
        (42.5 + 1e-7, 4.0, 2.5, "face", ""),
        (42.5 - 1e-7, 4.0, 2.5, "face", "overlaps the end of the beam"),
        (42.5 + 1e-7, 4.0, 2.5, "axis", ""),
        (39.5, 4.2, 0.0, "face", "inside the beam"),
        (40.5, 4.2, 0.0, "face", ""),
    ],
)
def test_what_is_inside_the_end_of_a_beam_is_inadmissible(x, rise, radius, surface, words):
    """A beam that has not moved, and a ball or point at its end."""
    scene = scene_of("nose", pins=(PinSpec(name="ball", path=((x, -4.0), (x, rise - 4.0)), radius=radius or None),),
                     contacts=(ContactSpec(node="ball", beam="b", side="right", surface=surface),))  # fmt: skip
    line = np.stack([np.linspace(0.0, 40.0, 41), np.zeros(41)], axis=1)
    found = certify(stated(scene, [bent(scene, 1.0, {"b": line})]), scene, at=[0])
    assert (found.judged[0].verdict is Verdict.INADMISSIBLE) == bool(words), found.line()
    assert words in found.judged[0].reason


def weakened(response: Response, kept: list[float], factor: float) -> Response:
    """Multiply all forces away from the kept load parameters: they balance as before."""
    part = np.where(np.isin(response.load_parameter, kept), 1.0, factor)
    contacts = {
        pair: replace(item, force=part * item.force, vector=part[:, None] * item.vector)
        for pair, item in response.contacts.items()
    }
    supports = {
        end: replace(item, force=part[:, None] * item.force, moment=part * item.moment)
        for end, item in response.supports.items()
    }
    return replace(response, contacts=contacts, supports=supports, material_force={})


def test_forces_at_load_parameters_that_are_not_judged_do_the_work_that_is_stored():
    """By default two of fifty load parameters are judged; all others hold nine tenths of their forces."""
    scene = load_scene("crossed-beams")
    exact = solve(scene, "tsm", Options(element="exact"))
    right = certify(exact, scene)
    assert right.certified
    found = certify(weakened(exact, [item.load_parameter for item in right.judged], 0.9), scene)
    assert found.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert found.reason.startswith("the work of supports, pins and loads is not the strain energy")


def test_a_force_that_is_there_at_once_does_its_work_too():
    """In the first of ten steps, where the trapezoidal rule takes it for one that grows."""
    scene = drawn(2026112513)
    assert certify(solve(scene, "tsm", Options(element="exact")), scene, at=range(10)).certified


def beside(scene: Scene) -> Response:
    """The answer of a scene without its second contact, which is stated to be open all along."""
    seen = replace(scene, pins=scene.pins[:1], contacts=scene.contacts[:1])
    answer = solve(seen, "tsm", Options(element="exact"))
    (own,) = answer.contacts.values()
    nothing = np.full(scene.load_parameters, np.nan)
    away = replace(
        own, force=np.nan_to_num(nothing), arc_position=nothing, gap=nothing, vector=None, friction=None
    )
    return replace(answer, contacts={**answer.contacts, scene.contacts[1].pair: away})


@pytest.mark.parametrize("rubbed", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_node_that_goes_through_a_beam_near_its_end_is_followed(rubbed):
    """By straight lines between load parameters it passes .8 mm past the end; on its way it is 12 mm inside. Then it is beyond the end."""
    scene = replace(drawn_special(26112600), load_parameters=3)
    if not rubbed:
        scene = replace(scene, contacts=tuple(replace(item, friction=0.0) for item in scene.contacts))
        assert certify(solve(scene, "tsm", Options(element="exact")), scene).certified
    forged = beside(scene)
    words = "INADMISSIBLE: p1->b2 is open and its node goes through the beam up to load parameter 0.333333"
    assert certify(forged, scene).line().startswith(words)
    words = "NOT_JUDGED: the path up to load parameter 0.333333 is not found, on which the node of p1->b2"
    assert certify(replace(forged, events=None), scene).line().startswith(words)
