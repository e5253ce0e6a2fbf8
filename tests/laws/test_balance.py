"""Forces and moments of supports, springs, pins, loads and weight balance at every load parameter."""

import math

import numpy as np
import pytest

from comparisons.answer import ContactHistory
from comparisons.scene import ContactSpec, Scene
from tests.laws.scenes import ELEMENTS, OTHERS, answer, cases, scene
from tests.laws.transform import axis

NEWTON = 1e-6
"""Part of the largest force that Newton's method leaves."""


def pushed_at(found: Scene, spec: ContactSpec, contact: ContactHistory, k: int, t: float) -> np.ndarray:
    """The touching point on a pin: away from its centre along the normal, which friction tells from the force."""
    centre = np.array(found.pin(spec.node).position(t))
    assert contact.vector is not None
    angle = math.atan2(contact.vector[k, 1], contact.vector[k, 0])
    if contact.friction is not None:
        sign = 1.0 if spec.side == "right" else -1.0
        angle += sign * math.atan2(contact.friction.tangential[k], contact.friction.normal[k])
    return centre + found.radius(spec) * np.array([math.cos(angle), math.sin(angle)])


def cross(place: np.ndarray, force: np.ndarray) -> float:
    return float(place[0] * force[1] - place[1] * force[0])


@pytest.mark.parametrize(("model", "name"), cases(models=(*ELEMENTS, *OTHERS)))
def test_the_whole_is_in_balance(model: str, name: str) -> None:
    own = scene(name)
    given = answer(own, model)
    for k, t in enumerate(given.load_parameter):
        forces, couples = [], []  # force and place; couple

        def end(node: str, k: int = k) -> np.ndarray:
            beam, _, which = node.partition(".")
            return axis(given, own.beam(beam), k)[0 if which == "start" else -1]

        for node, held in (*given.supports.items(), *given.springs.items()):
            forces.append((held.force[k], end(node)))
            couples.append(held.moment[k])
        for spec in own.contacts:
            contact = given.contacts[spec.pair]
            if "." not in spec.node and contact.force[k]:
                vector = contact.vector
                assert vector is not None, "several pins push"
                forces.append((vector[k], pushed_at(own, spec, contact, k, float(t))))
        inside = False
        for history in own.load_histories:
            load, amount = history.load, np.array(history.at(float(t)))
            if load.force_per_length is not None:
                a, b = load.span
                forces.append(((b - a) * own.beam(load.beam).length * amount[:2], np.zeros(2)))
                inside = True
            else:
                forces.append((amount[:2], end(load.node) if load.end else np.zeros(2)))
                couples.append(amount[2])
                inside |= load.end is None
        for beam in own.beams:
            forces.append((beam.mass * np.array(own.gravity_at(float(t))), np.zeros(2)))
            inside |= beam.mass * math.hypot(*own.gravity_at(float(t))) > 0.0
        length = max(beam.length for beam in own.beams)
        least = max(1e-3 * beam.EI / beam.length**2 for beam in own.beams)
        size = max(least, *(float(np.hypot(*force)) for force, _ in forces))
        assert np.hypot(*sum(force for force, _ in forces)) <= NEWTON * size
        if not inside:
            origin = forces[0][1]
            moment = sum(couples) + sum(cross(place - origin, force) for force, place in forces)
            assert abs(moment) <= NEWTON * size * length
