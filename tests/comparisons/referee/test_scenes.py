"""Scenes that the certificate once refused wrongly, reduced to what refused them, and answers beside them that it must refuse."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import (
    AnswerState,
    SearchStatus,
    Verdict,
    answer_state,
    certify,
    equilibrium,
)
from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    LoadSpec,
    PinSpec,
    Scene,
    StageSpec,
    SupportSpec,
    load_scene,
    read_scene,
)
from tests.comparisons.referee.forged import bent, stated, support

EXACT = Options(element="exact")

PASSING = Scene(
    name="passing", units="N, mm", load_parameters=10,
    beams=(
        BeamSpec(name="a", start=(2.5, 0.0), end=(2.5, -1.0), elements=20, youngs_modulus=7e10, poissons_ratio=0.0,
                 width=0.004084450209781099, height=0.004084450209781099, clamped=("end",)),
        BeamSpec(name="c", start=(2.5500000000000003, 0.10000000000000009), end=(2.55, -1.0), elements=40, youngs_modulus=7e10,
                 poissons_ratio=-0.3, width=0.004492895230759209, height=0.004492895230759209, clamped=("end",)),
    ),
    pins=(
        PinSpec(name="p", path=((2.5, -0.25), (2.655512582278996, -0.3729026236560623))),
        PinSpec(name="q", radius=0.1617877490469476, path=(
            (2.7140341966624915, -0.22456092191864085), (2.581951177857461, -0.22456092191864085),
            (2.4016169694722405, -0.22456092191864085), (2.2542935149111654, -0.13503943566858267))),
    ),
    contacts=(
        ContactSpec(node="a.start", beam="c", side="right", surface="face"),
        ContactSpec(node="p", beam="a", side="right"),
        ContactSpec(node="q", beam="c", side="left", surface="face"),
    ),
)  # fmt: skip
"""A beam's end and a drum, on both sides of the other beam, pass each other between t = .5 and .6."""

COARSE = Scene(
    name="coarse", units="N, m", load_parameters=7,
    beams=(
        BeamSpec(name="a", start=(3.0472245720759594, -1.2188898288303838), end=(3.0472245720759594, 0.0), elements=40,
                 youngs_modulus=417.67109455749693, poissons_ratio=0.0, width=0.12498585903689896, height=0.016026061421950854,
                 clamped=("start",)),
        BeamSpec(name="c", start=(3.0594134703642633, 0.7313338972982304), end=(3.0594134703642633, -1.0970008459473455), elements=16,
                 youngs_modulus=417.67109455749693, poissons_ratio=0.49, width=0.024039092132926283, height=0.024039092132926283,
                 clamped=("start",)),
    ),
    pins=(PinSpec(name="p", path=(
        (3.027022643076672, -0.755245253948098), (3.275174622981432, -0.755245253948098),
        (3.4341556495056285, -0.755245253948098), (3.753896989504159, -1.005823156114159))),),
    contacts=(
        ContactSpec(node="a.end", beam="c", side="right", surface="face"),
        ContactSpec(node="p", beam="a", side="left", surface="face"),
    ),
)  # fmt: skip
"""Large deflections in seven load parameters: the trapezoidal rule for the work is wrong by 8e-7 J."""

UNLOADED = Scene(
    name="unloaded", units="N, mm", load_parameters=5,
    beams=(BeamSpec(name="b", start=(5919.2127, 9300.0), end=(6072.3531, 9000.0), width=0.1775, height=0.1775,
                    youngs_modulus=7e10, poissons_ratio=0.3),),
    supports=(SupportSpec(beam="b", end="start", kind="clamped", displacement=(-13.714315813717675, -3.0)),),
)  # fmt: skip
"""EA is 2.2e9 N, so that rounded positions alone make forces of 1e-7 N, where EI/L^2 is 50 N."""

ROUND = Scene(
    name="round", units="N, m", load_parameters=3,
    beams=(BeamSpec(name="b", start=(58.43336646652061, 87.65004969978091), end=(61.2245428249164, 88.5134617264861),
                    youngs_modulus=7e10, shear_modulus=7e10, area=0.03717240645685161, second_moment=0.00011514898348278196,
                    shear_area=0.3099739075629985, clamped=("start",), elements=20),),
    loads=(LoadSpec(beam="b", end="end", force=(90430.5902172177, -292337.5140525544)),),
    pins=(PinSpec(name="p", radius=0.8974181262288741, path=(
        (60.41172697170489, 87.3226544579501), (60.355217762763736, 87.50533336807611),
        (59.70450565215861, 88.34521200338074), (59.54014390556148, 89.08919690121566))),),
    contacts=(ContactSpec(node="p", beam="b", side="right"),),
)  # fmt: skip
"""The shear force bends the axis sharply under a round pin, by F/GA = 3e-4."""

SOFT = Scene(
    name="soft", units="N, mm", load_parameters=5,
    beams=(BeamSpec(name="b", start=(3.5, -1.0), end=(2.5, -1.0), youngs_modulus=54447.29243126211,
                    shear_modulus=54447.29243126211, area=3.308340370476558e-05, second_moment=9.120930005770807e-11,
                    shear_area=5.90198633809987e-09, elements=40),),
    supports=(
        SupportSpec(beam="b", end="end", kind="pinned"),
        SupportSpec(beam="b", end="start", kind="pinned", displacement=(-0.0015443120446399245, 0.001)),
    ),
    pins=(PinSpec(name="p", path=((2.5, -1.0), (2.8894937540625047, -0.8913178746620373))),),
    contacts=(ContactSpec(node="p", beam="b", side="left"),),
)  # fmt: skip
"""GA is so small that the sections' directions are not those of the axis: N/GA is up to 2."""

STIFF = Scene(
    name="stiff", units="N, m", load_parameters=2,
    beams=(
        BeamSpec(name="a", start=(1036.6009467376819, -211.34393800159813), end=(750.0, -300.0), elements=20,
                 youngs_modulus=56883171131.90417, poissons_ratio=0.49, width=14.108418920459108, height=1.666173073714285),
        BeamSpec(name="c", start=(868.1010851269302, -263.46705325200855), end=(649.4333758570735, -17.083421886847816),
                 elements=16, youngs_modulus=170649513395.7125, poissons_ratio=0.3, width=0.9147968829339713,
                 height=0.9147968829339713),
    ),
    supports=(
        SupportSpec(beam="a", end="end", kind="clamped"),
        SupportSpec(beam="a", end="start", kind="pinned"),
        SupportSpec(beam="c", end="end", kind="clamped", displacement=(0.8865606199840186, -2.866009467376818)),
    ),
    contacts=(ContactSpec(node="c.start", beam="a", side="right"),),
)  # fmt: skip
"""Small forces in beams of large EA: Newton's corrections end at round-off of EA."""


CORNER = replace(
    load_scene("hysteresis"),
    load_parameters=1,
    pins=(PinSpec(name="pin", path=((80.0, -2.0), (60.0, 18.0), (80.0, 20.0))),),
)
"""A touch, a slip with the pin to the clamp, and one back from the corner of its path, all before the only load parameter."""
NEXT_TO_AN_END = replace(load_scene("cantilever-critical-area"), load_parameters=200)
"""At .985 the pin is a thousandth of the length from the tip, and slips off at .9897."""
TRUE: dict[str, tuple[Scene, str, float | None, tuple[int, ...] | None]] = {
    "passing": (PASSING, "exact", 1e-6, tuple(range(10))),
    "coarse": (COARSE, "exact", 1e-6, tuple(range(7))),
    "round": (ROUND, "exact", 1e-6, tuple(range(3))),
    "soft": (SOFT, "exact", 1e-6, tuple(range(5))),
    "stiff": (STIFF, "exact", 1e-6, tuple(range(2))),
    "corner": (CORNER, "exact", None, None),
    "next to an end": (NEXT_TO_AN_END, "mixed", None, (196,)),
}
"""A scene, the element that answers, the allowance, and the load parameters that are judged."""


@pytest.mark.slow_at("passing", "coarse", "soft", "corner")
@pytest.mark.parametrize("name", TRUE)
def test_a_true_answer_is_certified(name: str) -> None:
    scene, element, allowance, at = TRUE[name]
    response = solve(scene, "tsm", Options(element=element))
    assert response.completed, response.message
    found = certify(response, scene, at=at, allowance=allowance)
    assert found.certified, found.line()
    assert name != "next to an end" or found.judged[0].distance.arc_position < 1e-5
    if name == "passing":
        order = [
            [judgement.exact.contacts[pair].arc_position for pair in ("a.start->c", "q->c")]
            for judgement in found.judged[4:6]
        ]
        assert (order[0][0] < order[0][1]) != (order[1][0] < order[1][1])


def test_a_moment_that_changes_its_sign_is_judged_by_the_largest_of_the_path() -> None:
    """At t = .88 the clamp moment vanishes: its error of 15 % there is below 3 % of the largest moment."""
    scene = load_scene("ks-tied-tip")
    response = solve(scene, "tsm", Options(element="timoshenko", elements=20))
    k = int(np.argmin(np.abs(response.load_parameter - 0.88)))
    assert not certify(response, scene, at=[k], allowance=0.05).certified
    assert certify(response, scene, at=[k, -1], allowance=0.05).certified


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_round_off_of_an_unloaded_beam_is_no_error(element: str) -> None:
    response = solve(UNLOADED, "tsm", Options(element=element))
    found = certify(response, UNLOADED, at=range(5), allowance=1e-6)
    assert found.line().startswith("NOT_JUDGED: nothing to judge"), found.line()
    forged = support(response, force=response.supports["b.start"].force + np.array([0.0, 0.01]))
    assert certify(forged, UNLOADED).verdict is Verdict.NOT_AN_EQUILIBRIUM


@pytest.mark.parametrize(
    ("apart", "to", "status", "words"),
    [
        (
            0.0,
            -0.1,
            SearchStatus.NOT_JUDGED,
            'two contacts on beam "b", or a contact and an end, are at one place',
        ),
        (1e-3, 0.1, SearchStatus.NO_EQUILIBRIUM, "come to one place"),
    ],
)
def test_two_contacts_at_one_place_are_no_equilibrium(
    apart: float, to: float, status: SearchStatus, words: str
) -> None:
    """Two pins on both sides of a beam, in one place or on the way to it."""
    beam = BeamSpec(name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), width=0.02, height=0.02,
                    youngs_modulus=1e7, poissons_ratio=0.3)  # fmt: skip
    scene = Scene(
        name="one-place", load_parameters=1, beams=(beam,),
        pins=(PinSpec(name="p", path=((0.5, 0.0), (0.5, 0.1))), PinSpec(name="q", path=((0.5, 0.0), (0.5, to)))),
        contacts=(ContactSpec(node="p", beam="b", side="right"), ContactSpec(node="q", beam="b", side="left")),
    )  # fmt: skip
    given = AnswerState(
        load_parameter=0.5, arcs={"p->b": 0.5, "q->b": 0.5 + apart}, forces={"p->b": (0.0, 0.0), "q->b": (0.0, 0.0)},
        axes={"b": (np.array([0.0, 1.0]), np.array([[0.0, 0.0], [1.0, 0.0]]))}, reactions={}, tips={},
    )  # fmt: skip
    found = equilibrium(scene, given)
    assert found.status is status
    assert words in found.message


COLUMN = """
scene = {{ name = "column", load_parameters = {steps} }}
[[beam]]
name = "b"
start = [0, 0]
end = [1, 0]
clamped = ["start"]
width = {height}
height = {height}
youngs_modulus = 1e7
poissons_ratio = 0.25
[[support]]
beam = "b"
end = "end"
kind = "clamped"
displacement = [{short}, 0]
rotation = {turn}
"""
TOUCHED = """
[[beam]]
name = "arm"
start = [0, 1]
end = [1, 1]
clamped = ["start"]
width = 0.1
height = 0.1
youngs_modulus = 1e7
poissons_ratio = 0.25
[[pin]]
name = "pin"
start = [0.6, 0.98]
displacement = [0, 0.05]
[[contact]]
node = "pin"
beam = "arm"
side = "right"
"""


def column(
    steps: int, *, turn: float = 0.01, short: float = -0.0626, height: float = 0.1, more: str = ""
) -> Scene:
    """A column between two clamps, one of which moves in and turns."""
    return read_scene(COLUMN.format(steps=steps, turn=turn, short=short, height=height) + more, "column")


def test_both_branches_of_a_symmetric_bifurcation_are_right() -> None:
    """The straight path ends there, and the bent branches lead back to it."""
    scene = column(3, turn=0.0)
    x = np.linspace(0.0, 1.0, 201)
    path = []
    for t in scene.times:
        # the shortening beyond the critical one, .0298, is (pi a)^2/4 of a wave a/2 (1 - cos 2 pi x)
        a = 2.0 / np.pi * np.sqrt(max(0.0626 * t - 0.0298, 0.0))
        path.append(
            bent(
                scene,
                t,
                {"b": np.stack([x * (1.0 - 0.0626 * t), a / 2.0 * (1.0 - np.cos(2.0 * np.pi * x))], axis=1)},
            )
        )
    assert path[-1].shape("b", np.array([0.5])).position[0, 1] > 0.1
    for at in (None, range(3)):
        found = certify(stated(scene, path), scene, at=at)
        assert found.certified, found.line()


def test_the_other_side_of_a_column_is_another_branch_also_through_a_touch() -> None:
    """A pin touches an arm beside the column, before the only load parameter; the column stands on its other branch, of index 0 too."""
    scene = column(1, more=TOUCHED)
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


STRIP = BeamSpec(name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), area=1.0, second_moment=1e-4,
                 shear_area=1.0, youngs_modulus=1e4, shear_modulus=1e4)  # fmt: skip


def test_the_path_to_the_other_side_of_a_column_is_not_followed() -> None:
    """Both sides are stable, and less than a tenth of the length apart."""
    buckles = np.pi**2 / 4.0  # without stretch and shear
    column = Scene(
        name="column",
        load_parameters=2,
        beams=(STRIP,),
        loads=(LoadSpec(beam="b", end="end", force=(-buckles * 1.0001, 0.0)),),
        stages=(
            StageSpec(
                load_parameters=1,
                load=(LoadSpec(beam="b", end="end", force=(-buckles * 1e-5, 0.0)),),
            ),
        ),
    )
    arc = np.linspace(0.0, 1.0, 41)
    bow = 0.025 * (1.0 - np.cos(np.pi * arc / 2.0))
    axes = [np.stack([arc, side * bow], axis=1) for side in (0.0, 1.0, -1.0)]
    straight, left, right = (
        bent(column, t, {"b": line}) for t, line in zip((0.5, 1.0, 2.0), axes, strict=True)
    )
    same = bent(column, 2.0, {"b": axes[1]})
    assert 0.02 < np.hypot(*(same.ends["b.end"] - right.ends["b.end"])) < 0.1
    for last, words in ((same, ""), (right, "ends on another branch")):
        found = certify(stated(column, [straight, left, last]), column, at=[1, 2])
        assert found.certified is not bool(words), found.line()
        assert words in found.line()
