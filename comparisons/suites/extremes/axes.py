"""The matrix: its scenes, of one cantilever of length 1 and modulus 1, and what varies along each axis, as cells."""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from comparisons.models import MODELS, ROD, SOLID, TSM, Model
from comparisons.models.options import Options
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene
from comparisons.scene.rules import Point
from comparisons.suite.case import Case
from comparisons.suites.extremes.cell import Against, Allowance, Cell, Law, circle, energy
from tsm.elements import ELEMENTS, MIXED, TIMOSHENKO, ClosedForm, ElementType

SLENDERNESS = 50.0
"""Default slenderness L/h, taken from Konyukhov and Schweizerhof's cantilever."""


def cantilever(
    *, length: float = 1.0, youngs_modulus: float = 1.0, slenderness: float = SLENDERNESS, **more: Any
) -> BeamSpec:
    """Return a beam of square section; `more` goes to `BeamSpec`."""
    h = length / slenderness
    section = {"width": h, "height": h, "poissons_ratio": 0.3, "material": "biot-linear"}
    return _clamped(length=length, youngs_modulus=youngs_modulus, **section | more)


def _clamped(*, length: float = 1.0, youngs_modulus: float = 1.0, **section: Any) -> BeamSpec:
    ends: dict[str, Any] = {"start": (0.0, 0.0), "end": (length, 0.0)}
    return BeamSpec(name="beam", **ends, youngs_modulus=youngs_modulus, clamped=("start",), **section)


def sheared(psi: float) -> BeamSpec:
    """Return the cantilever with ``psi = EI/(GA L^2)``, and with EA and EI of `cantilever`."""
    h = 1 / SLENDERNESS
    second_moment = h**4 / 12
    return _clamped(shear_modulus=second_moment / psi / h**2, area=h**2, second_moment=second_moment)


def pushed(beam: BeamSpec, *path: Point, steps: int, **contact: Any) -> Scene:
    """Return `beam` under a pin that follows `path` from below; `contact` goes to `ContactSpec`."""
    return Scene(
        name="pushed",
        load_parameters=steps,
        beams=(beam,),
        pins=(PinSpec(name="pin", path=path),),
        contacts=(ContactSpec(node="pin", beam="beam", side="right", **contact),),
    )


def half_circle(beam: BeamSpec, *, steps: int = 10, surface: str = "axis", **contact: Any) -> Scene:
    """Return the path of Konyukhov and Schweizerhof: from the tip to the end of a half circle with the beam's length."""
    L, below = beam.length, 0.0 if surface == "axis" else -beam.height_at(0.5) / 2
    return pushed(beam, (L, below), (0.0, below + 2 * L / math.pi), steps=steps, surface=surface, **contact)


def raised(beam: BeamSpec, x: float, lift: float, *, steps: int = 10) -> Scene:
    """Return a pin under the beam at `x` that moves straight up."""
    return pushed(beam, (x, 0.0), (x, lift), steps=steps)


def cycles(beam: BeamSpec, count: int) -> Scene:
    """Return a pin under ``.9 L`` that touches, lifts the beam by ``.1 L`` and leaves it, `count` times; two states a cycle."""
    L = beam.length
    low, high = (0.9 * L, -0.1 * L), (0.9 * L, 0.1 * L)
    return pushed(beam, low, *(high, low) * count, steps=2 * count)


def kinds(*, meshed: bool | None = None) -> list[ElementType]:
    """Return the types of TSM elements of the matrix, those without a mesh first; with `meshed` only those with one, or without."""
    found = sorted((kind for kind in ELEMENTS.values() if not kind.variant), key=lambda kind: kind.meshed)
    return [kind for kind in found if meshed in (None, kind.meshed)]


def rod(scene: Scene, allowed: Allowance | None = None) -> Against:
    """Return the comparison with the exact rod on `scene`."""
    return Against(case=Case(scene=scene, model=ROD.name), allowed=allowed)


def cell(
    model: Model,
    column: str,
    scene: Scene,
    *against: Against,
    row: str = "",
    law: Law | None = None,
    **options: Any,
) -> Cell:
    """Return the cell of a model with options, in a row of its name by default."""
    case = Case(scene=scene, model=model.name, options=Options(**options))
    return Cell(row=row or model.name, column=column, case=case, against=against, law=law)


def beam(column: str, scene: Scene, kind: ElementType, elements: int | None, row: str = "") -> Cell:
    """Return the cell of TSM, against the rod of the same shear stiffness: that of an Euler-Bernoulli element is rigid in shear."""
    stiff = scene
    if not kind.sheared:
        rigid = (
            replace(one, poissons_ratio=None, shear_modulus=1e9 * one.youngs_modulus) for one in scene.beams
        )
        stiff = replace(scene, beams=tuple(rigid))
    return cell(TSM, column, scene, rod(stiff), row=row or kind.name, element=kind.name, elements=elements)


def beams(
    column: str, scene: Scene, elements: int | None, *, only: Iterable[ElementType] | None = None
) -> Iterator[Cell]:
    """Yield the cells of beams against the rod; elements without a mesh are one a beam."""
    for kind in kinds() if only is None else only:
        yield beam(column, scene, kind, elements if kind.meshed else 1)
    for model in MODELS.values():
        if model.meshed and not model.continuum and model is not TSM:
            yield cell(model, column, scene, rod(scene))


def exact_answers(column: str, scene: Scene) -> Iterator[Cell]:
    """Yield the cells of the models without a mesh: by their energy, and against the rod."""
    for model in (one for one in MODELS.values() if not one.meshed):
        yield cell(model, column, scene, *(() if model is ROD else (rod(scene),)), law=energy)


def everything(
    column: str, scene: Scene, elements: int | None, mesh: tuple[int, int] | None = None
) -> Iterator[Cell]:
    """Yield the cells of all models on a scene: beams, the solid if it has a mesh, exact answers."""
    yield from beams(column, scene, elements)
    if mesh:
        yield cell(SOLID, column, scene, rod(scene), mesh=mesh)
    yield from exact_answers(column, scene)


MESH = (50, 2)
COARSE = (25, 2)
HALF_CIRCLE = "the half circle of Konyukhov and Schweizerhof"
TARGET = Allowance(1e-6, "the target for 40 elements up to L/h = 1e5")
UNITS = Allowance(1e-9, "units do not matter")
CUT_BACK = 100
"""Cycles of what cuts back several steps in each."""


def _units(quick: bool) -> Iterator[Cell]:
    plain = list(everything("", half_circle(cantilever()), 10, COARSE))
    lengths = (1e-9, 1.0, 1e6) if quick else (1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6)
    moduli = (1e-6, 1e15) if quick else (1e-6, 1.0, 1e5, 1e10, 1e15)
    for length, modulus in product(lengths, moduli):
        scene = half_circle(cantilever(length=length, youngs_modulus=modulus))
        own = everything(f"L {length:g}, E {modulus:g}", scene, 10, COARSE)
        for one, unit in zip(own, plain, strict=True):
            itself = Against(case=unit.case, name="itself at L = 1, E = 1", allowed=UNITS)
            yield replace(one, against=(*one.against, itself))


def _slenderness(quick: bool) -> Iterator[Cell]:
    fourth = {kind.name for kind in kinds() if isinstance(kind, ClosedForm) and kind.order >= 4}
    for slenderness in (2, 50, 1e3, 1e5, 1e6) if quick else (2, 5, 10, 20, 50, 100, 1e3, 1e4, 1e5, 1e6):
        scene = half_circle(cantilever(slenderness=slenderness))
        mesh = MESH if slenderness <= 1e3 and not (quick and slenderness == 1e3) else None
        for one in everything(f"{slenderness:g}", scene, 40, mesh):
            promised = one.row in fourth and 50 <= slenderness <= 1e5
            yield replace(one, against=(*one.against, rod(scene, TARGET))) if promised else one


def _shear(quick: bool) -> Iterator[Cell]:
    elements = 20
    powers = (-14, -4, 0, 4) if quick else (-14, -11, -8, -6, -4, -2, -1, 0, 1, 2, 3, 4)
    scenes = {f"1e{power}": half_circle(sheared(10.0**power / elements**2)) for power in powers}
    scenes["[P] 4.2"] = replace(load_scene("ks-printed-shear"), load_parameters=10)
    for column, scene in scenes.items():
        yield from everything(column, scene, elements)


def _elements(quick: bool) -> Iterator[Cell]:
    scene = half_circle(cantilever())
    yield from exact_answers("1", scene)
    for count in (1, 2, 5, 50) if quick else (1, 2, 3, 5, 10, 20, 50, 200, 1000, 5000):
        yield from beams(f"{count}", scene, count, only=kinds(meshed=True))
        for kind in kinds(meshed=False) if count <= 1000 else ():
            yield beam(f"{count}", scene, kind, count)
        if 2 <= count <= 1000:
            yield cell(SOLID, f"{count}", scene, rod(scene), mesh=(count, 2))


def _ratio(quick: bool) -> Iterator[Cell]:
    for power in (3, 6) if quick else (1, 2, 3, 4, 5, 6):
        growth = np.logspace(0, power, 20)
        at_clamp = np.cumsum(growth / growth.sum())[:-1]
        for where, nodes in (("clamp", at_clamp), ("tip", 1 - at_clamp[::-1])):
            scene = half_circle(cantilever(nodes=tuple(nodes.tolist())))
            yield from beams(f"1e{power}, fine at {where}", scene, None, only=kinds(meshed=True))


def _contact(quick: bool) -> Iterator[Cell]:
    """A pin beside a node in the middle, beside the clamp, beside the tip, in parts of one of ten elements."""
    elements = 10
    part = 1 / elements
    parts = (1e-16, 1e-8, 1e-1) if quick else (1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 1e-1)
    ulp = {f"{sign}ulp": toward for sign, toward in (("+", math.inf), ("-", -math.inf))}
    lifts = {
        "at node": (0.5, 0.02),
        **{f"node {by}": (math.nextafter(0.5, to), 0.02) for by, to in ulp.items()},
    }
    for size, (sign, away) in product(parts, (("+", 1), ("-", -1))):
        lifts[f"node {sign}{size:g} l"] = 0.5 + away * size * part, 0.02
    lifts |= {"at clamp": (0.0, 0.02)}
    lifts |= {f"clamp +{size:g} l": (size * part, 0.1 * size * part) for size in parts}
    tips = {"at tip": 1.0, **{f"tip {by}": math.nextafter(1, to) for by, to in ulp.items()}}
    tips |= {f"tip -{size:g} l": 1 - size * part for size in parts}
    scenes = {column: raised(cantilever(), x, lift) for column, (x, lift) in lifts.items()}
    scenes |= {
        column: pushed(cantilever(), (x, 0.0), (x - 0.02, 0.02), steps=10) for column, x in tips.items()
    }
    for column, scene in scenes.items():
        yield from everything(column, scene, elements)


def _load_step(quick: bool) -> Iterator[Cell]:
    for steps in (1, 5, 100) if quick else (1, 2, 5, 10, 100, 1000, 10_000):
        scene = half_circle(cantilever(), steps=steps)
        yield from everything(f"{steps}", scene, 20, COARSE)
        for kind in (MIXED, TIMOSHENKO) if steps <= 1000 else ():
            yield beam(f"{steps}", scene, kind, 200, f"{kind.name}, 200 elements")


def _penalty(quick: bool) -> Iterator[Cell]:
    strip, width = cantilever(), 1 / 50
    for surface in ("axis", "face"):
        plain = Case(scene=half_circle(strip, surface=surface), model=SOLID.name, options=Options(mesh=MESH))
        for power in (-6, -2, 0, 12) if quick else (-6, -5, -4, -3, -2, -1, 0, 2, 4, 6, 8, 10, 12):
            penalty = 10.0**power * 25.0 * strip.youngs_modulus * width
            scene = half_circle(strip, surface=surface, penalty=penalty)
            softness = 10 * strip.EI / penalty
            allowed = Allowance(4 * 10 * softness + 1e-6, "what the penalty lets the beam give way")
            check = Against(case=plain, name="itself with the default penalty", allowed=allowed)
            yield cell(SOLID, f"1e{power}", scene, check, row=f"{SOLID.name}, {surface}", mesh=MESH)


def _poissons_ratio(quick: bool) -> Iterator[Cell]:
    for nu in (-0.9, 0.0, 0.4999) if quick else (-0.9, -0.5, -0.1, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999):
        yield from everything(f"{nu:g}", half_circle(cantilever(poissons_ratio=nu)), 20, MESH)


def _depth(_: bool) -> Iterator[Cell]:
    places = {
        "4.1, slip-off at .99 of the way": (load_scene("cantilever-critical-area"), 18),
        "limit point of the force": (raised(cantilever(length=4.0, slenderness=200), 1.0, 2.0, steps=20), 22),
        "behind the clamp": (pushed(cantilever(), (0.5, 0.0), (0.5, 0.1), (-0.3, 0.1), steps=20), 31),
    }
    for column, (scene, elements) in places.items():
        yield from everything(column, scene, elements, None if scene.beams[0].height is None else MESH)
    strip = cantilever()
    for turns, kind in product((1, 2), kinds()):
        load = LoadSpec(beam="beam", end="end", moment=2 * math.pi * turns * strip.EI / strip.length)
        scene = Scene(name="rolled-up", load_parameters=8, beams=(strip,), loads=(load,))
        one = beam(f"roll-up, {turns}", scene, kind, 40 * turns if kind.meshed else 1)
        yield replace(one, against=(), law=circle)


def _time(quick: bool) -> Iterator[Cell]:
    unknown = [kind for kind in kinds() if kind.contact_unknowns]
    for count in (1, 20) if quick else (1, 20, 100, 1000, 10_000):
        column, scene = f"{count}", cycles(cantilever(), count)
        yield from beams(column, scene, 15, only=kinds() if count <= CUT_BACK else unknown)
        yield from exact_answers(column, scene)
        if count <= CUT_BACK:
            yield cell(SOLID, column, scene, rod(scene), mesh=COARSE)


class Axis(NamedTuple):
    """One axis of the matrix: its title with the range, what is solved, and its cells, fewer if quick."""

    title: str
    scene: str
    cells: Callable[[bool], Iterator[Cell]]


AXES = {
    "units": Axis("units: lengths 1e-9 to 1e6, E 1e-6 to 1e15", HALF_CIRCLE, _units),
    "slenderness": Axis("slenderness L/h", HALF_CIRCLE + "; beams of 40 elements", _slenderness),
    "shear": Axis("shear Psi/l0^2", HALF_CIRCLE + "; beams of 20 elements", _shear),
    "elements": Axis("number of elements", HALF_CIRCLE, _elements),
    "ratio": Axis("longest over shortest of 20 elements", HALF_CIRCLE, _ratio),
    "contact": Axis(
        "contact position, l an element", "a pin that lifts the beam a little; beams of 10 elements", _contact
    ),
    "load-step": Axis("load steps for the whole path", HALF_CIRCLE + "; beams of 20 elements", _load_step),
    "penalty": Axis("penalty over the default", HALF_CIRCLE, _penalty),
    "poissons-ratio": Axis("Poisson's ratio", HALF_CIRCLE, _poissons_ratio),
    "depth": Axis("depth", "up to slip-off, past the limit point, roll-up by an end moment", _depth),
    "time": Axis(
        "cycles of touch and release",
        "a pin that lifts the beam by L/10 and leaves it, again and again",
        _time,
    ),
}
"""By the names in the files, in the order of the report."""


def matrix(*, quick: bool = False) -> list[Cell]:
    """Return the cells of all axes."""
    return [replace(one, axis=name) for name, axis in AXES.items() for one in axis.cells(quick)]
