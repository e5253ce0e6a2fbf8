"""Structures that several tests solve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import tsm

SECTION = tsm.Section(EA=100.0, GA=40.0, EI=1.0)
KS = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=2.1e4 / 2.6)
"""Section of the cantilever of Konyukhov and Schweizerhof."""
KS_PATH = ((1.0, 0.0), (0.0, 2 / np.pi))
CLAMP = tsm.Support(beam="b", end="start")


def steps(count):
    return np.arange(1, count + 1) / count


TENTHS = steps(10)


def beam(name, start, end, *, section=KS, elements=None, element="exact", **more):
    """A beam of one exact element, or of ten others."""
    elements = elements or (1 if element == "exact" else 10)
    return tsm.Beam(
        name=name, start=start, end=end, section=section, elements=elements, element=element, **more
    )


def raised(x, depth):
    return ((x, 0.0), (x, depth))


def cantilever(
    *paths, section=SECTION, length=1.0, elements=None, element="mixed", side="right", supports=(CLAMP,), load=None, **pair
):  # fmt: skip
    """A beam along x, clamped at its start, under pins that follow paths."""
    names = [f"p{k}" for k in range(len(paths))]
    return tsm.Structure(
        beams=(beam("b", (0.0, 0.0), (length, 0.0), section=section, elements=elements, element=element),),
        supports=supports,
        pins=tuple(tsm.Pin(name=name, path=path) for name, path in zip(names, paths, strict=True)),
        contacts=tuple(tsm.ContactPair(node=name, beam="b", side=side, **pair) for name in names),
        loads=(load,) if load else (),
    )


def turned(structure, angle=0.7):
    """A structure of beams and pins turned about the origin."""
    c, s = np.cos(angle), np.sin(angle)

    def at(*points):
        return tuple((float(c * x - s * y), float(s * x + c * y)) for x, y in points)

    ends = (at(beam.start, beam.end) for beam in structure.beams)
    beams = (replace(beam, start=a, end=b) for beam, (a, b) in zip(structure.beams, ends, strict=True))
    pins = (replace(pin, path=at(*pin.path)) for pin in structure.pins)
    return replace(structure, beams=tuple(beams), pins=tuple(pins))


def essentials(result):
    """Events but those of the mesh."""
    return [(e.kind, e.pair) for e in result.events if e.kind is not tsm.EventKind.PASS_THROUGH]


def kinds(result):
    return [kind for kind, _ in essentials(result)]


def when(result, kind):
    return [event.load_parameter for event in result.events if event.kind is kind]


THICK = tsm.Section(EA=4e3, GA=1e3, EI=2.0)
THIN = tsm.Section(EA=1.6e3, GA=0.4e3, EI=0.2)


def hook(elements=1, element="exact", **other):
    """A tapered strip of natural curvature under its weight and a load on a part of it."""
    strip = beam("b", (0.0, 0.0), (1.0, 0.2), section=THICK, end_section=THIN, turn=0.9, elements=elements, element=element)  # fmt: skip
    weight = tsm.LineLoad(beam="b", force=((0.3, -1.5), (0.0, 1.0), (0.1, 0.2)))
    part = tsm.LineLoad(beam="b", force=((0.5, 2.0),), start=0.3, end=0.8)
    given = {"supports": (CLAMP,), "line_loads": (weight, part), **other}
    return tsm.Structure(beams=(strip.divided(0.3, 0.8),), **given)


def pushed(elements=1, **pair):
    """The same between two pins, with an offset."""
    strip = hook().beams[0]
    pins, contacts = [], []
    for name, side, part, move in (("p", "right", 0.45, (0.02, 0.1)), ("r", "left", 0.75, (0.05, -0.02))):
        (x, y), angle = strip.point(part), strip.direction(part)
        depth = pair.get("offset", 0.0) * (1 if side == "right" else -1)
        x, y = x + depth * np.sin(angle), y - depth * np.cos(angle)
        pins.append(tsm.Pin(name=name, path=((x, y), (x + move[0], y + move[1]))))
        contacts.append(tsm.ContactPair(node=name, beam="b", side=side, **pair))
    return hook(elements, pins=tuple(pins), contacts=tuple(contacts))


def leaning():
    """A straight beam's tip, the first node of all, on a curved beam; one load on each."""
    lower = replace(hook().beams[0], name="low")
    x, y = lower.point(0.6)
    upper = beam("up", (x, y), (x - 0.6, y + 0.5), section=THIN)
    loads = (
        tsm.LineLoad(beam="low", force=((0.0, -0.5), (0.2, 0.3))),
        tsm.LineLoad(beam="up", force=((0.3, -3.0),)),
    )
    supports = (tsm.Support(beam="low", end="start"), tsm.Support(beam="up", end="end", uy=-0.05))
    contact = tsm.ContactPair(node="up.start", beam="low", side="left")
    return tsm.Structure(beams=(upper, lower), supports=supports, line_loads=loads, contacts=(contact,))


def as_mixed(structure):
    beams = tuple(replace(beam, element="mixed", elements=len(beam.parts) - 1) for beam in structure.beams)
    return replace(structure, beams=beams)
