"""The referee's index against buckling loads, folds and units; its answer where there are many contacts, and on finer meshes."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from comparisons.exact.elastica import fold_angle
from comparisons.referee import AnswerState, Equilibrium, SearchStatus, equilibrium
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, SupportSpec

GA, EA = 50.0, 400.0
SECTION = {"youngs_modulus": 1.0, "shear_modulus": 1.0, "second_moment": 1.0}


def column(ends: str, load: float) -> Equilibrium:
    """A straight column, EI = L = 1, under an end load, with the ends "clamped-free", "pinned", "clamped" or "clamped-pinned"."""
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), area=EA, shear_area=GA, **SECTION,
        clamped=() if ends == "pinned" else ("start",),
    )  # fmt: skip
    supports = {
        "clamped-free": (),
        "pinned": (
            SupportSpec(beam="b", end="start", kind="pinned"),
            SupportSpec(beam="b", end="end", fixed=("y",)),
        ),
        "clamped": (SupportSpec(beam="b", end="end", fixed=("y", "rotation")),),
        "clamped-pinned": (SupportSpec(beam="b", end="end", fixed=("y",)),),
    }[ends]
    push = LoadSpec(beam="b", end="end", force=(-load, 0.0))
    scene = Scene(name="column", load_parameters=1, beams=(beam,), supports=supports, loads=(push,))
    arc = np.linspace(0.0, 1.0, 5)
    line = np.stack([arc * (1.0 - load / EA), 0.0 * arc], axis=1)
    exact = equilibrium(
        scene,
        AnswerState(load_parameter=1.0, arcs={}, forces={}, axes={"b": (arc, line)}, reactions={}, tips={}),
    )
    assert exact.status is SearchStatus.FOUND
    assert not exact.shape("b", arc).rotation.any()
    return exact


def critical(ends: str, mode: int) -> float:
    """Load of a mode: ``P (1 + P (1/GA - 1/EA)) = k^2``, the end reaction of clamped-pinned apart."""
    if ends == "clamped-pinned":

        def miss(P: float) -> float:
            k = math.sqrt(P * (1.0 + P / GA - P / EA))
            return math.sin(k) - k * math.cos(k) * (1.0 - P / EA) / (1.0 + P / GA - P / EA)

        return float(brentq(miss, 10.0, 25.0, xtol=1e-14))
    k = math.pi * {"clamped-free": mode - 0.5, "pinned": mode, "clamped": 2.0 * mode}[ends]
    a = 1.0 / GA - 1.0 / EA
    return (math.sqrt(1.0 + 4.0 * a * k**2) - 1.0) / (2.0 * a)


@pytest.mark.parametrize(
    ("ends", "mode"),
    [("clamped-free", 1), ("clamped-free", 2), ("clamped-free", 3), ("pinned", 1), ("pinned", 2), ("clamped", 1), ("clamped-pinned", 1)],
)  # fmt: skip
def test_the_index_grows_by_one_at_every_buckling_load_to_1e_10(ends: str, mode: int) -> None:
    load = critical(ends, mode)
    assert [column(ends, load * part).index for part in (1.0 - 1e-10, 1.0 + 1e-10)] == [mode - 1, mode]


@pytest.mark.parametrize("part", [1.0 - 1e-8, 1.0 + 1e-8])
@pytest.mark.parametrize("mode", [1, 3])
def test_the_index_of_many_beams_is_that_of_one(mode: int, part: float) -> None:
    """A column of 120 beams, whose equations are solved and counted as nearly empty ones."""
    load, ends = part * critical("clamped-free", mode), np.linspace(0.0, 1.0, 121)
    section = {"area": EA, "shear_area": GA, **SECTION}
    beams = tuple(
        BeamSpec(name=f"b{k}", start=(a, 0.0), end=(b, 0.0), clamped=() if k else ("start",), **section)
        for k, (a, b) in enumerate(pairwise(ends.tolist()))
    )
    push = LoadSpec(beam="b119", end="end", force=(-load, 0.0))
    scene = Scene(name="column", load_parameters=1, beams=beams, loads=(push,))
    short = 1.0 - load / EA
    axes = {
        spec.name: (np.array([0.0, spec.length]), short * np.array([spec.start, spec.end])) for spec in beams
    }
    given = AnswerState(load_parameter=1.0, arcs={}, forces={}, axes=axes, reactions={}, tips={})
    exact = equilibrium(scene, given)
    assert exact.status is SearchStatus.FOUND
    assert exact.index == mode - (part < 1.0)


def elastica(tc: float, offset: float = 0.0) -> tuple[Scene, AnswerState]:
    """A pin under a stiff rod, EI = 1, where the tangent has the angle tc at s = .9, and the shape of an elastica."""
    EI, s = 1.0, 0.9

    def rate(_: float, state: np.ndarray, force: float) -> list[float]:
        _, _, theta, m = state
        c, si = math.cos(theta), math.sin(theta)
        return [c, si, m, -force * (si * math.sin(tc) + c * math.cos(tc))]

    def shot(force: float) -> np.ndarray:
        back = solve_ivp(
            rate, (s, 0.0), [0.0, 0.0, tc, 0.0], args=(force,), rtol=1e-11, atol=1e-12, dense_output=True
        )
        return np.array(back.sol(np.linspace(0.0, s, 91)).T)

    force = brentq(lambda f: shot(f)[0, 2], 0.5, next(f for f in np.arange(1.0, 60.0) if shot(f)[0, 2] < 0.0))
    line = shot(force)[:, :2]
    line -= line[0]
    direction = np.array([math.cos(tc), math.sin(tc)])
    tail = line[-1] + np.outer(np.linspace(0.01, 0.1, 10), direction)
    arc = np.concatenate([np.linspace(0.0, s, 91), np.linspace(s + 0.01, 1.0, 10)])
    normal = np.array([-direction[1], direction[0]])
    pin = line[-1] - offset * normal
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), area=1e9, shear_area=1e9, **SECTION
    )
    scene = Scene(
        name="fold",
        load_parameters=1,
        beams=(beam,),
        pins=(PinSpec(name="p", path=((1.5, -1.0), (float(pin[0]), float(pin[1]))), radius=offset or None),),
        contacts=(ContactSpec(node="p", beam="b", side="right"),),
    )
    pushed = force * EI * normal
    given = AnswerState(
        load_parameter=1.0, arcs={"p->b": s}, forces={"p->b": (float(pushed[0]), float(pushed[1]))},
        axes={"b": (arc, np.vstack([line, tail]))}, reactions={}, tips={},
    )  # fmt: skip
    return scene, given


@pytest.mark.parametrize("offset", [0.0, pytest.param(1e-6, marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("beyond", "index"),
    [
        pytest.param(-0.02, 0, marks=pytest.mark.slow),
        pytest.param(-0.005, 0, marks=pytest.mark.slow),
        (0.005, 1),
        pytest.param(0.02, 1, marks=pytest.mark.slow),
    ],
)
def test_beyond_the_fold_of_a_pin_the_elastica_is_unstable(beyond: float, index: int, offset: float) -> None:
    exact = equilibrium(*elastica(fold_angle() + beyond, offset))
    assert exact.status is SearchStatus.FOUND
    assert exact.contacts["p->b"].push > 0.0
    assert exact.index == index
