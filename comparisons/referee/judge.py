"""The verdict on an answer at one load parameter."""

import math
from collections.abc import Iterator

import numpy as np

from comparisons.referee.admissible import PULL, inadmissible
from comparisons.referee.balance import unbalanced
from comparisons.referee.certificate import Judgement, Verdict
from comparisons.referee.distance import Distance, distance, least_force
from comparisons.referee.equilibrium import Found
from comparisons.referee.material import friction
from comparisons.referee.start import Given, given_by
from comparisons.referee.state import Equilibrium, equilibrium
from comparisons.response import ContactHistory, Response
from comparisons.scene import ContactSpec, Scene

PLACE = 1e-3
"""Largest distance, over the length, of an answer's own axis from its supports and touching points: more is another load parameter."""
LAST_PLACES = 1e-9
"""Largest difference between a contact force's size and that of its components, over the size."""


def judged(response: Response, scene: Scene, k: int, allowed: float) -> Judgement:
    """Judge one load parameter."""
    t = float(response.load_parameter[k])
    unstated = next(impossible(response, scene, k), "") or next(_unplaced(response, scene, k), "")
    if unstated:
        return Judgement(load_parameter=t, verdict=Verdict.NOT_AN_EQUILIBRIUM, reason=unstated)
    given = given_by(response, scene, k)
    exact = equilibrium(scene, given)
    if exact.found is not Found.FOUND:
        known = exact.found in (Found.NOT_JUDGED, Found.NOT_RESOLVED)
        verdict = Verdict.NOT_JUDGED if known else Verdict.NOT_AN_EQUILIBRIUM
        return Judgement(load_parameter=t, verdict=verdict, reason=exact.message)
    given = _with_vectors(given, response, exact, k)
    apart = distance(scene, given, exact)
    verdict, reason = _ruled(response, scene, given, exact, apart, allowed)
    return Judgement(
        load_parameter=t,
        verdict=verdict,
        reason=reason,
        distance=apart,
        index=exact.index,
        residual=exact.error,
        friction=friction(scene, given, exact),
        exact=exact,
    )


def _ruled(
    response: Response, scene: Scene, given: Given, exact: Equilibrium, apart: Distance, allowed: float
) -> tuple[Verdict, str]:
    """Return the verdict on an answer next to an exact equilibrium, and its reason."""
    name, size = apart.largest
    if not apart.place <= PLACE:
        return Verdict.NOT_AN_EQUILIBRIUM, f"supports and contacts are off by {apart.place:.2g} L"
    if not size <= allowed:
        return Verdict.NOT_AN_EQUILIBRIUM, f"{name} off by {size:.2g}, allowed {allowed:.2g}"
    loose = "" if response.continuum else unbalanced(scene, given)
    if loose:
        return Verdict.NOT_AN_EQUILIBRIUM, loose
    broken = next(inadmissible(scene, exact), "")
    if broken:
        return Verdict.INADMISSIBLE, broken
    if exact.index > 0:
        ways = "one direction lowers" if exact.index == 1 else f"{exact.index} directions lower"
        return Verdict.UNSTABLE, f"index {exact.index}: {ways} the energy"
    return Verdict.CERTIFIED, f"{name} off by {size:.2g}"


def _unplaced(response: Response, scene: Scene, k: int) -> Iterator[str]:
    """Yield beams whose stated place is none."""
    for beam in scene.beams:
        _, line = response.axis_line(beam.name, k)
        if not np.all(np.isfinite(line)) or not np.all(np.isfinite(response.tips[beam.name][k])):
            yield f"the position of {beam.name} is not finite"


def impossible(response: Response, scene: Scene, k: int) -> Iterator[str]:
    """Yield what of an answer cannot be: other load parameters, other pairs or supports, forces that pull or are none."""
    if k >= len(scene.times) or response.load_parameter[k] != scene.times[k]:
        yield f"the load parameter {response.load_parameter[k]:.6g} is none of the scene's"
    elif response.contacts.keys() != {spec.pair for spec in scene.contacts}:
        yield "the contact pairs are not the scene's"
    elif response.supports.keys() != {support.beam for support in scene.all_supports}:
        yield "the supported beams are not the scene's"
    else:
        for spec in scene.contacts:
            yield from _impossible_contact(response.contacts[spec.pair], scene, spec, k)


def _impossible_contact(contact: ContactHistory, scene: Scene, spec: ContactSpec, k: int) -> Iterator[str]:
    force, arc = float(contact.force[k]), float(contact.arc_position[k])
    if not math.isfinite(force):
        yield f"the force of {spec.pair} is not finite"
    elif force < -PULL * least_force(scene):
        yield f"the contact force of {spec.pair} pulls"
    elif force != 0.0 and not 0.0 <= arc <= scene.beam(spec.beam).length:
        yield f"the arc position of {spec.pair} is not on its beam"
    elif force != 0.0 and contact.vector is not None:
        size = float(np.hypot(*contact.vector[k]))
        if not abs(size - abs(force)) <= LAST_PLACES * size:
            yield f"the force of {spec.pair} and its components differ"


def _with_vectors(given: Given, response: Response, exact: Equilibrium, k: int) -> Given:
    """Give contacts whose direction is not stated the exact one."""
    forces = dict(given.forces)
    for pair, force in given.forces.items():
        if math.isnan(force[0]):
            x, y = exact.contacts[pair].force / max(float(np.hypot(*exact.contacts[pair].force)), 1e-300)
            size = float(response.contacts[pair].force[k])
            forces[pair] = (size * float(x), size * float(y))
    return Given(**{**vars(given), "forces": forces})
