"""Scenes that the certificate once refused wrongly, reduced to what refused them, and answers beside them that it must refuse."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import SearchStatus, Verdict, answer_state, certify, equilibrium
from comparisons.scene import LoadSpec, PinSpec, Scene, StageSpec, load_scene
from tests.comparisons.referee.forged import bent, scene_of, seen, stated, support

EXACT = Options(element="exact")

CORNER = replace(
    load_scene("hysteresis"),
    load_parameters=1,
    pins=(PinSpec(name="pin", path=((80.0, -2.0), (60.0, 18.0), (80.0, 20.0))),),
)
"""A touch, a slip with the pin to the clamp, and one back from the corner of its path, all before the only load parameter."""
NEXT_TO_AN_END = replace(load_scene("cantilever-critical-area"), load_parameters=200)
"""At .985 the pin is a thousandth of the length from the tip, and slips off at .9897."""
TRUE: dict[str, tuple[Scene, str, float | None, tuple[int, ...] | None]] = {
    "passing": (scene_of("passing"), "exact", 1e-6, tuple(range(10))),
    "coarse": (scene_of("coarse"), "exact", 1e-6, tuple(range(7))),
    "round": (scene_of("round"), "exact", 1e-6, tuple(range(3))),
    "soft": (scene_of("soft"), "exact", 1e-6, tuple(range(5))),
    "stiff": (scene_of("stiff"), "exact", 1e-6, tuple(range(2))),
    "corner": (CORNER, "exact", None, None),
    "next to an end": (NEXT_TO_AN_END, "mixed", None, (196,)),
}
"""A scene, the element that answers, the allowance, and the load parameters that are judged."""


@pytest.mark.slow_at("passing", "coarse", "soft", "corner")
@pytest.mark.parametrize("name", TRUE)
def test_a_true_answer_is_certified(name):
    scene, element, allowance, at = TRUE[name]
    response = solve(scene, "tsm", Options(element=element))
    assert response.completed, response.message
    found = certify(response, scene, at=at, allowance=allowance)
    assert found.certified, found.line()
    assert name != "next to an end" or found.judged[0].distance.sizes["arc_position"] < 1e-5
    if name == "passing":
        order = [
            [judgement.exact.contacts[pair].arc_position for pair in ("a.start->c", "q->c")]
            for judgement in found.judged[4:6]
        ]
        assert (order[0][0] < order[0][1]) != (order[1][0] < order[1][1])


def test_a_moment_that_changes_its_sign_is_judged_by_the_largest_of_the_path():
    """At t = .88 the clamp moment vanishes: its error of 15 % there is below 3 % of the largest moment."""
    scene = load_scene("ks-tied-tip")
    response = solve(scene, "tsm", Options(element="timoshenko", elements=20))
    k = int(np.argmin(np.abs(response.load_parameter - 0.88)))
    assert not certify(response, scene, at=[k], allowance=0.05).certified
    assert certify(response, scene, at=[k, -1], allowance=0.05).certified


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_round_off_of_an_unloaded_beam_is_no_error(element):
    scene = scene_of("unloaded")
    response = solve(scene, "tsm", Options(element=element))
    found = certify(response, scene, at=range(5), allowance=1e-6)
    assert found.line().startswith("NOT_JUDGED: nothing to judge"), found.line()
    forged = support(response, force=response.supports["b.start"].force + np.array([0.0, 0.01]))
    assert certify(forged, scene).verdict is Verdict.NOT_AN_EQUILIBRIUM


@pytest.mark.parametrize(
    ("apart", "to", "words"), [(0.0, -0.1, "are at one place"), (1e-3, 0.1, "come to one place")]
)
def test_two_contacts_at_one_place_are_no_equilibrium(apart, to, words):
    scene = scene_of("one-place")
    scene = replace(scene, pins=(scene.pins[0], replace(scene.pins[1], path=((0.5, 0.0), (0.5, to)))))
    arcs, forces = {"p->b": 0.5, "q->b": 0.5 + apart}, {"p->b": (0.0, 0.0), "q->b": (0.0, 0.0)}
    given = seen(scene, 0.5, arcs=arcs, forces=forces)
    found = equilibrium(scene, given)
    assert found.status is (SearchStatus.NO_EQUILIBRIUM if apart else SearchStatus.NOT_JUDGED)
    assert words in found.message


@pytest.mark.slow
def test_both_branches_of_a_symmetric_bifurcation_are_right():
    """The straight path ends there, and the bent branches lead back to it."""
    whole = scene_of("column", load_parameters=3, pins=(), contacts=())
    scene = replace(whole, beams=whole.beams[:1], supports=(replace(whole.supports[0], rotation=0.0),))
    x = np.linspace(0.0, 1.0, 201)
    path = []
    for t in scene.times:
        # the shortening beyond the critical one, .0298, is (pi a)^2/4 of a wave a/2 (1 - cos 2 pi x)
        a = 2.0 / np.pi * np.sqrt(max(0.0626 * t - 0.0298, 0.0))
        wave = np.stack([x * (1.0 - 0.0626 * t), a / 2.0 * (1.0 - np.cos(2.0 * np.pi * x))], axis=1)
        path.append(bent(scene, t, {"b": wave}))
    assert path[-1].shape("b", np.array([0.5])).position[0, 1] > 0.1
    for at in (None, range(3)):
        found = certify(stated(scene, path), scene, at=at)
        assert found.certified, found.line()


@pytest.mark.slow
def test_the_other_side_of_a_column_is_another_branch_also_through_a_touch():
    """A pin touches an arm beside the column, before the only load parameter; the column stands on its other branch, of index 0 too."""
    scene = scene_of("column")
    true = solve(scene, "tsm", EXACT)
    assert float(true.supports["b.start"].moment[-1]) == pytest.approx(174.945, abs=0.01)
    assert true.events is not None
    assert [event.kind for event in true.events] == ["touch"]
    found = certify(true, scene)
    assert found.certified, found.line()
    answer = answer_state(true, scene, -1)
    axes = {**answer.axes, "b": (answer.axes["b"][0], answer.axes["b"][1] * [1.0, -1.0])}
    wrong = equilibrium(scene, replace(answer, axes=axes, reactions={}))
    assert wrong.index == 0
    assert wrong.contacts["pin->arm"].push == pytest.approx(float(true.contacts["pin->arm"].force[-1]))
    found = certify(replace(stated(scene, [wrong]), events=true.events), scene)
    assert found.verdict is Verdict.UNSTABLE
    assert "ends on another branch at 1, 0.67 L away" in found.reason


@pytest.mark.slow
def test_the_path_to_the_other_side_of_a_column_is_not_followed():
    """Both sides are stable, and less than a tenth of the length apart."""
    buckles = np.pi**2 / 4.0  # without stretch and shear
    push = LoadSpec(beam="cantilever", end="end", force=(-buckles * 1.0001, 0.0))
    rest = replace(push, force=(-buckles * 1e-5, 0.0))
    column = scene_of(
        "arc", load_parameters=2, loads=(push,), stages=(StageSpec(load_parameters=1, load=(rest,)),)
    )
    arc = np.linspace(0.0, 1.0, 41)
    bow = 0.025 * (1.0 - np.cos(np.pi * arc / 2.0))
    axes = [np.stack([arc, side * bow], axis=1) for side in (0.0, 1.0, -1.0)]
    straight, left, right = (
        bent(column, t, {"cantilever": line}) for t, line in zip((0.5, 1.0, 2.0), axes, strict=True)
    )
    same = bent(column, 2.0, {"cantilever": axes[1]})
    assert 0.02 < np.hypot(*(same.ends["cantilever.end"] - right.ends["cantilever.end"])) < 0.1
    for last, words in ((same, ""), (right, "ends on another branch")):
        found = certify(stated(column, [straight, left, last]), column, at=[1, 2])
        assert found.certified is not bool(words), found.line()
        assert words in found.line()
