"""The scenes of the matrix, of one cantilever of length 1 and modulus 1, and the cells of every model."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from comparisons.cases.case import Case
from comparisons.claims.extremes.cell import Against, Allowance, Cell, energy
from comparisons.models import MODELS, ROD, SOLID, TSM
from comparisons.models.options import Options
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene
from comparisons.scene.rules import Point
from tsm.elements import ELEMENTS, ElementType

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


def rolled_up(beam: BeamSpec, turns: int) -> Scene:
    """Return `beam` under a moment at its tip that bends it to `turns` circles."""
    load = LoadSpec(beam="beam", end="end", moment=2 * math.pi * turns * beam.EI / beam.length)
    return Scene(name="rolled-up", load_parameters=8, beams=(beam,), loads=(load,))


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


def beam(column: str, scene: Scene, kind: ElementType, options: Options, row: str = "") -> Cell:
    """Return the cell of TSM, against the rod of the same shear stiffness: that of an Euler-Bernoulli element is rigid in shear."""
    case, stiff = Case(scene=scene, model=TSM.name, options=replace(options, element=kind.name)), scene
    if not kind.sheared:
        rigid = (
            replace(one, poissons_ratio=None, shear_modulus=1e9 * one.youngs_modulus) for one in scene.beams
        )
        stiff = replace(scene, beams=tuple(rigid))
    return Cell(row=row or kind.name, column=column, case=case, against=(rod(stiff),))


def beams(
    column: str, scene: Scene, elements: int | None, *, only: Iterable[ElementType] | None = None
) -> Iterator[Cell]:
    """Yield the cells of beams against the rod; elements without a mesh are one a beam."""
    for kind in kinds() if only is None else only:
        yield beam(column, scene, kind, Options(elements=elements if kind.meshed else 1))
    for model in MODELS.values():
        if model.meshed and not model.continuum and model is not TSM:
            case = Case(scene=scene, model=model.name)
            yield Cell(row=model.name, column=column, case=case, against=(rod(scene),))


def solid(
    column: str, scene: Scene, mesh: tuple[int, int], against: Against | None = None, row: str = SOLID.name
) -> Cell:
    """Return the cell of the solid, by default against the rod."""
    case = Case(scene=scene, model=SOLID.name, options=Options(mesh=mesh))
    return Cell(row=row, column=column, case=case, against=(against or rod(scene),))


def exact_answers(column: str, scene: Scene) -> Iterator[Cell]:
    """Yield the cells of the models without a mesh: by their energy, and against the rod."""
    for model in (one for one in MODELS.values() if not one.meshed):
        others = () if model is ROD else (rod(scene),)
        case = Case(scene=scene, model=model.name)
        yield Cell(row=model.name, column=column, case=case, against=others, law=energy)


def everything(
    column: str, scene: Scene, elements: int | None, mesh: tuple[int, int] | None = None
) -> Iterator[Cell]:
    """Yield the cells of all models on a scene: beams, the solid if it has a mesh, exact answers."""
    yield from beams(column, scene, elements)
    if mesh:
        yield solid(column, scene, mesh)
    yield from exact_answers(column, scene)
