"""The referee's index against critical loads in closed form, on both sides of each; a column of many beams; a fold."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from comparisons.referee import AnswerState, Equilibrium, SearchStatus, Verdict, certify, equilibrium
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene
from tests.comparisons.referee.forged import bent, stated
from tests.laws.test_index import EA, GA, critical  # whose columns have one beam
from tests.oracles.elastica import loaded
from tests.oracles.shooting import RIGID, shot

SECTION = {"youngs_modulus": 1.0, "shear_modulus": 1.0, "second_moment": 1.0}


def straight(scene: Scene, short: float = 1.0) -> Equilibrium:
    """The equilibrium of straight beams along x, shortened by a factor."""
    axes = {beam.name: short * np.array([beam.start, beam.end]) for beam in scene.beams}
    exact = bent(scene, 1.0, axes)
    assert exact.status is SearchStatus.FOUND
    beam = scene.beams[0]
    assert np.abs(exact.shape(beam.name, np.linspace(0.0, beam.length, 5)).rotation).max() < 1e-6
    return exact


def chain(load: float) -> Equilibrium:
    """A clamped column of 120 beams, EI = L = 1, with shear and stretch, under an end load."""
    beams = tuple(
        BeamSpec(name=f"b{k}", start=(a, 0.0), end=(b, 0.0), area=EA, shear_area=GA, clamped=() if a else ("start",), **SECTION)
        for k, (a, b) in enumerate(pairwise(np.linspace(0.0, 1.0, 121).tolist()))
    )  # fmt: skip
    push = LoadSpec(beam="b119", end="end", force=(-load, 0.0))
    return straight(Scene(name="column", load_parameters=1, beams=beams, loads=(push,)), 1.0 - load / EA)


STIFF = BeamSpec(
    name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), area=1e9, shear_area=1e9, **SECTION
)


def heavy(load: float) -> Equilibrium:
    """A column under its weight, that neither shears nor stretches."""
    beam = replace(STIFF, density=load / STIFF.area)
    return straight(Scene(name="heavy", load_parameters=1, beams=(beam,), gravity=(-1.0, 0.0)))


LOADS: dict[str, tuple[Callable[[float], Equilibrium], float, int, float]] = {
    # solved and counted as nearly empty equations
    "120 beams": (chain, critical("free", 3), 3, 1e-8),
    # Greenhill: nine quarters of the square of the first zero of J_-1/3
    "weight": (heavy, 7.837347438943, 1, 1e-6),
}  # fmt: skip
"""Equilibrium at a load, the critical load, the index beyond it, and how near it is told."""


@pytest.mark.parametrize("case", LOADS)
def test_the_index_grows_by_one_at_every_critical_load(case):
    at, load, index, near = LOADS[case]
    assert [at(load * part).index for part in (1.0 - near, 1.0 + near)] == [index - 1, index]


def elastica(tc: float, offset: float) -> tuple[Scene, AnswerState]:
    """A pin under a stiff rod, EI = 1, where the tangent has the angle tc at s = .9, and the shape of an elastica."""
    part, s = loaded((2.0 * math.asin(math.sqrt(tc / math.pi))) ** 2, 1.0, 0.0), 0.9
    force = float(part.force.real * (part.arc.real / s) ** 2)
    direction, normal = np.array([math.cos(tc), math.sin(tc)]), np.array([-math.sin(tc), math.cos(tc)])
    start = [0.0, 0.0, 0.0, math.sqrt(2.0 * force * math.sin(tc))]
    inner, outer = np.linspace(0.0, s, 46), np.linspace(s + 0.01, 1.0, 10)
    line = np.array([[0.0, 0.0], *(shot(force * normal, start, arc, **RIGID)[0][:2] for arc in inner[1:])])
    tail = line[-1] + np.outer(outer - s, direction)
    x, y = line[-1] - offset * normal
    scene = Scene(
        name="fold", load_parameters=1, beams=(STIFF,),
        pins=(PinSpec(name="p", path=((1.5, -1.0), (float(x), float(y))), radius=offset or None),),
        contacts=(ContactSpec(node="p", beam="b", side="right"),),
    )  # fmt: skip
    given = AnswerState(
        load_parameter=1.0, arcs={"p->b": s}, forces={"p->b": tuple((force * normal).tolist())},
        axes={"b": (np.concatenate([inner, outer]), np.vstack([line, tail]))},
    )  # fmt: skip
    return scene, given


FOLD = 2.983418482
"""Tangent angle at the fold of the elastica: zero of ``1 + 2 k^2 + k cot tc``, with the ratio k of its two integrals."""


@pytest.mark.parametrize("offset", [0.0, 1e-6])
def test_beyond_the_fold_of_a_pin_the_elastica_is_unstable(offset):
    for beyond, index in ((-0.005, 0), (0.005, 1)):
        exact = equilibrium(*elastica(FOLD + beyond, offset))
        assert exact.status is SearchStatus.FOUND
        assert exact.contacts["p->b"].push > 0.0
        assert exact.index == index


def test_the_straight_branch_of_a_column_is_unstable():
    """Under eight times Euler's load; the push aside is too small to bend it."""
    push = LoadSpec(beam="b", end="end", force=(-20.0, 1e-6))
    scene = Scene(name="column", load_parameters=2, beams=(STIFF,), loads=(push,))
    line = {"b": np.array([[0.0, 0.0], [1.0, 0.0]])}
    found = certify(stated(scene, [bent(scene, t, line) for t in (0.5, 1.0)]), scene)
    assert found.verdict is Verdict.UNSTABLE
    assert found.judged[0].index == 1
