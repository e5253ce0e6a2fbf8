"""Global balance of the forces and moments of an answer."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.distance import LAST_PLACES, LEAST, UNRESOLVED, least_force, node_place
from comparisons.referee.loads import dead_loads, lever
from comparisons.referee.start import AnswerState
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene, SpringSpec

Array = NDArray[np.float64]

PLACED = 1e-2
"""Largest relative error of a spring's moment, whose rotation an answer does not state."""
BALANCE = 1e-6
"""Largest imbalance over the largest force; the models' tolerances are far smaller."""


def unbalanced(scene: Scene, answer: AnswerState, exact: Equilibrium) -> str:
    """Return a sentence if forces or moments do not balance, otherwise an empty string.

    ``sum R + sum F + sum P = 0`` and ``sum (M + x_R x R) + sum x_F x F + sum (m + x_P x P) = 0`` with the reactions R and M, the pins'
    forces F at the pins' centres x_F, the dead loads P and m, and the forces of springs, which follow from the answer's positions.
    Contacts between beams are internal. The force of a round pin of radius R acts on its circumference; a tangential force F_t adds the
    moment ``-side R F_t``, side = 1 for a pin on the right. A load along a beam acts at its centre on the answer's axis, and the moment
    of a spring follows from the rotation in the exact equilibrium, which the answer does not state: both have an error.
    """
    origin = np.array(scene.beams[0].start)
    acting = [(end, np.array([x, y]), moment) for end, (x, y, moment) in answer.reactions.items()]
    loads = list(dead_loads(scene, answer.load_parameter))
    acting += [(load.node, np.array(load.force), load.moment) for load in loads if load.node]
    pins = [spec for spec in scene.contacts if spec.pair in answer.forces and "." not in spec.node]
    acting += [(spec.node, np.array(answer.forces[spec.pair]), _roll(scene, answer, spec)) for spec in pins]
    acting += [(spring.node, *_held(scene, answer, exact, spring)) for spring in scene.springs]
    places = [_place(scene, answer, node) - origin for node, _, _ in acting]
    length = max(beam.length for beam in scene.beams)
    unsure = sum(abs(moment) for (_, _, moment) in acting[len(acting) - len(scene.springs) :]) * PLACED
    for load in loads:
        if not load.node:
            place, error = lever(load, *answer.axes[load.beam])
            acting.append((load.beam, np.array(load.force), load.moment))
            places.append(place - origin)
            unsure += error * float(np.hypot(*load.force))
    sizes = [max(float(np.hypot(*force)), abs(moment) / length) for _, force, moment in acting]
    largest = max([*sizes, LEAST * least_force(scene)])
    allowed = BALANCE * largest + min(
        LAST_PLACES * max(beam.EA for beam in scene.beams), UNRESOLVED * largest
    )
    force = np.sum([force for _, force, _ in acting], axis=0)
    moment = sum(m + x * f[1] - y * f[0] for (x, y), (_, f, m) in zip(places, acting, strict=True))
    if not float(np.hypot(*force)) <= allowed:
        return f"reactions, contact forces and loads do not balance by {float(np.hypot(*force)) / largest:.2g} of the largest"
    if not abs(moment) <= allowed * length + unsure:
        return f"the moments do not balance by {abs(moment) / (largest * length):.2g} of the largest force times the length"
    return ""


def _place(scene: Scene, answer: AnswerState, node: str) -> Array:
    """Position of a node: prescribed if a support holds it, stated as a tip, or else the end of the stated axis, which is sampled."""
    if "." in node:
        if node in scene.prescribed_motions:
            x, y, _ = scene.prescribed_motions[node].at(answer.load_parameter)
            if x is not None and y is not None:
                return np.asarray(np.array(scene.place(node)) + np.array([x, y]))
        beam, end = node.split(".")
        if end == scene.tip(beam) and beam in answer.tips:
            return np.array(answer.tips[beam])
    return node_place(scene, answer, node)


def _held(scene: Scene, answer: AnswerState, exact: Equilibrium, spring: SpringSpec) -> tuple[Array, float]:
    """Force and moment of a spring on its joint."""
    moved = _place(scene, answer, spring.node) - np.array(scene.place(spring.node))
    return -np.array(spring.stiffness) * moved, -spring.rotation * exact.joint_rotation(spring.node)


def _roll(scene: Scene, answer: AnswerState, spec: ContactSpec) -> float:
    """Moment of a pin's force about its centre."""
    if not spec.friction:
        return 0.0
    return (1.0 if spec.side == "left" else -1.0) * scene.radius(spec) * answer.drags[spec.pair]
