"""Every built-in scene by every model of a comparison: a certified answer, a stop by name, or one line why not."""

import pytest

from comparisons.compare import ELASTICA, MIXED, PAPER, ROD, SOLID, Run
from comparisons.errors import errors
from comparisons.models import MODELS, certified, solve
from comparisons.models.options import ModelError
from comparisons.referee import Verdict
from comparisons.response import Response
from comparisons.scene import Scene, built_in_scenes, load_scene

NOT_BY_THE_SOLID = {
    "cantilever-critical-area": "more than an eighth of the length",
    "ks-printed-shear": "a Poisson's ratio between",
    "lees-frame": "a Poisson's ratio between",
    "williams-toggle": "a Poisson's ratio between",
}
"""Scenes that no solid is: a section higher than a beam's, and beams that do not shear."""
WITH_ELASTICA = {"cantilever-critical-area", "ks-cantilever", "ks-printed-shear", "touch-again"}
"""Scenes of one cantilever under one pin on its axis."""
WITHOUT_FRICTION = "contacts without friction only"
"""Reason of the paper's element to refuse scenes with friction."""
STRAIGHT = "such elements are straight and uniform, without loads along them"
"""Reason of the paper's element to refuse curved, tapered and heavy beams."""
VARYING = {"heavy-strip", "straightened-arc", "tapered-spring"}
"""Scenes of such beams."""
STOPS = {"CUTBACK_FLOOR"}
"""How the paper's element stops in a critical area."""


def outcome(scene: Scene, run: Run, rod: Response) -> str:
    """Return ``CERTIFIED``, the status of a stop, or the reason of a refusal. The referee does not judge its own equilibria."""
    try:
        response = certified(rod if run is ROD else solve(scene, run.model, run.options), scene)
    except ModelError as error:
        return str(error)
    if not response.completed:
        assert not response.false_success, response.message
        return response.status
    assert response.certificate is not None
    own = MODELS[run.model].by_referee(scene)
    verdict = Verdict.NOT_JUDGED if own else Verdict.CERTIFIED
    assert response.certificate.verdict is verdict, response.certificate.reason
    if run is not ELASTICA:
        found = errors(response, rod, scene)["path"]
        assert found["tip"] < 0.02
    return Verdict.CERTIFIED.name


@pytest.mark.slow
@pytest.mark.parametrize("name", built_in_scenes())
def test_every_model_has_a_certified_answer_or_a_reason(name: str) -> None:
    scene = load_scene(name)
    rod = solve(scene, ROD.model)
    assert outcome(scene, ROD, rod) == outcome(scene, MIXED, rod) == Verdict.CERTIFIED.name
    by_paper = outcome(scene, PAPER[1], rod)
    if any(contact.friction for contact in scene.contacts):
        assert by_paper.endswith(WITHOUT_FRICTION)
    elif name in VARYING:
        assert STRAIGHT in by_paper
    else:
        assert by_paper in {Verdict.CERTIFIED.name, *STOPS}
    by_solid = outcome(scene, SOLID, rod)
    assert (
        NOT_BY_THE_SOLID[name] in by_solid if name in NOT_BY_THE_SOLID else by_solid == Verdict.CERTIFIED.name
    )
    assert (outcome(scene, ELASTICA, rod) == Verdict.CERTIFIED.name) == (name in WITH_ELASTICA)


@pytest.mark.parametrize("name", built_in_scenes())
def test_every_model_states_it_or_says_why(name: str) -> None:
    refused = {model.name: model.refusal(load_scene(name)) for model in MODELS.values()}
    assert {model for model, reason in refused.items() if reason is None} == {
        "tsm",
        "rod",
        *(["solid"] if name not in NOT_BY_THE_SOLID else []),
        *(["elastica"] if name in WITH_ELASTICA else []),
    }
    assert all(reason is None or len(reason.splitlines()) == 1 for reason in refused.values())
