"""The built-in scenes: every model has the answer of `tests/problems.toml`, certified, or says why not."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.answer.errors import errors
from comparisons.models import MODELS, certified, solve
from comparisons.models.model import ModelError
from comparisons.referee import Verdict
from comparisons.scene import Scene, built_in_scenes, load_scene
from tests.oracles.frames import Frame
from tests.problems import PROBLEMS, RUNS, value

NAMES = tuple(built_in_scenes())
ELEMENTS = ("exact", "mixed")
DEAR = {"double-beam", "crossed-beams", "ks-tied-tip", "pinned-column", "two-pins"}
DEAR |= {name for name in NAMES if any(spec.friction for spec in load_scene(name).contacts)}


def answer(scene: Scene, run: str = "exact") -> Response:
    response = solve(scene, *RUNS[run])
    assert response.status == "COMPLETED", response.message
    return response


@cache
def rod(name: str) -> Response:
    return answer(load_scene(name), "rod")


def test_the_table_has_every_scene_and_every_model(stated):
    assert PROBLEMS.keys() == set(NAMES)
    for name, problem in PROBLEMS.items():
        assert not problem.errors.keys() & problem.others.keys()
        assert problem.errors.keys() | problem.others.keys() == RUNS.keys(), name
        assert max(problem.answers) == load_scene(name).times[-1]
    stated("scenes", len(NAMES))


@pytest.mark.slow_at(*(f"{name}-{element}" for name in DEAR for element in ELEMENTS))
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("name", NAMES)
def test_two_load_parameters_have_the_answer_of_the_table(name, element):
    scene, problem = replace(load_scene(name), load_parameters=2), PROBLEMS[name]
    response = certified(answer(scene, element), scene)
    assert response.completed, response.message
    assert problem.mistakes(response, problem.errors[element]) == []
    if element == "exact":
        assert problem.misplaced(response) == []


@pytest.mark.parametrize("name", NAMES)
def test_every_model_states_it_or_says_why_in_one_line(name):
    scene, others = load_scene(name), PROBLEMS[name].others
    for run, (model, options) in RUNS.items():
        said = MODELS[model].refusal(scene)
        refused = others.get(run, "CAPITALS")
        if refused.isupper():
            assert said is None, run
        else:
            with pytest.raises(ModelError) as caught:
                solve(scene, model, options)
            line = said or str(caught.value)
            assert refused in line
            assert len(line.splitlines()) == 1


@pytest.mark.slow
@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("name", NAMES)
def test_every_model_has_the_answer_of_the_table_or_stops_by_name(name, run):
    """Certified at the end, and by exact and mixed elements at every load parameter."""
    scene, problem, (model, options) = load_scene(name), PROBLEMS[name], RUNS[run]
    other = problem.others.get(run, "COMPLETED")
    if not other.isupper():
        return
    response = certified(solve(scene, model, options), scene, "all" if run in ELEMENTS else "last")
    assert (response.status, response.false_success) == (other, False), response.message
    if run in problem.errors:
        if run != "elastica":
            assert errors(response, rod(name), scene)["path"]["tip"] < 0.02
        verdict = Verdict.NOT_JUDGED if MODELS[model].by_referee(scene) else Verdict.CERTIFIED
        assert response.certificate is not None
        assert response.certificate.verdict is verdict, response.certificate.reason
        assert problem.mistakes(response, problem.errors[run]) == []


def arc(t: float) -> Mapping[str, Any]:
    """An arc of the angle 2 (1 - t), which begins at the angle -1."""
    turn = 2.0 * (1.0 - t)
    tip = (np.sin(turn - 1.0) + np.sin(1.0), np.cos(1.0) - np.cos(turn - 1.0))
    return {"tip strip": 100.0 * (np.array(tip) / turn if turn else np.array([np.cos(1.0), -np.sin(1.0)]))}


def truss(t: float) -> Mapping[str, Any]:
    span, rise, depth, EA = 100.0, 10.0, 16.0 * t, load_scene("hinged-truss").beams[0].EA
    length = np.hypot(span, rise - depth)
    force = 2.0 * EA * (1.0 - length / np.hypot(span, rise)) * (rise - depth) / length
    return {"reaction left.end": (0.0, -force)}


def springs(t: float) -> Mapping[str, Any]:
    forces = {f"spring beam.{end}": (0.0, full * t) for end, full in (("start", 60.0), ("end", 240.0))}
    return {**forces, "tip beam": (np.sqrt(200.0**2 - (65.0 * t) ** 2), -80.0 * t)}


SOURCES: dict[str, Callable[[float], Mapping[str, Any]]] = {
    "beam-on-springs": springs,
    "hinged-truss": truss,
    "straightened-arc": arc,
}


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("name", SOURCES)
def test_a_path_is_that_of_the_closed_form(name, element):
    response = answer(load_scene(name), element)
    for k, t in enumerate(response.load_parameter):
        for quantity, exact in SOURCES[name](t).items():
            size = 8e3 if quantity.startswith("reaction") else 100.0
            assert np.abs(value(response, quantity, k) - exact).max() <= (1e-12 if element == "exact" else 1e-9) * size, quantity  # fmt: skip


def test_crossed_beams_with_an_upright_strut():
    """Before it buckles, a strut that does not lean moves down by the deflection of a beam that is loaded in its middle, and is shortened."""
    scene, down = load_scene("crossed-beams"), 2.0
    lower, upper = scene.beams
    upright = replace(
        scene,
        load_parameters=2,
        beams=(lower, replace(upper, end=(100.0, 1.0))),
        supports=(replace(scene.supports[0], displacement=(0.0, -down)),),
    )
    (contact,) = answer(upright).contacts.values()
    joints = ((0.0, 0.0), (100.0, 0.0), (200.0, 0.0))
    frame = Frame(joints=joints, loaded=1, clamped=True, EA=lower.EA, GA=lower.GA, EI=lower.EI)
    sunk = down - contact.force[-1] * 99.0 / upper.EA
    steps = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.25, 1.5, 1.75, sunk]
    assert contact.force[-1] == pytest.approx(frame.load(steps)[-1], rel=1e-9)
    assert contact.arc_position[-1] == pytest.approx(100.0, abs=1e-9)
