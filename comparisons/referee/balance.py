"""Global balance of the forces and moments of an answer."""

import numpy as np

from comparisons.referee.distance import LAST_PLACES, LEAST, UNRESOLVED, least_force, node_place
from comparisons.referee.start import AnswerState
from comparisons.scene import ContactSpec, Scene

BALANCE = 1e-6
"""Largest imbalance over the largest force; the models' tolerances are far smaller."""


def unbalanced(scene: Scene, answer: AnswerState) -> str:
    """Return a sentence if forces or moments do not balance, otherwise an empty string.

    ``sum R + sum F + t P = 0`` and ``sum (M + x_R x R) + sum x_F x F + t (m + x_P x P) = 0`` with the reactions R and M, the pins'
    forces F at the pins' centres x_F, and the dead loads P and m. Contacts between beams are internal. The force of a round pin of
    radius R acts on its circumference; a tangential force F_t adds the moment ``-side R F_t``, side = 1 for a pin on the right.
    """
    t, origin = answer.load_parameter, np.array(scene.beams[0].start)
    acting = [(end, np.array([x, y]), moment) for end, (x, y, moment) in answer.reactions.items()]
    acting += [(load.node, t * np.array(load.force), t * load.moment) for load in scene.loads]
    pins = [spec for spec in scene.contacts if spec.pair in answer.forces and "." not in spec.node]
    acting += [(spec.node, np.array(answer.forces[spec.pair]), _roll(scene, answer, spec)) for spec in pins]
    places = [node_place(scene, answer, node) - origin for node, _, _ in acting]
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


def _roll(scene: Scene, answer: AnswerState, spec: ContactSpec) -> float:
    """Moment of a pin's force about its centre."""
    if not spec.friction:
        return 0.0
    return (1.0 if spec.side == "left" else -1.0) * scene.radius(spec) * answer.drags[spec.pair]
