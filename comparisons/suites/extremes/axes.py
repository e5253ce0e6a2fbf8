"""The matrix: its scenes, of one cantilever of length 1 and modulus 1, and its cells; `axes.toml` has the values along each axis."""

import math
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, ROD, SOLID, TSM, Model
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene
from comparisons.scene.rules import Point
from comparisons.suite import case, changed
from comparisons.suites.extremes.cell import Against, Allowance, Cell, Check, circle, energy
from tsm.elements import ELEMENTS, MIXED, TIMOSHENKO, ClosedForm, ElementType

AXES: dict[str, dict[str, Any]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
SLENDERNESS = 50.0
"""Default slenderness L/h, taken from Konyukhov and Schweizerhof's cantilever."""
MESH, COARSE = (50, 2), (25, 2)
TARGET = Allowance(1e-6, "the target for 40 elements up to L/h = 1e5")
UNITS = Allowance(1e-9, "units do not matter")


def cantilever(*, length: float = 1.0, slenderness: float = SLENDERNESS, **more: Any) -> BeamSpec:
    """Return a clamped beam of square section; `more` goes to `BeamSpec`."""
    section = {"width": length / slenderness, "height": length / slenderness, "poissons_ratio": 0.3}
    stated = {"youngs_modulus": 1.0, "material": "biot-linear", **section, **more}
    return BeamSpec(name="beam", start=(0.0, 0.0), end=(length, 0.0), clamped=("start",), **stated)


def sheared(psi: float) -> BeamSpec:
    """Return the cantilever with ``psi = EI/(GA L^2)``, and with EA and EI of `cantilever`."""
    h = 1 / SLENDERNESS
    second_moment = h**4 / 12
    none: dict[str, Any] = dict.fromkeys(("width", "height", "poissons_ratio"))
    stiffness = {"shear_modulus": second_moment / psi / h**2, "area": h**2, "second_moment": second_moment}
    return cantilever(**none, material="st-venant-kirchhoff", **stiffness)


def pushed(beam: BeamSpec, *path: Point, steps: int = 10, **contact: Any) -> Scene:
    """Return `beam` under a pin that follows `path` from below; `contact` goes to `ContactSpec`."""
    return Scene(
        name="pushed",
        load_parameters=steps,
        beams=(beam,),
        pins=(PinSpec(name="pin", path=path),),
        contacts=(ContactSpec(node="pin", beam="beam", side="right", **contact),),
    )


def half_circle(beam: BeamSpec, *, surface: str = "axis", **more: Any) -> Scene:
    """Return the path of Konyukhov and Schweizerhof: from the tip to the end of a half circle with the beam's length."""
    L, below = beam.length, 0.0 if surface == "axis" else -beam.height_at(0.5) / 2
    return pushed(beam, (L, below), (0.0, below + 2 * L / math.pi), surface=surface, **more)


def kinds(*, meshed: bool | None = None) -> list[ElementType]:
    """Return the types of TSM elements of the matrix, those without a mesh first; with `meshed` only those with one, or without."""
    found = sorted((kind for kind in ELEMENTS.values() if not kind.variant), key=lambda kind: kind.meshed)
    return [kind for kind in found if meshed in (None, kind.meshed)]


def rod(scene: Scene, allowed: Allowance | None = None) -> Against:
    """Return the comparison with the exact rod on `scene`."""
    return Against(case=case(scene, ROD), allowed=allowed)


def cell(model: Model, column: str, scene: Scene, *checks: Check, row: str = "", **options: Any) -> Cell:
    """Return the cell of a model with options, in a row of its name by default."""
    return Cell(row=row or model.name, column=column, case=case(scene, model, **options), checks=checks)


def beam(column: str, scene: Scene, kind: ElementType, elements: int | None, row: str = "") -> Cell:
    """Return the cell of TSM, against the rod of the same shear stiffness: that of an Euler-Bernoulli element is rigid in shear."""
    rigid = {"beam.poissons_ratio": None, "beam.shear_modulus": 1e9 * scene.beams[0].youngs_modulus}
    stiff = scene if kind.sheared else changed(scene, rigid)
    return cell(TSM, column, scene, rod(stiff), row=row or kind.name, element=kind.name, elements=elements)


def everything(
    column: str,
    scene: Scene,
    elements: int | None,
    mesh: tuple[int, int] | None = None,
    *,
    only: Iterable[ElementType] | None = None,
    exact: bool = True,
) -> Iterator[Cell]:
    """Yield the cells of all models: beams, those without a mesh of one element, the solid if it has a mesh, exact answers by their energy."""
    for model in MODELS.values():
        against = () if model is ROD else (rod(scene),)
        if model is TSM:
            for kind in kinds() if only is None else only:
                yield beam(column, scene, kind, elements if kind.meshed else 1)
        elif model.continuum:
            if mesh:
                yield cell(model, column, scene, *against, mesh=mesh)
        elif model.meshed:
            yield cell(model, column, scene, *against)
        elif exact:
            yield cell(model, column, scene, energy, *against)


def _units(lengths: Sequence[float], moduli: Sequence[float]) -> Iterator[Cell]:
    plain = half_circle(cantilever())
    for length, modulus in product(lengths, moduli):
        scene = half_circle(cantilever(length=length, youngs_modulus=modulus))
        for one in everything(f"L {length:g}, E {modulus:g}", scene, 10, COARSE):
            itself = replace(one.case, scene=plain)
            yield one.also(Against(case=itself, name="itself at L = 1, E = 1", allowed=UNITS))


def _slenderness(slenderness: Sequence[float], solids_to: float) -> Iterator[Cell]:
    fourth = {kind.name for kind in kinds() if isinstance(kind, ClosedForm) and kind.order >= 4}
    for slender in slenderness:
        scene = half_circle(cantilever(slenderness=slender))
        for one in everything(f"{slender:g}", scene, 40, MESH if slender <= solids_to else None):
            yield one.also(rod(scene, TARGET)) if one.row in fourth and 50 <= slender <= 1e5 else one


def _shear(powers: Sequence[int]) -> Iterator[Cell]:
    for power in powers:
        yield from everything(f"1e{power}", half_circle(sheared(10.0**power / 20**2)), 20)
    yield from everything("[P] 4.2", replace(load_scene("ks-printed-shear"), load_parameters=10), 20)


def _elements(counts: Sequence[int], finest: int) -> Iterator[Cell]:
    scene = half_circle(cantilever())
    yield from everything("1", scene, None, only=())
    for count in counts:
        mesh = (count, 2) if 2 <= count <= finest else None
        yield from everything(f"{count}", scene, count, mesh, only=kinds(meshed=True), exact=False)
        for kind in kinds(meshed=False) if count <= finest else ():
            yield beam(f"{count}", scene, kind, count)


def _ratio(powers: Sequence[int]) -> Iterator[Cell]:
    for power in powers:
        growth = np.logspace(0, power, 20)
        at_clamp = np.cumsum(growth / growth.sum())[:-1]
        for where, nodes in (("clamp", at_clamp), ("tip", 1 - at_clamp[::-1])):
            scene = half_circle(cantilever(nodes=tuple(nodes.tolist())))
            column = f"1e{power}, fine at {where}"
            yield from everything(column, scene, None, only=kinds(meshed=True), exact=False)


def _contact(parts: Sequence[float]) -> Iterator[Cell]:
    """A pin beside a node in the middle, beside the clamp, beside the tip, in parts of one of ten elements."""
    part = 1 / 10

    def beside(name: str, x: float) -> dict[str, float]:
        ulps = {f"{name} {sign}ulp": math.nextafter(x, float(f"{sign}inf")) for sign in "+-"}
        return {f"at {name}": x, **ulps}

    nodes = beside("node", 0.5)
    nodes |= {f"node {size:+g} l": 0.5 + size * part for one in parts for size in (one, -one)}
    tips = beside("tip", 1.0) | {f"tip -{size:g} l": 1 - size * part for size in parts}
    paths = {column: ((x, 0.0), (x, 0.02)) for column, x in nodes.items()}
    paths["at clamp"] = (0.0, 0.0), (0.0, 0.02)
    paths |= {f"clamp +{one:g} l": ((one * part, 0.0), (one * part, 0.1 * one * part)) for one in parts}
    paths |= {column: ((x, 0.0), (x - 0.02, 0.02)) for column, x in tips.items()}
    for column, path in paths.items():
        yield from everything(column, pushed(cantilever(), *path), 10)


def _load_step(counts: Sequence[int], finest: int) -> Iterator[Cell]:
    for steps in counts:
        scene = half_circle(cantilever(), steps=steps)
        yield from everything(f"{steps}", scene, 20, COARSE)
        for kind in (MIXED, TIMOSHENKO) if steps <= finest else ():
            yield beam(f"{steps}", scene, kind, 200, f"{kind.name}, 200 elements")


def _penalty(powers: Sequence[int]) -> Iterator[Cell]:
    strip = cantilever()
    for surface, power in product(("axis", "face"), powers):
        plain = case(half_circle(strip, surface=surface), SOLID, mesh=MESH)
        penalty = 10.0**power * 25.0 * strip.youngs_modulus * (1 / SLENDERNESS)
        allowed = Allowance(40 * (10 * strip.EI / penalty) + 1e-6, "what the penalty lets the beam give way")
        check = Against(case=plain, name="itself with the default penalty", allowed=allowed)
        scene = half_circle(strip, surface=surface, penalty=penalty)
        yield cell(SOLID, f"1e{power}", scene, check, row=f"{SOLID.name}, {surface}", mesh=MESH)


def _poissons_ratio(ratios: Sequence[float]) -> Iterator[Cell]:
    for nu in ratios:
        yield from everything(f"{nu:g}", half_circle(cantilever(poissons_ratio=nu)), 20, MESH)


def _depth() -> Iterator[Cell]:
    slender = cantilever(length=4.0, slenderness=200)
    behind = ((0.5, 0.0), (0.5, 0.1), (-0.3, 0.1))
    limit = pushed(slender, (1.0, 0.0), (1.0, 2.0), steps=20)
    yield from everything("4.1, slip-off at .99 of the way", load_scene("cantilever-critical-area"), 18)
    yield from everything("limit point of the force", limit, 22, MESH)
    yield from everything("behind the clamp", pushed(cantilever(), *behind, steps=20), 31, MESH)
    strip = cantilever()
    for turns, kind in product((1, 2), kinds()):
        load = LoadSpec(beam="beam", end="end", moment=2 * math.pi * turns * strip.EI / strip.length)
        scene = Scene(name="rolled-up", load_parameters=8, beams=(strip,), loads=(load,))
        count = 40 * turns if kind.meshed else 1
        yield cell(TSM, f"roll-up, {turns}", scene, circle, row=kind.name, element=kind.name, elements=count)


def _time(counts: Sequence[int], cut_back: int) -> Iterator[Cell]:
    """A pin under ``.9 L`` that touches, lifts the beam by ``.1 L`` and leaves it; two states a cycle."""
    low, high = (0.9, -0.1), (0.9, 0.1)
    for count in counts:
        few = count <= cut_back
        scene = pushed(cantilever(), low, *(high, low) * count, steps=2 * count)
        only = [kind for kind in kinds() if few or kind.contact_unknowns]
        yield from everything(f"{count}", scene, 15, COARSE if few else None, only=only)


CELLS: dict[str, Callable[..., Iterator[Cell]]] = {
    axis.__name__[1:].replace("_", "-"): axis
    for axis in (
        _units, _slenderness, _shear, _elements, _ratio, _contact, _load_step, _penalty, _poissons_ratio, _depth, _time,
    )
}  # fmt: skip


def matrix(*, quick: bool = False) -> list[Cell]:
    """Return the cells of all axes, fewer if quick."""
    found = []
    for name, axis in AXES.items():
        values = axis.get("values", {}) | (axis.get("quick", {}) if quick else {})
        found += [replace(one, axis=name) for one in CELLS[name](**values)]
    return found
