"""The balance of everything that acts on the whole structure, from what an answer states alone."""

import numpy as np

from comparisons.referee.distance import LAST_PLACES, LEAST, UNRESOLVED, least_force, node_place
from comparisons.referee.start import Given
from comparisons.scene import Scene

BALANCE = 1e-6
"""Largest unbalanced part of the largest force: Newton's tolerances are far below."""


def unbalanced(scene: Scene, given: Given) -> str:
    """Return a sentence where forces or moments do not cancel, else nothing; contacts between beams are internal.

    ``sum R + sum F + t P = 0`` and ``sum (M + x_R x R) + sum x_F x F + t (m + x_P x P) = 0`` with the supports' R and M, the forces F
    of the pins at their touching points on the pin's surface and the dead loads P and m.
    """
    t, origin = given.load_parameter, np.array(scene.beams[0].start)
    acting = [(end, np.array([x, y]), moment) for end, (x, y, moment) in given.reactions.items()]
    acting += [(load.node, t * np.array(load.force), t * load.moment) for load in scene.loads]
    pins = [spec for spec in scene.contacts if spec.pair in given.forces and "." not in spec.node]
    acting += [(spec.node, np.array(given.forces[spec.pair]), 0.0) for spec in pins]
    places = [node_place(scene, given, node) - origin for node, _, _ in acting]
    length = max(beam.length for beam in scene.beams)
    sizes = [max(float(np.hypot(*force)), abs(moment) / length) for _, force, moment in acting]
    largest = max([*sizes, LEAST * least_force(scene)])
    allowed = BALANCE * largest + min(
        LAST_PLACES * max(beam.EA for beam in scene.beams), UNRESOLVED * largest
    )
    force = np.sum([force for _, force, _ in acting], axis=0)
    moment = sum(m + x * f[1] - y * f[0] for (x, y), (_, f, m) in zip(places, acting, strict=True))
    if not float(np.hypot(*force)) <= allowed:
        return f"reactions, contact forces and loads do not balance by {float(np.hypot(*force)) / largest:.2g} of the largest"
    if not abs(moment) <= allowed * length:
        return f"the moments do not balance by {abs(moment) / (largest * length):.2g} of the largest force times the length"
    return ""
