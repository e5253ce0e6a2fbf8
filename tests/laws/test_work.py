"""Work is energy and what friction and jumps take: against the strain energy of the referee's equilibrium, and of the elements."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.referee import certify
from comparisons.scene import ContactSpec, PinSpec, Scene
from tests.laws.scenes import ELEMENTS, answer, cases, scene

ALLOWED = {"exact": 1e-6, "rod": 1e-8, "mixed": 2e-3, "mixed-no-bow": 5e-3}
"""Largest difference over the energy, at least 1e-4 EI/L; where a path bends sharply the integral of the work is that accurate."""


def with_work(found: Scene) -> Scene:
    """The scene, of which models state the work since a pin with friction is in it, far away."""
    if any(contact.friction for contact in found.contacts):
        return found
    beam = found.beams[0]
    (x, y), size = beam.direction, max(item.length for item in found.beams)
    start = (beam.start[0] + 1e3 * size * y, beam.start[1] - 1e3 * size * x)
    pin = PinSpec(name="far", start=start, displacement=(0.0, 0.0))
    idle = ContactSpec(node="far", beam=beam.name, side="right", friction=0.5)
    return replace(found, pins=(*found.pins, pin), contacts=(*found.contacts, idle))


def rubs(model: str) -> bool:
    return model not in tsm.ELEMENTS or tsm.ELEMENTS[model].on_varying is not None


@pytest.mark.parametrize(("model", "name"), cases(models=tuple(filter(rubs, (*ELEMENTS, "rod")))))
def test_work_is_energy_and_dissipation(model: str, name: str) -> None:
    found = with_work(scene(name))
    given = answer(found, model)
    assert given.work is not None
    if not len(given.work):
        return
    lost = sum(item.friction.dissipated[-1] for item in given.contacts.values() if item.friction is not None)
    fallen = sum(event.released for event in given.events or () if np.isfinite(event.released))
    (judged,) = certify(given, found, at=[-1], allowance=np.inf).judged
    assert judged.exact is not None, judged.reason
    bent = max(beam.EI / beam.length for beam in found.beams)
    size = max(np.abs(given.work).max(), judged.exact.strain_energy, 1e-4 * bent)
    off = given.work[-1] - lost - fallen - judged.exact.strain_energy
    assert abs(off) <= ALLOWED[model] * size
