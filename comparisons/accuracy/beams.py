"""TSM beams to a stated accuracy: exact elements by their own error estimate, closed-form elements on meshes graded for the scene."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.accuracy.answer import Discretised
from comparisons.accuracy.pilot import SAFETY, pilot
from comparisons.errors import difference
from comparisons.models import TSM, solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.scene import BeamSpec, Scene
from tsm.elements import ClosedForm

NEWTON = 1e-10
"""Tolerance of Newton's method, in forces over ``EI/L^2`` (`tsm.Settings`)."""
SHARPEST = 1e-14
FIRST = 4
"""Elements of a beam in the first mesh."""
MOST = 4000
ROUNDS = 10
LEAST_GROWTH, MOST_GROWTH = 1.1, 4.0
"""Least and largest ratio of the numbers of elements of two successive meshes."""
LEAST = 0.05
"""Least density of elements over the largest density; a part of a beam without load keeps some elements."""


def exact_to(scene: Scene, accuracy: float, quantity: str) -> Discretised:
    """Solve with one exact element a beam, to the accuracy that its error estimate needs.

    The estimate is the integration error inside the elements plus Newton's tolerance, both divided by the size of the quantity.
    A small load therefore needs a more accurate integration for the same relative error.
    """
    tolerance, said = 1e-9, []
    while True:
        response = solve(scene, TSM.name, replace(TSM.reference, integration_tolerance=tolerance))
        size = _size(response, scene, quantity)
        estimate = (response.integration_error + NEWTON) / size if size else np.inf
        said.append(
            f"exact, one element a beam: integration error {response.integration_error:.1e}, "
            f"estimate {estimate:.1e} of {quantity}"
        )
        sharper = max(SHARPEST * 1.01, accuracy * size / 4)
        if estimate <= accuracy or not response.completed or sharper >= tolerance:
            break
        tolerance = sharper
    return Discretised(
        response=response,
        scene=scene,
        resolution=f"exact elements, one a beam, {response.unknowns} unknowns",
        estimate=float(estimate) if response.completed else np.inf,
        decisions=tuple(said),
    )


def _size(response: Response, scene: Scene, quantity: str) -> float:
    """Return the size of a quantity in the units of the error estimate: EI/L^2, EI/L, 1."""
    longest = max(beam.length for beam in scene.beams)
    stiffest = max(beam.EI / beam.length**2 for beam in scene.beams)
    forces = [contact.force for contact in response.contacts.values()]
    forces += [] if forces else [support.force for support in response.supports.values()]
    moments = [support.moment for support in response.supports.values()]
    if quantity == "force":
        return min(1.0, _largest(forces) / stiffest)
    if quantity == "moment":
        return min(1.0, _largest(moments) / (stiffest * longest))
    return 1.0


def _largest(histories: list[Array]) -> float:
    return max((float(np.abs(values).max(initial=0.0)) for values in histories), default=0.0)


def graded_to(scene: Scene, accuracy: float, quantity: str, kind: ClosedForm) -> Discretised:
    """Solve with elements in closed form, refined where the solution is curved and where forces act.

    The answers on a mesh and on the mesh with all elements halved are compared at a few load parameters. Their difference gives the
    error of the first mesh. If the error is too large, the next mesh has the number of elements that the order p predicts. Its density
    is the largest of ``(kappa^4 + (N/EI)^2 + (V/EI)^2)^(p/(4 (p + 1)))`` over the load parameters, which gives all elements an equal
    share of the error.
    """
    order, element = kind.order, kind.name
    short, said = pilot(scene), []
    mesh = _with(scene, {beam.name: _equal(FIRST) for beam in scene.beams})
    for _ in range(ROUNDS):
        coarse, fine = (_solve(short, one, element) for one in (mesh, _halved(mesh)))
        apart = float(np.fmax(difference(coarse, fine, scene, quantity), 0.0))
        stuck = _shear_limit(fine, scene, kind.shear_floor)
        estimate = SAFETY * (2**order / (2**order - 1)) * apart + stuck
        total = _count(mesh)
        said.append(f"{element}, {total} elements: estimate {estimate:.1e} of {quantity}")
        if estimate <= accuracy or total >= MOST:
            break
        if stuck > 0.9 * accuracy:
            said.append(f"{element}: its strain measures leave {stuck:.1e}, whatever the elements")
            break
        growth = (estimate / (accuracy - stuck)) ** (1 / order) if np.isfinite(estimate) else 2.0
        wanted = min(MOST, math.ceil(total * min(max(growth, LEAST_GROWTH), MOST_GROWTH)))
        mesh = _graded(mesh, fine, wanted, order) if len(fine.load_parameter) else _halved(mesh)
    response = _solve(scene, mesh, element)
    counts = " + ".join(str(len(beam.nodes) + 1) for beam in mesh.beams)
    return Discretised(
        response=response,
        scene=mesh,
        resolution=f"{element} elements, {counts}, graded, {response.unknowns} unknowns",
        estimate=float(estimate),
        decisions=tuple(said),
    )


def _solve(scene: Scene, mesh: Scene, element: str) -> Response:
    return solve(replace(mesh, load_parameters=scene.load_parameters), TSM.name, Options(element=element))


def _shear_limit(response: Response, scene: Scene, floor: tuple[float, int]) -> float:
    """Return the error that no mesh removes: the element's factor times a power of the largest shear strain under a contact."""
    factor, power = floor
    strains = [
        float(np.abs(response.contacts[contact.pair].force).max(initial=0.0)) / scene.beam(contact.beam).GA
        for contact in scene.contacts
    ]
    return float(factor * max(strains, default=0.0) ** power)


def _equal(count: int) -> tuple[float, ...]:
    return tuple(k / count for k in range(1, count))


def _with(scene: Scene, nodes: dict[str, tuple[float, ...]]) -> Scene:
    beams = (_divided(beam, nodes[beam.name]) for beam in scene.beams)
    return replace(scene, beams=tuple(beams))


def _divided(beam: BeamSpec, nodes: tuple[float, ...]) -> BeamSpec:
    return replace(beam, nodes=nodes, elements=len(nodes) + 1)


def _halved(mesh: Scene) -> Scene:
    found = {}
    for beam in mesh.beams:
        ends = np.array([0.0, *beam.nodes, 1.0])
        both = np.sort(np.concatenate([ends, (ends[1:] + ends[:-1]) / 2]))
        found[beam.name] = tuple(both[1:-1].tolist())
    return _with(mesh, found)


def _count(mesh: Scene) -> int:
    return sum(len(beam.nodes) + 1 for beam in mesh.beams)


def _graded(mesh: Scene, response: Response, wanted: int, order: int) -> Scene:
    """Return a mesh of about `wanted` elements whose density follows the response."""
    grids = [response.grid(k).point_data for k in range(len(response.load_parameter))]
    arcs, densities = {}, {}
    for number, beam in enumerate(mesh.beams):
        own = [
            {name: data[name][data["beam"] == number] for name in ("arc", "N", "V", "M")} for data in grids
        ]
        arcs[beam.name] = np.append(own[0]["arc"][::2], beam.length)
        densities[beam.name] = np.max([_density(data, beam.EI, order) for data in own], axis=0)
    least = LEAST * max(float(values.max()) for values in densities.values())
    sums = {
        name: np.append(0.0, np.cumsum(np.maximum(values, least) * np.diff(arcs[name])))
        for name, values in densities.items()
    }
    whole = sum(float(total[-1]) for total in sums.values())
    nodes = {}
    for beam in mesh.beams:
        total = sums[beam.name]
        count = max(1, round(wanted * float(total[-1]) / whole))
        inner = np.interp(np.arange(1, count) / count * total[-1], total, arcs[beam.name] / beam.length)
        nodes[beam.name] = tuple(inner.tolist())
    return _with(mesh, nodes)


def _density(data: dict[str, Any], EI: float, order: int) -> Array:
    """Return the density of elements for a state, up to a constant factor."""
    kappa, N, V = (data[name].reshape(-1, 2).mean(axis=1) / EI for name in ("M", "N", "V"))
    density: Array = (kappa**4 + N**2 + V**2) ** (order / (4 * (order + 1)))
    return density
