"""True answers are certified, and every seeded fault and forged answer is refused, with the verdict that belongs to it."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from comparisons.exact.rod import rod_under_pin
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import Verdict, certify, equilibrium
from comparisons.response import ContactHistory, Response, SupportHistory
from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    LoadSpec,
    PinMove,
    PinSpec,
    Scene,
    StageSpec,
    SupportSpec,
    load_scene,
)
from tests.comparisons.referee.forged import bent, integrated, stated

PAIR, BEAM, CLAMP = "pin->cantilever", "cantilever", "cantilever.start"
KS = replace(load_scene("ks-cantilever"), load_parameters=40)
FACE = replace(load_scene("ks-face"), load_parameters=40)


@cache
def answer(scene: Scene, elements: int = 10) -> Response:
    return solve(scene, "tsm", Options(elements=elements))


def contact(response: Response, pair: str = PAIR, **changes: object) -> Response:
    history: ContactHistory = replace(response.contacts[pair], **changes)  # type: ignore[arg-type]
    return replace(response, contacts={**response.contacts, pair: history})


def support(response: Response, node: str = CLAMP, **changes: object) -> Response:
    history: SupportHistory = replace(response.supports[node], **changes)  # type: ignore[arg-type]
    return replace(response, supports={**response.supports, node: history})


@pytest.mark.parametrize(
    "name",
    [
        "ks-cantilever",
        "ks-tied-tip",
        *(
            pytest.param(n, marks=pytest.mark.slow)
            for n in ("ks-face", "cantilever-critical-area", "double-beam")
        ),
    ],
)
def test_mixed_with_ten_elements_is_certified(name: str) -> None:
    scene = load_scene(name)
    if not name.startswith(("double", "cantilever")):
        scene = replace(scene, load_parameters=10)
    found = certify(answer(scene), scene)
    assert found.certified, found.line()
    assert found.judged[-1].index == 0
    assert found.judged[-1].residual < 1e-13


@pytest.mark.parametrize(
    "elements", [10, pytest.param(5, marks=pytest.mark.slow), pytest.param(20, marks=pytest.mark.slow)]
)
def test_the_error_of_mixed_is_judged_to_five_digits(elements: int) -> None:
    """Against the exact rod of another program: quadratures."""
    response, beam = answer(KS, elements), KS.beams[0]
    path = [KS.pin("pin").position(t) for t in (0.0, *KS.times)]
    rod = rod_under_pin(path, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
    found = certify(response, KS, at=[9, 19, 39])
    for k, judgement in zip([9, 19, 39], found.judged, strict=True):
        history, size = response.contacts[PAIR], rod.magnitude[k + 1]
        assert history.vector is not None
        assert judgement.distance is not None
        force = np.hypot(*(history.vector[k] - rod.force[k + 1])) / size
        assert judgement.distance.force == pytest.approx(force, rel=1e-5)
        arc = abs(history.arc_position[k] - rod.arc_position[k + 1])
        assert judgement.distance.arc_position == pytest.approx(arc, rel=1e-5)
        tip = np.hypot(*(response.tips[BEAM][k] - rod.tip[k + 1]))
        assert judgement.distance.tip == pytest.approx(tip, rel=1e-5)


def tripled(r: Response) -> Response:
    vector, force = r.contacts[PAIR].vector, r.contacts[PAIR].force
    assert vector is not None
    r = contact(r, force=3.0 * force, vector=3.0 * vector)
    return support(r, force=3.0 * r.supports[CLAMP].force, moment=3.0 * r.supports[CLAMP].moment)


def turned(r: Response) -> Response:
    """All contact forces by 45 degrees, with the reactions that balance them."""
    vector = r.contacts[PAIR].vector
    assert vector is not None
    new = vector @ np.array([[1.0, 1.0], [-1.0, 1.0]]) / math.sqrt(2.0)
    pins = np.array([KS.pin("pin").position(float(t)) for t in r.load_parameter])
    return support(contact(r, vector=new), force=-new, moment=pins[:, 1] * new[:, 0] - pins[:, 0] * new[:, 1])


def lost(r: Response) -> Response:
    """No force from the beginning, and the beam straight."""
    steps, arc = len(r.load_parameter), np.linspace(0.0, 1.0, 11)
    r = contact(
        r,
        force=np.zeros(steps),
        vector=np.zeros((steps, 2)),
        arc_position=np.full(steps, np.nan),
        gap=np.full(steps, np.nan),
    )
    r = support(r, force=np.zeros((steps, 2)), moment=np.zeros(steps))
    straight = np.stack([arc, 0.0 * arc], axis=1)
    return replace(
        r,
        events=(),
        sections=None,
        material_force={},
        axis_line=lambda _, __: (arc, straight),
        tips={BEAM: np.tile([1.0, 0.0], (steps, 1))},
    )


def stale(r: Response) -> Response:
    """Every state that of the load parameter before."""
    late = np.maximum(np.arange(len(r.load_parameter)) - 1, 0)
    one, held = r.contacts[PAIR], r.supports[CLAMP]
    assert one.vector is not None
    r = contact(r, force=one.force[late], arc_position=one.arc_position[late], vector=one.vector[late])
    r = support(r, force=held.force[late], moment=held.moment[late])
    line = r.axis_line
    return replace(r, tips={BEAM: r.tips[BEAM][late]}, axis_line=lambda beam, k: line(beam, int(late[k])))


def without_lever(r: Response) -> Response:
    """The moment of the support as if the contact force acted on the axis of the undeformed beam, half a height away."""
    vector = r.contacts[PAIR].vector
    assert vector is not None
    return support(r, moment=r.supports[CLAMP].moment + 0.01 * vector[:, 0])


def pulling(r: Response) -> Response:
    vector, force = r.contacts[PAIR].vector, r.contacts[PAIR].force
    assert vector is not None
    return contact(r, force=-force, vector=-vector)


FORGED: dict[str, tuple[Scene, Callable[[Response], Response], Verdict]] = {
    "forces tripled": (KS, tripled, Verdict.NOT_AN_EQUILIBRIUM),
    "force turned by 45 degrees": (KS, turned, Verdict.NOT_AN_EQUILIBRIUM),
    "all arc positions .3": (KS, lambda r: contact(r, arc_position=np.full(40, 0.3)), Verdict.NOT_AN_EQUILIBRIUM),
    "tip moved by 7": (KS, lambda r: replace(r, tips={BEAM: r.tips[BEAM] + 7.0}), Verdict.NOT_AN_EQUILIBRIUM),
    "lost contact": (KS, lost, Verdict.INADMISSIBLE),
    "claimed slip-off": (KS, lambda r: contact(lost(r), slip_off=0.1), Verdict.INADMISSIBLE),
    "pulling force": (KS, pulling, Verdict.NOT_AN_EQUILIBRIUM),
    "stale result": (KS, stale, Verdict.NOT_AN_EQUILIBRIUM),
    "missing moment of an offset": (FACE, without_lever, Verdict.NOT_AN_EQUILIBRIUM),
    "reaction off by 1e-5": (KS, lambda r: support(r, force=r.supports[CLAMP].force * (1.0 + 1e-5)), Verdict.NOT_AN_EQUILIBRIUM),
    "closed without an event": (KS, lambda r: contact(r, force=np.where(r.load_parameter == 0.5, 0.0, r.contacts[PAIR].force)), Verdict.NOT_AN_EQUILIBRIUM),
    "not a number": (KS, lambda r: replace(r, tips={BEAM: r.tips[BEAM] * np.nan}), Verdict.NOT_AN_EQUILIBRIUM),
    "other load parameters": (KS, lambda r: replace(r, load_parameter=r.load_parameter * 0.999), Verdict.NOT_AN_EQUILIBRIUM),
    "pair of another name": (KS, lambda r: replace(r, contacts={"other->beam": r.contacts[PAIR]}), Verdict.NOT_AN_EQUILIBRIUM),
}  # fmt: skip


def test_the_true_answers_that_are_forged_are_certified() -> None:
    assert certify(answer(KS), KS).certified
    assert certify(answer(FACE), FACE).certified


@pytest.mark.parametrize("case", FORGED)
def test_forged_answers_are_refused(case: str) -> None:
    scene, forge, verdict = FORGED[case]
    found = certify(forge(answer(scene)), scene)
    assert found.verdict is verdict, found.line()


PORTAL = Scene(
    name="portal",
    load_parameters=4,
    beams=(
        BeamSpec(name="left", start=(0.0, 0.0), end=(0.0, 4.0), area=0.0054, second_moment=8.36e-5, youngs_modulus=2.1e8,
                 poissons_ratio=0.3, clamped=("start",)),
        BeamSpec(name="girder", start=(0.0, 4.0), end=(6.0, 4.0), area=0.0054, second_moment=8.36e-5, youngs_modulus=2.1e8,
                 poissons_ratio=0.3),
        BeamSpec(name="right", start=(6.0, 4.0), end=(6.0, 0.0), area=0.0054, second_moment=8.36e-5, youngs_modulus=2.1e8,
                 poissons_ratio=0.3),
    ),
    supports=(SupportSpec(beam="right", end="end", kind="clamped"),),
    loads=(LoadSpec(beam="left", end="end", force=(50.0, 0.0)), LoadSpec(beam="girder", end="end", force=(0.0, -20.0))),
)  # fmt: skip
"""A frame in kN and m, whose second foot is clamped."""


def test_a_frame_is_certified() -> None:
    assert certify(answer(PORTAL), PORTAL, at=range(4)).certified


def test_a_pin_on_the_other_side_pulls() -> None:
    """The true forces, of a scene whose pin was to come from the left."""
    away = replace(KS, contacts=(replace(KS.contacts[0], side="left"),))
    found = certify(answer(KS), away, at=[-1])
    assert found.verdict is Verdict.INADMISSIBLE
    assert "pulls" in found.judged[0].reason


def test_a_pin_that_went_through_between_load_parameters_is_refused() -> None:
    path = ((0.5, 0.01), (0.5, -0.2))
    scene = replace(
        KS,
        pins=(PinSpec(name="pin", path=path),),
        contacts=(ContactSpec(node="pin", beam=BEAM, side="left"),),
        load_parameters=40,
    )
    forged = lost(answer(KS))
    found = certify(forged, scene)
    assert found.judged[-1].verdict is Verdict.CERTIFIED
    assert found.verdict is Verdict.INADMISSIBLE
    assert "goes through the beam" in found.reason


def test_a_pin_may_come_around_the_end() -> None:
    scene = replace(KS, pins=(PinSpec(name="pin", path=((1.2, 0.01), (1.2, -0.1), (0.6, -0.1))),),
                    contacts=(ContactSpec(node="pin", beam=BEAM, side="left"),))  # fmt: skip
    found = certify(lost(answer(KS)), scene)
    assert found.path == ()
    assert found.line().startswith("NOT_JUDGED: nothing to judge: no load")


def column(load: float) -> Scene:
    beam = BeamSpec(name="b", start=(0.0, 0.0), end=(300.0, 0.0), clamped=("start",), width=25.0, height=1.0,
                    youngs_modulus=210000.0, poissons_ratio=0.3)  # fmt: skip
    push = LoadSpec(beam="b", end="end", force=(-load, 0.001))
    return Scene(name="column", units="N, mm", load_parameters=2, beams=(beam,), loads=(push,))


def test_the_straight_branch_of_a_column_is_unstable_and_the_bent_one_is_not() -> None:
    """Euler's load is 12 N; at 100 N the tip is at (-167.2, 132.2), by an independent program."""
    scene, arc = column(100.0), np.linspace(0.0, 300.0, 31)
    straight = stated(scene, [bent(scene, t, {"b": np.stack([arc, 0.0 * arc], axis=1)}) for t in (0.5, 1.0)])
    found = certify(straight, scene)
    assert found.verdict is Verdict.UNSTABLE
    assert found.judged[0].index == 1
    true = equilibrium(scene, integrated(scene, 1.0, (100.0, -0.001, -13219.6), []))
    assert true.ends["b.end"] == pytest.approx([-167.2, 132.2], abs=0.05)
    assert true.index == 0


DRUM = Scene(
    name="drum",
    load_parameters=1,
    beams=(BeamSpec(name="strip", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=0.02, height=0.005,
                    youngs_modulus=4.8e9, poissons_ratio=0.3),),
    loads=(LoadSpec(beam="strip", end="end", force=(0.0, -12.0)),),
    pins=(PinSpec(name="drum", path=((0.3, -0.6), (0.3, -0.5025)), radius=0.5),),
    contacts=(ContactSpec(node="drum", beam="strip", side="right", surface="face"),),
)  # fmt: skip


def test_a_beam_inside_a_round_pin_is_inadmissible() -> None:
    """One point of contact at twelve newtons, force 19.10 N, is an equilibrium: of a beam inside the drum."""
    clamp, force = (-10.6497381, -3.8581417, -0.31546992), np.array([10.6497381, 15.8581417])
    given = integrated(DRUM, 1.0, clamp, [("drum->strip", 0.5953638585, force)])
    exact = equilibrium(DRUM, given)
    assert exact.contacts["drum->strip"].push == pytest.approx(19.10229, rel=1e-6)
    found = certify(stated(DRUM, [exact]), DRUM)
    assert found.verdict is Verdict.INADMISSIBLE
    assert "round pin" in found.reason


def test_the_allowance_is_the_callers() -> None:
    response = answer(KS, 10)
    assert certify(response, KS, allowance=1e-4).certified
    refused = certify(response, KS, allowance=1e-6)
    assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert "allowed 0.0001 %" in refused.reason


def test_nothing_reached_is_not_judged() -> None:
    cut = replace(answer(KS), load_parameter=np.zeros(0))
    assert certify(cut, KS).verdict is Verdict.NOT_JUDGED


@pytest.mark.parametrize(
    ("beyond", "force", "true"),
    [(0.0, 1e-14, True), (1e-12, 1e-14, True), (1e-3, 1e-14, False), (0.0, 1e-6, False)],
)
def test_a_contact_without_force_at_a_tip_is_open(beyond: float, force: float, true: bool) -> None:
    """A stage takes the pin back to the tip, where it touches without force; a place beyond round-off, or a force, is refused."""
    (pin,) = KS.pins
    back = StageSpec(load_parameters=2, pin=(PinMove(name=pin.name, path=(pin.points[0],)),))
    scene = replace(KS, load_parameters=4, stages=(back,))
    response = answer(scene)
    arc, size, vector = (
        np.copy(getattr(response.contacts[PAIR], name)) for name in ("arc_position", "force", "vector")
    )
    arc[-1], size[-1], vector[-1] = 1.0 + beyond, force, (0.0, force)
    assert certify(contact(response, arc_position=arc, force=size, vector=vector), scene).certified == true
