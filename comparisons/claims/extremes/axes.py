"""The matrix: what varies along each axis, as cells."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from comparisons.cases.case import Case
from comparisons.claims.claim import Allowance
from comparisons.claims.extremes.cell import Cell
from comparisons.claims.extremes.checks import Against, Circle
from comparisons.claims.extremes.rows import (
    against,
    beam_case,
    beams,
    everything,
    exact_answers,
    exact_rod,
    kinds,
    solids,
    with_check,
)
from comparisons.claims.extremes.scenes import (
    cantilever,
    cycles,
    half_circle,
    pushed,
    raised,
    rolled_up,
    sheared,
)
from comparisons.models import SOLID
from comparisons.models.options import Options
from comparisons.scene import load_scene
from tsm.elements import MIXED, TIMOSHENKO, ClosedForm

MESH = (50, 2)
COARSE = (25, 2)


@dataclass(frozen=True, kw_only=True)
class Axis:
    """One axis of the matrix.

    Attributes
    ----------
    name, title : str
        In the files; for people, with the range.
    scene : str
        What is solved.
    cells : callable
        ``cells(name, quick)``: its cells, fewer if quick.
    """

    name: str
    title: str
    scene: str
    cells: Callable[[str, bool], list[Cell]]


def _units(axis: str, quick: bool) -> list[Cell]:
    plain = everything(axis, "", half_circle(cantilever()), 10, COARSE)
    lengths = (1e-9, 1.0, 1e6) if quick else (1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6)
    moduli = (1e-6, 1e15) if quick else (1e-6, 1.0, 1e5, 1e10, 1e15)
    same = Allowance(error=1e-9, why="units do not matter")
    cells = []
    for length, modulus in product(lengths, moduli):
        scene = half_circle(cantilever(length=length, youngs_modulus=modulus))
        own = everything(axis, f"L {length:g}, E {modulus:g}", scene, 10, COARSE)
        for cell, unit in zip(own, plain, strict=True):
            check = Against(case=unit.case, name="itself at L = 1, E = 1", allowed=same)
            cells.append(with_check(cell, check))
    return cells


TARGET = Allowance(error=1e-6, why="the target for 40 elements up to L/h = 1e5")


def _slenderness(axis: str, quick: bool) -> list[Cell]:
    cells = []
    fourth = {kind.name for kind in kinds() if isinstance(kind, ClosedForm) and kind.order >= 4}
    for slenderness in (2, 50, 1e3, 1e5, 1e6) if quick else (2, 5, 10, 20, 50, 100, 1e3, 1e4, 1e5, 1e6):
        scene = half_circle(cantilever(slenderness=slenderness))
        promised = (Against(case=exact_rod(scene), allowed=TARGET),) if 50 <= slenderness <= 1e5 else ()
        mesh = MESH if slenderness <= 1e3 and not (quick and slenderness == 1e3) else None
        cells += [
            with_check(cell, *promised) if cell.row in fourth else cell
            for cell in everything(axis, f"{slenderness:g}", scene, 40, mesh)
        ]
    return cells


def _shear(axis: str, quick: bool) -> list[Cell]:
    elements = 20
    powers = (-14, -4, 0, 4) if quick else (-14, -11, -8, -6, -4, -2, -1, 0, 1, 2, 3, 4)
    scenes = {f"1e{power}": half_circle(sheared(10.0**power / elements**2)) for power in powers}
    scenes["[P] 4.2"] = replace(load_scene("ks-printed-shear"), load_parameters=10)
    return [cell for column, scene in scenes.items() for cell in everything(axis, column, scene, elements)]


def _elements(axis: str, quick: bool) -> list[Cell]:
    scene = half_circle(cantilever())
    cells = [*exact_answers(axis, "1", scene)]
    for count in (1, 2, 5, 50) if quick else (1, 2, 3, 5, 10, 20, 50, 200, 1000, 5000):
        column = f"{count}"
        cells += beams(axis, column, scene, count, only=kinds(meshed=True))
        for kind in kinds(meshed=False) if count <= 1000 else ():
            case = beam_case(scene, kind, None)
            case = replace(case, options=replace(case.options, elements=count))
            cells.append(against(axis, kind.name, column, case))
        if 2 <= count <= 1000:
            cells += solids(axis, column, scene, (count, 2))
    return cells


def _ratio(axis: str, quick: bool) -> list[Cell]:
    cells = []
    for power in (3, 6) if quick else (1, 2, 3, 4, 5, 6):
        growth = np.logspace(0, power, 20)
        at_clamp = np.cumsum(growth / growth.sum())[:-1]
        for where, nodes in (("clamp", at_clamp), ("tip", 1 - at_clamp[::-1])):
            scene = half_circle(cantilever(nodes=tuple(nodes.tolist())))
            cells += beams(axis, f"1e{power}, fine at {where}", scene, None, only=kinds(meshed=True))
    return cells


def _contact(axis: str, quick: bool) -> list[Cell]:
    """A pin beside a node in the middle, beside the clamp, beside the tip, in parts of one of ten elements."""
    elements = 10
    part = 1 / elements
    parts = (1e-16, 1e-8, 1e-1) if quick else (1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 1e-1)
    signed = [
        (f"{sign}{size:g} l", factor * size) for size in parts for sign, factor in (("+", 1), ("-", -1))
    ]
    places = [
        ("at node", 0.5, 0.02),
        ("node +ulp", math.nextafter(0.5, 1), 0.02),
        ("node -ulp", math.nextafter(0.5, 0), 0.02),
        *((f"node {text}", 0.5 + away * part, 0.02) for text, away in signed),
        ("at clamp", 0.0, 0.02),
        *((f"clamp +{size:g} l", size * part, 0.1 * size * part) for size in parts),
    ]
    tips = [("at tip", 1.0), ("tip +ulp", math.nextafter(1, 2)), ("tip -ulp", math.nextafter(1, 0))]
    tips += [(f"tip -{size:g} l", 1 - size * part) for size in parts]
    scenes = {column: raised(cantilever(), x, lift) for column, x, lift in places}
    scenes |= {column: pushed(cantilever(), (x, 0.0), (x - 0.02, 0.02), steps=10) for column, x in tips}
    return [cell for column, scene in scenes.items() for cell in everything(axis, column, scene, elements)]


def _load_step(axis: str, quick: bool) -> list[Cell]:
    cells = []
    for steps in (1, 5, 100) if quick else (1, 2, 5, 10, 100, 1000, 10_000):
        column, scene = f"{steps}", half_circle(cantilever(), steps=steps)
        cells += everything(axis, column, scene, 20, COARSE)
        cells += [
            against(axis, f"{kind.name}, 200 elements", column, beam_case(scene, kind, 200))
            for kind in ((MIXED, TIMOSHENKO) if steps <= 1000 else ())
        ]
    return cells


def _penalty(axis: str, quick: bool) -> list[Cell]:
    cells = []
    beam, width = cantilever(), 1 / 50
    for surface in ("axis", "face"):
        plain = Case(scene=half_circle(beam, surface=surface), model=SOLID.name, options=Options(mesh=MESH))
        for power in (-6, -2, 0, 12) if quick else (-6, -5, -4, -3, -2, -1, 0, 2, 4, 6, 8, 10, 12):
            penalty = 10.0**power * 25.0 * beam.youngs_modulus * width
            scene = half_circle(beam, surface=surface, penalty=penalty)
            softness = 10 * beam.EI / penalty
            allowed = Allowance(error=4 * 10 * softness + 1e-6, why="what the penalty lets the beam give way")
            check = Against(case=plain, name="itself with the default penalty", allowed=allowed)
            cells += solids(axis, f"1e{power}", scene, MESH, row=f"{SOLID.name}, {surface}", checks=(check,))
    return cells


def _poissons_ratio(axis: str, quick: bool) -> list[Cell]:
    ratios = (-0.9, 0.0, 0.4999) if quick else (-0.9, -0.5, -0.1, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999)
    scenes = {f"{nu:g}": half_circle(cantilever(poissons_ratio=nu)) for nu in ratios}
    return [cell for column, scene in scenes.items() for cell in everything(axis, column, scene, 20, MESH)]


def _depth(axis: str, _: bool) -> list[Cell]:
    cells = []
    places = {
        "4.1, slip-off at .99 of the way": (load_scene("cantilever-critical-area"), 18),
        "limit point of the force": (raised(cantilever(length=4.0, slenderness=200), 1.0, 2.0, steps=20), 22),
        "behind the clamp": (pushed(cantilever(), (0.5, 0.0), (0.5, 0.1), (-0.3, 0.1), steps=20), 31),
    }
    for column, (scene, elements) in places.items():
        cells += everything(axis, column, scene, elements, None if scene.beams[0].height is None else MESH)
    for turns, kind in product((1, 2), kinds()):
        case = beam_case(rolled_up(cantilever(), turns), kind, 40 * turns)
        cells.append(
            Cell(axis=axis, row=kind.name, column=f"roll-up, {turns}", case=case, checks=(Circle(),))
        )
    return cells


CUT_BACK = 100
"""Cycles of what cuts back several steps in each."""


def _time(axis: str, quick: bool) -> list[Cell]:
    cells = []
    unknown = [kind for kind in kinds() if kind.contact_unknowns]
    for count in (1, 20) if quick else (1, 20, 100, 1000, 10_000):
        column, scene = f"{count}", cycles(cantilever(), count)
        some = kinds() if count <= CUT_BACK else unknown
        cells += [*beams(axis, column, scene, 15, only=some), *exact_answers(axis, column, scene)]
        if count <= CUT_BACK:
            cells += solids(axis, column, scene, COARSE)
    return cells


HALF_CIRCLE = "the half circle of Konyukhov and Schweizerhof"
AXES = (
    Axis(name="units", title="units: lengths 1e-9 to 1e6, E 1e-6 to 1e15", scene=HALF_CIRCLE, cells=_units),
    Axis(
        name="slenderness",
        title="slenderness L/h",
        scene=HALF_CIRCLE + "; beams of 40 elements",
        cells=_slenderness,
    ),
    Axis(name="shear", title="shear Psi/l0^2", scene=HALF_CIRCLE + "; beams of 20 elements", cells=_shear),
    Axis(name="elements", title="number of elements", scene=HALF_CIRCLE, cells=_elements),
    Axis(name="ratio", title="longest over shortest of 20 elements", scene=HALF_CIRCLE, cells=_ratio),
    Axis(
        name="contact",
        title="contact position, l an element",
        scene="a pin that lifts the beam a little; beams of 10 elements",
        cells=_contact,
    ),
    Axis(
        name="load-step",
        title="load steps for the whole path",
        scene=HALF_CIRCLE + "; beams of 20 elements",
        cells=_load_step,
    ),
    Axis(name="penalty", title="penalty over the default", scene=HALF_CIRCLE, cells=_penalty),
    Axis(name="poissons-ratio", title="Poisson's ratio", scene=HALF_CIRCLE, cells=_poissons_ratio),
    Axis(
        name="depth",
        title="depth",
        scene="up to slip-off, past the limit point, roll-up by an end moment",
        cells=_depth,
    ),
    Axis(
        name="time",
        title="cycles of touch and release",
        scene="a pin that lifts the beam by L/10 and leaves it, again and again",
        cells=_time,
    ),
)
"""In the order of the report."""


def matrix(*, quick: bool = False) -> list[Cell]:
    """Return the cells of all axes."""
    return [cell for axis in AXES for cell in axis.cells(axis.name, quick)]
