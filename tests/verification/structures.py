"""Structures that the verification tests share: cantilevers under pins, the sections of [P], frames, rigid motions."""

import numpy as np

import tsm
from comparisons.exact import rod_under_pin
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene
from tests.tsm import structures

PINS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""Places of the pin in [P] 4.1."""
EXAMPLES = {"4.1": "cantilever-critical-area", "4.2": "ks-cantilever", "4.3": "double-beam"}
BEAMS = {example: to_structure(load_scene(scene)).beams[0] for example, scene in EXAMPLES.items()}
SECTIONS = {example: (beam.section, beam.length) for example, beam in BEAMS.items()}
"""Sections and lengths of the beams of [P]."""
KS = BEAMS["4.2"].section
SECTION, LENGTH = SECTIONS["4.1"]


def cantilever(*paths, section=KS, element="exact", **more):
    return structures.cantilever(*paths, section=section, element=element, **more)


def square(height):
    return tsm.Section.rectangle(width=height, height=height, youngs_modulus=1.0, shear_modulus=1 / 2.6)


def oracle(structure, t):
    """The rod at load parameters, from comparisons.exact."""
    beam, pin = structure.beams[0], structure.pins[0]
    points = [pin.position(x) for x in (0.0, *t)]
    s = beam.section
    return rod_under_pin(points, EA=s.EA, GA=s.GA, EI=s.EI, length=beam.length)


def off_rod(structure, t):
    """Result, and its largest errors of the force, relative, and of the arc position against the rod."""
    result, exact = tsm.solve(structure, t), oracle(structure, t)
    contact = result.contacts["p0->b"]
    force, arc = contact.force / exact.magnitude[1:] - 1, contact.arc_position - exact.arc_position[1:]
    return result, max(np.abs(force).max(), np.abs(arc).max())


def dimensionless(result):
    """Force, arc position and clamp moment, tip, over the beam's own units; shape (steps, 5)."""
    beam = result.model.structure.beams[0]
    (contact,), EI, L = result.contacts.values(), beam.section.EI, beam.length
    moment = next(iter(result.supports.values())).moment
    found = [contact.force * L**2 / EI, contact.arc_position / L, moment * L / EI]
    return np.stack([*found, *result.tips[beam.name].T / L], axis=1)


def slip_offs(result):
    return structures.when(result, tsm.EventKind.SLIP_OFF)


def places(elements, length, extra=()):
    """Places on and beside every node of a mesh: one unit in the last place, 1e-16 to 1e-1 of an element, the middle, and `extra`."""
    powers = 10.0 ** np.arange(-16, 0)
    away = np.concatenate([[0.0, 0.5], powers, -powers, extra])
    for node in range(1, elements):
        x0 = length * node / elements
        yield [*(x0 + away * length / elements).tolist(), np.nextafter(x0, 0), np.nextafter(x0, 9)]
