"""Structures that the verification tests share: cantilevers under pins, the sections of [P], frames, rigid motions."""

from dataclasses import replace

import numpy as np

import tsm
from comparisons.exact.rod import rod_under_pin
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene

PINS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""Places of the pin in [P] 4.1."""
EXAMPLES = {"4.1": "cantilever-critical-area", "4.2": "ks-cantilever", "4.3": "double-beam"}
BEAMS = {example: to_structure(load_scene(scene)).beams[0] for example, scene in EXAMPLES.items()}
SECTIONS = {example: (beam.section, beam.length) for example, beam in BEAMS.items()}
"""Sections and lengths of the beams of [P]."""
KS = BEAMS["4.2"].section
KS_PATH = load_scene("ks-cantilever").pins[0].points


def steps(count):
    return np.arange(1, count + 1) / count


def square(height):
    """A square section with E = 1 and nu = .3."""
    return tsm.Section.rectangle(width=height, height=height, youngs_modulus=1.0, shear_modulus=1 / 2.6)


def cantilever(
    *paths, section=KS, length=1.0, elements=1, element="exact", side="right", offset=0.0, load=None
):
    """Cantilever along x under pins that follow paths."""
    names = [f"p{k}" for k in range(len(paths))]
    beam = tsm.Beam(
        name="b", start=(0.0, 0.0), end=(length, 0.0), section=section, elements=elements, element=element
    )
    return tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=tuple(tsm.Pin(name=name, path=path) for name, path in zip(names, paths, strict=True)),
        contacts=tuple(tsm.ContactPair(node=name, beam="b", side=side, offset=offset) for name in names),
        loads=(load,) if load else (),
    )


def raised(x, depth):
    """The path of a pin that moves straight up."""
    return ((x, 0.0), (x, depth))


def oracle(structure, t):
    """The rod at load parameters, from comparisons.exact."""
    beam, pin = structure.beams[0], structure.pins[0]
    points = [pin.position(x) for x in (0.0, *t)]
    s = beam.section
    return rod_under_pin(
        points, EA=s.EA, GA=s.GA, EI=s.EI, length=beam.length, offset=structure.contacts[0].offset
    )


def dimensionless(result):
    """Force, arc position and clamp moment, tip, over the beam's own units; shape (steps, 5)."""
    beam = result.model.structure.beams[0]
    (contact,), EI, L = result.contacts.values(), beam.section.EI, beam.length
    found = [
        contact.force * L**2 / EI,
        contact.arc_position / L,
        next(iter(result.supports.values())).moment * L / EI,
    ]
    return np.stack([*found, *result.tips[beam.name].T / L], axis=1)


def slip_offs(result):
    return [e.load_parameter for e in result.events if e.kind is tsm.EventKind.SLIP_OFF]


def essentials(result):
    """Events but those of the mesh."""
    return [(e.kind, e.pair) for e in result.events if e.kind is not tsm.EventKind.PASS_THROUGH]


def double_beam(element="exact", elements=None):
    return to_structure(load_scene("double-beam"), element=element, elements=elements)


def divided(scene, elements, element="mixed"):
    """A frame with `elements` a beam, a quarter of that in the short one beside the load."""
    counts = {"near": max(1, elements // 4)}
    beams = tuple(replace(beam, elements=counts.get(beam.name, elements)) for beam in scene.beams)
    return to_structure(replace(scene, beams=beams), element=element)


def limit_points(structure, arc_length, count, **settings):
    """Load parameters at the limit points of a traced path."""
    result = tsm.trace(structure, arc_length=arc_length, steps=count, settings=tsm.Settings(**settings))
    return [e.load_parameter for e in result.events if e.kind is tsm.EventKind.LIMIT_POINT]


def places(elements, length, extra=()):
    """Places on and beside every node of a mesh: one unit in the last place, 1e-16 to 1e-1 of an element, the middle, and `extra`."""
    powers = 10.0 ** np.arange(-16, 0)
    away = np.concatenate([[0.0, 0.5], powers, -powers, extra])
    for node in range(1, elements):
        x0 = length * node / elements
        yield [*(x0 + away * length / elements).tolist(), np.nextafter(x0, 0), np.nextafter(x0, 9)]


def turn(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def moved(structure, angle, shift):
    """The structure turned about the origin, then shifted; prescribed displacements and loads turn with it."""

    def place(point):
        return tuple((turn(angle) @ np.array(point, dtype=float) + shift).tolist())

    def turned(vector):
        return tuple((turn(angle) @ np.array(vector)).tolist())

    def moving(support):
        if support.ux is None or support.uy is None:
            return support
        ux, uy = turned((support.ux, support.uy))
        return replace(support, ux=ux, uy=uy)

    return replace(
        structure,
        beams=tuple(replace(b, start=place(b.start), end=place(b.end)) for b in structure.beams),
        supports=tuple(moving(support) for support in structure.supports),
        pins=tuple(replace(pin, path=tuple(place(point) for point in pin.path)) for pin in structure.pins),
        loads=tuple(replace(load, force=turned(load.force)) for load in structure.loads),
    )


def swapped(structure):
    """The structure with its beams named from their other ends; nodes come from the other side."""
    other = {"start": "end", "end": "start"}
    side = {"left": "right", "right": "left"}
    return replace(
        structure,
        beams=tuple(replace(b, start=b.end, end=b.start) for b in structure.beams),
        supports=tuple(replace(s, end=other[s.end]) for s in structure.supports),
        contacts=tuple(replace(c, side=side[c.side]) for c in structure.contacts),
        loads=tuple(replace(load, end=other[load.end]) for load in structure.loads),
    )


def mirrored(structure):
    """The mirror image of beams along x: pins above come from below, nodes from the other side."""
    side = {"left": "right", "right": "left"}
    return replace(
        structure,
        pins=tuple(replace(p, path=tuple((x, -y) for x, y in p.path)) for p in structure.pins),
        contacts=tuple(replace(c, side=side[c.side]) for c in structure.contacts),
    )


def forces(result):
    """Contact forces and support moments, which no rigid motion changes."""
    contacts = [contact.force for contact in result.contacts.values()]
    return np.array([*contacts, *(support.moment for support in result.supports.values())])
