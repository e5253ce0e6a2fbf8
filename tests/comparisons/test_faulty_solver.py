"""Ten faults put into the beams' solver, one at a time: each completes with a wrong answer, and no certificate is given to any."""

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.models import TSM
from comparisons.models import discrete as discrete_models
from comparisons.models.options import Options
from comparisons.models.progress import unwatched
from comparisons.referee import Certificate, Verdict, certify
from comparisons.scene import ContactSpec, PinSpec, Scene, load_scene
from tests.comparisons.referee.test_certify import BEAM, PORTAL
from tsm import path, stepping, track
from tsm.events import EventKind
from tsm.groups import ClosedFormGroup

FINDINGS = Path(__file__).parent / "findings"
KS = replace(load_scene("ks-cantilever"), load_parameters=10)
FACE = replace(load_scene("ks-face"), load_parameters=10)
COLUMN = replace(load_scene(str(FINDINGS / "euler2.toml")), load_parameters=5)


def under(*points: tuple[float, float], load_parameters: int = 8) -> Scene:
    """Return the cantilever with a pin that goes from place to place below it, and is not there at the beginning."""
    contact = ContactSpec(node="pin", beam=BEAM, side="right")
    pin = PinSpec(name="pin", path=points)
    return replace(KS, pins=(pin,), contacts=(contact,), load_parameters=load_parameters)


def without(kind: EventKind) -> Callable[[Any, Any], Any]:
    """Return a measure of margins that does not see one kind of event."""
    true = stepping.Stepper._measure

    def measure(self: Any, equilibrium: Any) -> Any:
        return [replace(m, value=1.0) if m.kind is kind else m for m in true(self, equilibrium)]

    return measure


def another_branch(patch: pytest.MonkeyPatch) -> None:
    """Any equilibrium that Newton's method finds is taken."""
    patch.setattr(track.Track, "unexplained", lambda *_: 0.0)
    patch.setattr(path.PathTangent, "index", 0)


def a_lost_contact(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(stepping.Stepper, "_measure", without(EventKind.TOUCH))
    patch.setattr(stepping, "crossing", lambda *_: None)


def a_pulling_force(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(stepping.Stepper, "_measure", without(EventKind.RELEASE))


def a_wrong_normal(patch: pytest.MonkeyPatch) -> None:
    """The contact force has a tangential part of a tenth of its y component."""
    true = ClosedFormGroup.contact

    def tilted(*given: Any) -> Any:
        gradient, tangent = true(*given)
        gradient[10] += 0.1 * given[2].force[1]
        tangent[10, 9] += 0.1
        return gradient, tangent

    patch.setattr(ClosedFormGroup, "contact", tilted)


def a_missing_moment(patch: pytest.MonkeyPatch) -> None:
    """A force inside an element acts on its nodes without the moments of its place."""
    true = ClosedFormGroup.contact

    def central(*given: Any) -> Any:
        gradient, tangent = true(*given)
        gradient[[2, 5]], tangent[[2, 5]] = 0.0, 0.0
        return gradient, tangent

    patch.setattr(ClosedFormGroup, "contact", central)


def a_load_not_applied(patch: pytest.MonkeyPatch) -> None:
    module = import_module("tsm.model")
    true = module.dead_loads

    def forgetful(model: Any) -> Any:
        loads = true(model)
        (first,) = loads.rows
        first[np.flatnonzero(first)[0]] = 0.0
        return loads

    patch.setattr(module, "dead_loads", forgetful)


def a_stale_result(patch: pytest.MonkeyPatch) -> None:
    """Every load parameter is answered with the step before it."""
    solve = import_module("tsm.solve")
    true = solve.collect

    def late(model: Any, steps: list[Any], *rest: Any) -> Any:
        stale = [
            replace(now, equilibrium=replace(old, state=replace(old.state, load_parameter=t)))
            for now, old in zip(steps[1:], (step.equilibrium for step in steps), strict=False)
            for t in [now.equilibrium.state.load_parameter]
        ]
        return true(model, [steps[0], *stale], *rest)

    patch.setattr(solve, "collect", late)


def swapped_reactions(patch: pytest.MonkeyPatch) -> None:
    true = discrete_models._response

    def swapped(*given: Any) -> Any:
        found = true(*given)
        reactions = zip(found.supports, reversed(found.supports.values()), strict=True)
        return replace(found, supports=dict(reactions))

    patch.setattr(discrete_models, "_response", swapped)


def a_wrong_support(patch: pytest.MonkeyPatch) -> None:
    """A clamp does not hold the rotation."""
    true = discrete_models.to_structure

    def loose(*given: Any, **more: Any) -> Any:
        structure = true(*given, **more)
        *others, last = structure.supports
        return replace(structure, supports=(*others, replace(last, rotation=None)))

    patch.setattr(discrete_models, "to_structure", loose)


FAULTS: dict[str, tuple[Callable[[pytest.MonkeyPatch], None], Scene, Verdict]] = {
    "another branch": (another_branch, COLUMN, Verdict.UNSTABLE),
    "a lost contact": (a_lost_contact, under((0.8, -0.1), (0.8, 0.1)), Verdict.INADMISSIBLE),
    "a pulling force": (
        a_pulling_force,
        under((0.8, -0.1), (0.8, 0.1), (0.8, -0.1)),
        Verdict.NOT_AN_EQUILIBRIUM,
    ),
    "a wrong normal": (a_wrong_normal, KS, Verdict.NOT_AN_EQUILIBRIUM),
    "a missing moment": (a_missing_moment, FACE, Verdict.NOT_AN_EQUILIBRIUM),
    "a load that is not applied": (a_load_not_applied, PORTAL, Verdict.NOT_AN_EQUILIBRIUM),
    "penetration between load parameters": (
        a_lost_contact,
        under((0.8, -0.1), (0.8, 0.1), (1.3, 0.1), load_parameters=1),
        Verdict.INADMISSIBLE,
    ),
    "a stale result": (a_stale_result, KS, Verdict.NOT_AN_EQUILIBRIUM),
    "swapped reactions": (swapped_reactions, PORTAL, Verdict.NOT_AN_EQUILIBRIUM),
    "a wrong support": (a_wrong_support, PORTAL, Verdict.NOT_AN_EQUILIBRIUM),
}
"""Fault, a scene that meets it, and what the certificate says."""


def certificate(scene: Scene, *, completed: bool = True) -> Certificate:
    """Solve without the checks of responses, which refuse some of the faults themselves."""
    response = TSM.solve(scene, Options(elements=10, element="mixed"), unwatched)
    assert response.completed is completed, response.message
    return certify(response, scene)


@pytest.mark.parametrize("name", FAULTS)
def test_a_faulty_solver_is_not_certified(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    put_in, scene, verdict = FAULTS[name]
    put_in(monkeypatch)
    found = certificate(scene)
    assert found.verdict is verdict, found.line()


@pytest.mark.parametrize("scene", [KS, FACE, PORTAL, COLUMN, under((0.8, -0.1), (0.8, 0.1), (0.8, -0.1))])
def test_the_solver_without_a_fault_is(scene: Scene) -> None:
    found = certificate(scene)
    assert found.certified, found.line()
