"""The models and the drawn scenes that the laws run over."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import tsm
from comparisons.answer import Response
from comparisons.models import MODELS, solve
from comparisons.models.model import Options
from comparisons.referee import certify
from comparisons.scene import SPECIAL, Scene, load_scene, unstated
from tests.fuzz.special import DRAW
from tests.laws.transform import Readings, readings

FAST = {
    "world-8": "a strut that buckles",
    "world-20": "a beam's end on a beam",
    "friction-10": "a pin that slides",
    "special-20": "turn, weight",
    "special-46": "taper, load along a beam",
    "special-58": "hinge, springs",
}
MORE = {
    "world": (0, 2, 6, 10, 13, 16, 18),
    "friction": (0, 1, 16, 20),
    "special": (0, 10, 12, 24, 32, 37, 44, 57, 59),
    "held": (0, 1, 3, 6, 8),
}
"""Seeds by family that the slow tier draws for the elements `DRAWN`."""
DRAWN = ("exact", "mixed")
SCENES = (*FAST, *(f"{family}-{seed}" for family, seeds in MORE.items() for seed in seeds))
BUILT_IN = ("ks-cantilever", "ks-friction")
"""The scenes of the exact answers under one pin."""

ELEMENTS = {name: ("tsm", Options(element=name)) for name in tsm.ELEMENTS if not name.endswith("as-printed")}
"""The elements without the printed misprints, some of which depend on the units."""
OTHERS = {
    "solid": ("solid", Options(mesh=(10, 1))),
    "rod": ("rod", Options()),
    "elastica": ("elastica", Options()),
}
REFEREE = "referee"
QUICK = {
    "exact": tuple(FAST),
    "mixed": ("world-8", "world-20", "friction-10", "special-46"),
    "timoshenko": ("world-20", "special-58"),
    "elastica": ("ks-cantilever",),
    REFEREE: ("special-58",),
}
"""The scenes of the fast tier, by model."""
WITHIN = {"exact": 1e-9, REFEREE: 1e-9, "rod": 1e-9, "elastica": 1e-9, "solid": 1e-4}
"""Largest difference of two answers that a law says are the same; a coarse solid's axial force is left by its Newton method."""
MESHED = 1e-6
VARYING = {"turn", "taper", "density", "force_per_length", "at"}
"""Keys that need elements of beams that vary."""


@cache
def scene(name: str) -> Scene:
    """The scene of a family and seed, or a built-in one."""
    family, _, seed = name.rpartition("-")
    return DRAW[family](int(seed)) if family in DRAW else load_scene(name)


def keys(found: Scene) -> set[str]:
    """The special keys that a scene has."""
    return {key for key in SPECIAL if unstated(found, "", set(SPECIAL) - {key}) is not None}


def states(model: str, found: Scene) -> bool:
    """Whether a model states a scene."""
    if model in ELEMENTS:
        integrated = VARYING & keys(found) or any(item.friction for item in found.contacts)
        return tsm.ELEMENTS[model].on_varying is not None or not integrated
    if model == REFEREE:
        return True
    chosen = MODELS[model]
    by_referee = chosen.by_referee(found)  # it is judged as the referee
    return not by_referee and (chosen.unstated(found) or chosen.refusal(found)) is None


@cache
def answer(found: Scene, model: str) -> Response:
    """The answer of a model to a scene, which the laws share."""
    return solve(found, *(ELEMENTS | OTHERS)[model])


def stated(found: Scene, model: str) -> Readings:
    """What a model states; of the referee, the equilibrium next to the last answer of exact elements."""
    if model != REFEREE:
        return readings(answer(found, model), found)
    (judged,) = certify(answer(found, "exact"), found, at=[-1]).judged
    here = judged.exact
    if here is None:
        return {"verdict": ("word", np.array([judged.verdict.name]))}
    states: Readings = {
        "verdict": ("word", np.array([judged.verdict.name])),
        "index": ("word", np.array([here.index])),
        "energy": ("energy", np.array([here.strain_energy])),
    }
    for name, held in here.reactions.items():
        states[f"support {name}"], states[f"moment {name}"] = ("force", held[None, :2]), ("moment", held[2:])
    for name, contact in here.contacts.items():
        states[f"contact {name}"] = "size", np.array([contact.push])
        states[f"tangential {name}"] = "size", np.array([contact.drag])
        states[f"arc {name}"] = "arc", np.array([contact.arc_position])
    return states


def cases(
    fits: Callable[[Scene], bool] = lambda _: True, models: tuple[str, ...] = (*ELEMENTS, *OTHERS, REFEREE)
) -> list[object]:
    """Models with the scenes that they state; those of the slow tier are marked."""
    found = []
    for model in models:
        own = BUILT_IN if model in ("rod", "elastica") else SCENES if model in DRAWN else tuple(FAST)
        for name in own:
            if states(model, scene(name)) and fits(scene(name)):
                marks = () if model in QUICK and name in QUICK[model] else pytest.mark.slow
                found.append(pytest.param(model, name, id=f"{model}-{name}", marks=marks))
    return found


def within(model: str) -> float:
    """Largest difference of two answers that are the same."""
    return WITHIN.get(model, MESHED)


def numbered(found: Scene, number: int) -> Scene:
    """The scene with a number of load parameters in every stage."""
    stages = tuple(replace(stage, load_parameters=number) for stage in found.stages)
    return replace(found, load_parameters=number, stages=stages)
