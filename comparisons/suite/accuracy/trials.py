"""The settings that are tried for an accuracy, from the cheapest on: tolerances of exact elements, graded elements, solid meshes."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from comparisons.answer import Array, Response
from comparisons.answer.errors import difference
from comparisons.answer.quantities import QUANTITIES, size
from comparisons.models import SOLID, TSM, solve
from comparisons.models.model import Options
from comparisons.models.solid import rectangle
from comparisons.scene import Scene
from tsm.elements import EXACT, MIXED, ClosedForm

FEWEST = 8
"""Least number of load parameters at which meshes are compared, if the scene has as many."""
SAFETY = 2.0
"""Safety factor of an estimate, because the error may be larger between the load parameters at which meshes are compared."""
NEWTON = 1e-10
"""Tolerance of Newton's method, in forces over ``EI/L^2`` (`tsm.Settings`)."""
SHARPEST = 1e-14
"""Least tolerance of the integration inside exact elements."""
FIRST, MOST, ROUNDS = 4, 4000, 10
"""Elements of a beam in the first graded mesh; elements and meshes at most."""
LEAST_GROWTH, MOST_GROWTH = 1.1, 4.0
"""Least and largest ratio of the numbers of elements of two successive meshes."""
LEAST = 0.05
"""Least density of elements over the largest density; a part of a beam without load keeps some elements."""
MESHES = ((12, 2), (25, 2), (50, 2), (100, 4), (200, 8), (400, 16))
"""Elements along and across a strip of `SLENDER` and more lengths over heights; fewer along in stockier ones."""
SLENDER = 20.0
ORDER = 2
"""Order of the solid's error."""


class Trial(NamedTuple):
    """A setting, the error that it is estimated to leave, infinite without an estimate, and what is said of it."""

    scene: Scene
    options: Options
    words: str
    estimate: float
    said: Sequence[str]
    response: Response | None = None


def exact(scene: Scene, accuracy: float, quantity: str, *, alone: bool) -> Iterator[Trial]:
    """Yield trials with one exact element a beam, at the tolerance of its integration that suffices."""
    # a small load needs a sharper integration for the same relative error; graded elements follow where the
    # exact ones fail
    tolerance = 1e-9
    while True:
        options = replace(TSM.reference, integration_tolerance=tolerance)
        response = solve(scene, TSM.name, options)
        size = _size(response, scene, quantity)
        estimate = (response.integration_error + NEWTON) / size if size else math.inf
        words = f"integration error {response.integration_error:.1e}, estimate {estimate:.1e} of {quantity}"
        said = [f"exact, one element a beam: {words}"]
        replaced = response.status == "INACCURATE" and not alone
        if replaced:
            said.append(f"{EXACT.name} stopped: INACCURATE; {MIXED.name} instead")
        left = estimate if response.completed else math.inf
        yield Trial(scene, options, "exact elements, one a beam", left, said, response)
        sharper = max(SHARPEST * 1.01, accuracy * size / 4)
        if replaced:
            yield from graded(scene, accuracy, quantity, MIXED)
        if not response.completed or sharper >= tolerance:
            return
        tolerance = sharper


def _size(response: Response, scene: Scene, quantity: str) -> float:
    """Return the size of a quantity in the units of the error estimate: EI/L^2, EI/L, 1."""
    row, longest = QUANTITIES[quantity], max(beam.length for beam in scene.beams)
    stiffest = max(beam.EI / beam.length**2 for beam in scene.beams)
    unit = {"force": stiffest, "moment": stiffest * longest}.get(row.unit)
    if row.over != "largest" or unit is None:
        return 1.0
    sizes = [float(size(values).max(initial=0.0)) for values in row.read(response).values()]
    return min(1.0, max(sizes, default=0.0) / unit)


def _few(scene: Scene) -> int:
    """Return the number of load parameters at which meshes are compared, a divisor of the scene's, so that the scene has all of them."""
    n = scene.load_parameters
    return next(m for m in range(min(FEWEST, n), n + 1) if n % m == 0)


def graded(scene: Scene, accuracy: float, quantity: str, kind: ClosedForm) -> Iterator[Trial]:
    """Yield trials with elements in closed form, refined where the axis is curved and forces act."""
    # a mesh is compared with the one of halved elements; the next has the number that the order predicts, with
    # equal shares of the error: its density is (kappa^4 + (N/EI)^2 + (V/EI)^2)^(p/(4 (p + 1)))
    order, element, options, few = kind.order, kind.name, Options(element=kind.name), _few(scene)
    factor, power = kind.shear_floor
    mesh = _with(scene, [np.linspace(0.0, 1.0, FIRST + 1)] * len(scene.beams))
    for _ in range(ROUNDS):
        coarse, fine = (
            solve(replace(one, load_parameters=few), TSM.name, options) for one in (mesh, _halved(mesh))
        )
        apart = float(np.fmax(difference(coarse, fine, scene, quantity), 0.0))
        # the error that no mesh removes
        stuck = factor * shear_kink(fine, scene) ** power
        estimate = SAFETY * (2**order / (2**order - 1)) * apart + stuck
        counts = [beam.divisions for beam in mesh.beams]
        total = sum(counts)
        said = [f"{element}, {total} elements: estimate {estimate:.1e} of {quantity}"]
        hopeless = estimate > accuracy and total < MOST and stuck > 0.9 * accuracy
        if hopeless:
            said.append(f"{element}: its strain measures leave {stuck:.1e}, whatever the elements")
        words = f"{element} elements, {' + '.join(map(str, counts))}, graded"
        yield Trial(mesh, options, words, estimate, said)
        if hopeless or total >= MOST:
            return
        growth = (estimate / (accuracy - stuck)) ** (1 / order) if np.isfinite(estimate) else 2.0
        wanted = min(MOST, math.ceil(total * min(max(growth, LEAST_GROWTH), MOST_GROWTH)))
        mesh = _graded(mesh, fine, wanted, order) if len(fine.load_parameter) else _halved(mesh)


def shear_kink(response: Response, scene: Scene) -> float:
    """Return the largest angle by which shear kinks an axis at a contact, ``F/GA`` [rad]."""
    kinks = (
        float(np.abs(response.contacts[contact.pair].force).max(initial=0.0)) / scene.beam(contact.beam).GA
        for contact in scene.contacts
    )
    return max(kinks, default=0.0)


def _with(scene: Scene, ends: Sequence[Array]) -> Scene:
    """Return the scene with the ends of the elements of each beam, over its length."""
    beams = (
        replace(beam, nodes=tuple(own[1:-1].tolist()), elements=len(own) - 1)
        for beam, own in zip(scene.beams, ends, strict=True)
    )
    return replace(scene, beams=tuple(beams))


def _halved(mesh: Scene) -> Scene:
    ends = (np.array([0.0, *beam.nodes, 1.0]) for beam in mesh.beams)
    return _with(mesh, [np.sort([*own, *(own[1:] + own[:-1]) / 2]) for own in ends])


def _graded(mesh: Scene, response: Response, wanted: int, order: int) -> Scene:
    """Return a mesh of about `wanted` elements whose density follows the response."""
    arcs, densities = list[Array](), list[Array]()
    for beam in mesh.beams:
        grids = [response.grid(beam.name, k).point_data for k in range(len(response.load_parameter))]
        arc, kappa, N, V = (np.array([data[name] for data in grids]) for name in ("arc", *"MNV"))
        arcs.append(np.append(arc[0, ::2], beam.length))
        kappa, N, V = (one.reshape(len(grids), -1, 2).mean(axis=2) / beam.EI for one in (kappa, N, V))
        densities.append(((kappa**4 + N**2 + V**2) ** (order / (4 * (order + 1)))).max(axis=0))
    least = LEAST * max(float(values.max()) for values in densities)
    lengths = (np.maximum(values, least) * np.diff(arc) for arc, values in zip(arcs, densities, strict=True))
    sums = [np.append(0.0, np.cumsum(own)) for own in lengths]
    whole, ends = sum(float(total[-1]) for total in sums), list[Array]()
    for arc, total in zip(arcs, sums, strict=True):
        count = max(1, round(wanted * float(total[-1]) / whole))
        inner = np.interp(np.arange(1, count) / count * total[-1], total, arc / arc[-1])
        ends.append(np.array([0.0, *inner, 1.0]))
    return _with(mesh, ends)


def solid(scene: Scene, accuracy: float, quantity: str) -> Iterator[Trial]:
    """Yield trials with solid meshes, each twice as fine; an error is the last change over ``2^p - 1``."""
    before: Response | None = None
    for mesh in MESHES:
        meshed, name = _strips(scene, mesh), f"solid, {mesh[0]}x{mesh[1]}"
        response = solve(replace(meshed, load_parameters=_few(scene)), SOLID.name, Options())
        estimate, said = math.inf, list[str]()
        if before is not None:
            apart = float(np.fmax(difference(before, response, scene, quantity), 0.0))
            estimate = SAFETY * apart / (2**ORDER - 1)
            said.append(f"{name}: estimate {estimate:.1e} of {quantity}")
        if estimate > accuracy and not response.completed:
            said.append(f"{name}: {response.status}")
        shown = " + ".join("x".join(map(str, beam.mesh)) for beam in meshed.beams)
        words = f"{scene.beams[0].solid_element} elements, {shown}"
        yield Trial(meshed, Options(), words, estimate, said)
        before = response


def _strips(scene: Scene, mesh: tuple[int, int]) -> Scene:
    """Return the scene with every strip meshed alike, stocky ones with fewer elements along."""
    beams = []
    for beam in scene.beams:
        part = min(1.0, beam.length / rectangle(beam)[1] / SLENDER)
        beams.append(replace(beam, mesh=(max(4, round(part * mesh[0])), mesh[1]), solid_mesh_file=None))
    return replace(scene, beams=tuple(beams))
