"""The verdict on an answer at one load parameter: its differences from the exact equilibrium, and whether that is admissible and stable."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from comparisons.answer import ContactHistory, Response
from comparisons.referee.certificate import Judgement, Verdict
from comparisons.referee.distance import Distance, Scales, distance, feet
from comparisons.referee.grip import UnknownFrictionError
from comparisons.referee.guess import answer_state, idle_at_an_end, pull_allowed
from comparisons.referee.newton import equilibrium
from comparisons.referee.path import at_rest, reach, way_to
from comparisons.referee.rod import angle, face_of
from comparisons.referee.state import Equilibrium, SearchStatus
from comparisons.scene import ContactSpec, Scene
from comparisons.scene.ends import free_ends

if TYPE_CHECKING:
    from comparisons.referee.friction import History

PLACE = 1e-3
"""Largest violation of constraints by an answer's axis, over the length; a larger one means another load parameter."""
ROUGH = 5e-2
"""Least allowance of a difference that is interpolated."""
CLOSE = 1e-3
"""Largest difference of an answer from an equilibrium that was not sought from the answer itself, so that it is the nearest one."""
LAST_PLACES = 1e-9
"""Largest relative difference between the size of a contact force and the norm of its components."""
INSIDE = 1e-9
"""Largest accepted penetration over the beam's length, for the round-off of the models' contacts."""


class Trial(NamedTuple):
    """An answer to a scene, the largest difference allowed, and its friction; None without friction."""

    response: Response
    scene: Scene
    allowed: float
    history: "History | None"


def judged(trial: Trial, k: int, before: Equilibrium | None) -> Judgement:
    """Judge load parameter number k; the equilibrium near it is sought first from the one `before`."""
    response, scene, allowed, history = trial
    t = float(response.load_parameter[k])

    def refused(verdict: Verdict, reason: str) -> Judgement:
        return Judgement(load_parameter=t, verdict=verdict, reason=reason)

    lost = (
        f"the position of {beam.name} is not finite"
        for beam in scene.beams
        if not np.isfinite([*response.axis_line(beam.name, k)[1], response.tips[beam.name][k]]).all()
    )
    contradiction = next(impossible(response, scene, k), "") or next(lost, "")
    if contradiction:
        return refused(Verdict.NOT_AN_EQUILIBRIUM, contradiction)
    answer = answer_state(response, scene, k)
    if history is not None:
        from comparisons.referee.friction import unlawful

        misstated = next(unlawful(history, k, allowed), "")
        if misstated:
            return refused(Verdict.INADMISSIBLE, misstated)
        try:
            answer = replace(answer, grips=history.grips(k))
        except UnknownFrictionError as error:
            return refused(Verdict.INADMISSIBLE if error.wrong else Verdict.NOT_JUDGED, str(error))
    if before is not None and not answer.grips and before.contacts.keys() == answer.arcs.keys():
        # it is the nearest one if it is close, though it was not sought from the answer
        found = reach(before, t, {}, halvings=0)
        item = compared(trial, k, found) if found.found else None
        off = item.distance if item else None
        if item and off and max(off.largest[1], off.sizes["place"]) <= min(allowed, CLOSE):
            return item
    exact = equilibrium(scene, answer)
    if exact.status is SearchStatus.NO_EQUILIBRIUM:
        # forces of the order of EA or GA lead a search from inaccurate rotations astray, and not the path
        ways = way_to(response, before or at_rest(scene), t, None if history is None else history.around)
        exact = next((way for way in ways[-1:] if way.closed.keys() == answer.arcs.keys()), exact)
    if exact.found:
        return compared(trial, k, exact)
    not_judged = exact.status in (SearchStatus.NOT_JUDGED, SearchStatus.NOT_RESOLVED)
    return refused(Verdict.NOT_JUDGED if not_judged else Verdict.NOT_AN_EQUILIBRIUM, exact.message)


def compared(trial: Trial, k: int, exact: Equilibrium, largest: Scales = (0.0, 0.0, 0.0)) -> Judgement:
    """Judge an answer beside an equilibrium, by differences relative to the largest force, moment and displacement, here or in `largest`."""
    response, _, allowed, history = trial
    differences = distance(response, k, exact, largest)
    stated = -1 if response.index is None else int(response.index[k])
    verdict, reason = _verdict(stated, exact, differences, allowed)
    if verdict is Verdict.CERTIFIED and history is not None:
        from comparisons.referee.friction import rubs_wrongly

        violation = next(rubs_wrongly(history, k, exact, allowed), "")
        verdict, reason = (Verdict.INADMISSIBLE, violation) if violation else (verdict, reason)
    return Judgement(
        load_parameter=exact.load_parameter, verdict=verdict, reason=reason, distance=differences, exact=exact
    )


def _verdict(stated: int, exact: Equilibrium, differences: Distance, allowed: float) -> tuple[Verdict, str]:
    """Return the verdict on an answer near an exact equilibrium, and its reason; `stated` is the answer's index, -1 without one."""
    place = differences.sizes["place"]
    if not place <= PLACE:
        words = f"supports and contacts are off by {place:.2g} L{differences.at('place')}"
        return Verdict.NOT_AN_EQUILIBRIUM, words
    for item, limit in ((differences.largest, allowed), (differences.rough, max(allowed, ROUGH))):
        if not item[1] <= limit:
            return Verdict.NOT_AN_EQUILIBRIUM, f"{differences.line(item)}, allowed {100.0 * limit:.3g} %"
    violation = next(inadmissible(exact), "")
    if violation:
        return Verdict.INADMISSIBLE, violation
    if exact.index > 0:
        ways = "one direction lowers" if exact.index == 1 else f"{exact.index} directions lower"
        return Verdict.UNSTABLE, f"index {exact.index}: {ways} the energy"
    if stated not in (-1, exact.index) and exact.index >= 0:
        return Verdict.NOT_AN_EQUILIBRIUM, f"index {stated} is stated, the equilibrium has {exact.index}"
    return Verdict.CERTIFIED, differences.line()


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
    elif force < -pull_allowed(scene.beam(spec.beam)):
        yield f"the contact force of {spec.pair} pulls"
    elif force == 0.0 or idle_at_an_end(contact, scene, spec, k):
        return
    elif not 0.0 <= arc <= scene.beam(spec.beam).length:
        yield f"the arc position of {spec.pair} is not on its beam"
    elif contact.vector is not None:
        size = math.hypot(*contact.vector[k])
        if not abs(size - abs(force)) <= LAST_PLACES * size:
            yield f"the force of {spec.pair} and its components differ"


def inadmissible(exact: Equilibrium) -> Iterator[str]:
    """Yield a sentence for every violation of unilateral contact; `friction.rubbing` judges friction."""
    scene = exact.scene
    for spec in scene.contacts:
        beam = scene.beam(spec.beam)
        contact = exact.contacts.get(spec.pair)
        if contact is not None:
            if contact.push < -pull_allowed(beam):
                yield f"the contact force of {spec.pair} pulls, {contact.push:.3g}"
            if not 0.0 <= contact.arc_position <= beam.length:
                yield f"{spec.pair} is closed beyond the end of its beam"
        gap, arc = _least_gap(exact, spec)
        if gap < -INSIDE * beam.length:
            what = "the round pin" if scene.radius(spec) else "the node"
            yield f"{what} of {spec.pair} is {-gap / beam.length:.2g} L inside the beam at arc position {arc:.4g}"
        for end, room in _rooms(exact, spec):
            if room < -INSIDE * beam.length:
                yield f"the round pin of {spec.pair} overlaps the {end} of the beam by {-room / beam.length:.2g} L"


def _rooms(exact: Equilibrium, spec: ContactSpec) -> Iterator[tuple[str, float]]:
    """Distance of a round pin beyond an end from the segment across that end, for the ends that no other beam shares."""
    x, y = exact.place(spec.node).tolist()
    for end in free_ends(exact.scene, spec):
        at, way = (0.0, 1.0) if end.name == "start" else (exact.scene.beam(spec.beam).length, -1.0)
        there = exact.shape(spec.beam, np.array([at]))
        place, inward = there.position[0].tolist(), (way * there.tangent[0]).tolist()
        yield end.name, end._replace(place=tuple(place), inward=tuple(inward)).room((x, y))


def _least_gap(exact: Equilibrium, spec: ContactSpec) -> tuple[float, float]:
    """Return the smallest gap of a pair on its side of the beam, and its arc position; infinite without a closest point."""
    # at a contact the axis has a kink 2 a by shear; at the distance d a round pin penetrates by a d - (1/offset - curvature) d^2/2,
    # and only penetration beyond a d, which means line contact, counts
    face, contact = face_of(exact.scene, spec), exact.contacts.get(spec.pair)
    arcs, away = feet(exact, spec) if face.start else (np.empty(0), np.empty(0))
    gaps = np.abs(away) - face.reach(arcs)
    if contact is not None:
        half = angle(*exact.tangents(exact.layout.touches[spec.pair])) / 2.0
        gaps = np.where(away > 0.0, gaps + half * np.abs(arcs - contact.arc_position), np.inf)
    return min(zip(gaps.tolist(), arcs.tolist(), strict=True), default=(math.inf, math.nan))
