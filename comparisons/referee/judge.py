"""The verdict on an answer at one load parameter."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from comparisons.referee.admissible import inadmissible
from comparisons.referee.balance import unbalanced
from comparisons.referee.certificate import Judgement, Verdict
from comparisons.referee.distance import Distance, bending_force, distance
from comparisons.referee.equilibrium import SearchStatus
from comparisons.referee.history import History, UnknownFrictionError
from comparisons.referee.rubbing import rubs_wrongly, unlawful, wanders
from comparisons.referee.start import PULL, AnswerState, answer_state, idle_at_an_end
from comparisons.referee.state import Equilibrium, equilibrium
from comparisons.response import ContactHistory, Response
from comparisons.scene import ContactSpec, Scene

PLACE = 1e-3
"""Largest violation of constraints by an answer's axis, over the length; a larger one means another load parameter."""
LAST_PLACES = 1e-9
"""Largest relative difference between the size of a contact force and the norm of its components."""


def judged(
    response: Response,
    scene: Scene,
    k: int,
    allowed: float,
    *,
    history: History | None = None,
    exact: Equilibrium | None = None,
    largest: tuple[float, float] = (0.0, 0.0),
) -> Judgement:
    """Judge one load parameter.

    Parameters
    ----------
    response, scene, k, allowed
        The answer, its scene, the number of the load parameter, and the largest difference allowed.
    history : History, optional
        The states of friction in the answer; None for a scene without friction.
    exact : Equilibrium, optional
        The exact equilibrium near the answer, if it is known.
    largest : (float, float)
        Largest force and moment of other load parameters; differences are relative to these where they are larger.
    """
    t = float(response.load_parameter[k])
    contradiction = next(impossible(response, scene, k), "") or next(_not_finite(response, scene, k), "")
    if contradiction:
        return Judgement(load_parameter=t, verdict=Verdict.NOT_AN_EQUILIBRIUM, reason=contradiction)
    answer = answer_state(response, scene, k)
    if history is not None:
        misstated = next(unlawful(response, scene, k, allowed), "") or next(wanders(history, k, allowed), "")
        if misstated:
            return Judgement(load_parameter=t, verdict=Verdict.INADMISSIBLE, reason=misstated)
        try:
            answer = replace(answer, grips=history.grips(k))
        except UnknownFrictionError as error:
            verdict = Verdict.INADMISSIBLE if error.wrong else Verdict.NOT_JUDGED
            return Judgement(load_parameter=t, verdict=verdict, reason=str(error))
    exact = exact or equilibrium(scene, answer)
    if exact.status is not SearchStatus.FOUND:
        not_judged = exact.status in (SearchStatus.NOT_JUDGED, SearchStatus.NOT_RESOLVED)
        verdict = Verdict.NOT_JUDGED if not_judged else Verdict.NOT_AN_EQUILIBRIUM
        return Judgement(load_parameter=t, verdict=verdict, reason=exact.message)
    answer = _with_vectors(answer, response, exact, k)
    differences = distance(scene, answer, exact, largest)
    verdict, reason = _verdict(response, scene, answer, exact, differences, allowed)
    if verdict is Verdict.CERTIFIED and history is not None:
        violation = next(rubs_wrongly(history, k, exact, allowed), "")
        verdict, reason = (Verdict.INADMISSIBLE, violation) if violation else (verdict, reason)
    return Judgement(
        load_parameter=t,
        verdict=verdict,
        reason=reason,
        distance=differences,
        index=exact.index,
        residual=exact.error,
        exact=exact,
    )


def _verdict(
    response: Response,
    scene: Scene,
    answer: AnswerState,
    exact: Equilibrium,
    differences: Distance,
    allowed: float,
) -> tuple[Verdict, str]:
    """Return the verdict on an answer near an exact equilibrium, and its reason."""
    if not differences.place <= PLACE:
        words = f"supports and contacts are off by {differences.place:.2g} L{differences.at('place')}"
        return Verdict.NOT_AN_EQUILIBRIUM, words
    if not differences.largest[1] <= allowed:
        return Verdict.NOT_AN_EQUILIBRIUM, f"{differences.line()}, allowed {allowed:.2g}"
    imbalance = "" if response.continuum or response.outside else unbalanced(scene, answer, exact)
    if imbalance:
        return Verdict.NOT_AN_EQUILIBRIUM, imbalance
    violation = next(inadmissible(scene, exact), "")
    if violation:
        return Verdict.INADMISSIBLE, violation
    if exact.index > 0:
        ways = "one direction lowers" if exact.index == 1 else f"{exact.index} directions lower"
        return Verdict.UNSTABLE, f"index {exact.index}: {ways} the energy"
    return Verdict.CERTIFIED, differences.line()


def _not_finite(response: Response, scene: Scene, k: int) -> Iterator[str]:
    """Yield beams whose positions are not finite."""
    for beam in scene.beams:
        _, line = response.axis_line(beam.name, k)
        if not np.all(np.isfinite(line)) or not np.all(np.isfinite(response.tips[beam.name][k])):
            yield f"the position of {beam.name} is not finite"


def impossible(response: Response, scene: Scene, k: int) -> Iterator[str]:
    """Yield contradictions to the scene: other load parameters, pairs or supports, tensile or infinite contact forces."""
    if k >= len(scene.times) or response.load_parameter[k] != scene.times[k]:
        yield f"the load parameter {response.load_parameter[k]:.6g} is none of the scene's"
    elif response.contacts.keys() != {spec.pair for spec in scene.contacts}:
        yield "the contact pairs are not the scene's"
    elif response.supports.keys() != {support.node for support in scene.all_supports}:
        yield "the supported ends are not the scene's"
    else:
        for spec in scene.contacts:
            yield from _impossible_contact(response.contacts[spec.pair], scene, spec, k)


def _impossible_contact(contact: ContactHistory, scene: Scene, spec: ContactSpec, k: int) -> Iterator[str]:
    """Yield contradictions of one contact."""
    force, arc = float(contact.force[k]), float(contact.arc_position[k])
    if not math.isfinite(force):
        yield f"the force of {spec.pair} is not finite"
    elif force < -PULL * bending_force(scene.beam(spec.beam)):
        yield f"the contact force of {spec.pair} pulls"
    elif force != 0.0 and idle_at_an_end(contact, scene, spec, k):
        return
    elif force != 0.0 and not 0.0 <= arc <= scene.beam(spec.beam).length:
        yield f"the arc position of {spec.pair} is not on its beam"
    elif force != 0.0 and contact.vector is not None:
        size = float(np.hypot(*contact.vector[k]))
        if not abs(size - abs(force)) <= LAST_PLACES * size:
            yield f"the force of {spec.pair} and its components differ"


def _with_vectors(answer: AnswerState, response: Response, exact: Equilibrium, k: int) -> AnswerState:
    """Complete contact forces without direction by the exact direction, and tangential forces that are not stated."""
    forces, drags = dict(answer.forces), dict(answer.drags)
    for pair, force in answer.forces.items():
        if pair not in exact.contacts:
            # open at an end, with a force that is round-off
            forces[pair] = tuple(np.nan_to_num(force).tolist())
            drags.setdefault(pair, 0.0)
            continue
        if math.isnan(force[0]):
            x, y = exact.contacts[pair].force / max(float(np.hypot(*exact.contacts[pair].force)), 1e-300)
            size = float(response.contacts[pair].force[k])
            forces[pair] = (size * float(x), size * float(y))
        drags.setdefault(pair, exact.contacts[pair].drag)
    return replace(answer, forces=forces, drags=drags)
