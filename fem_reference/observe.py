"""Post-processing of a solution: axis lines, stresses and energies."""

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.assembly import deformation_gradient
from fem_reference.body import Body
from fem_reference.model import Model
from fem_reference.result import Result
from fem_reference.state import State, contact_energy


def section_means(model: Model, state: State, strip: str) -> Floats:
    """Section-mean positions ``(m, 2)`` of a strip in the global frame [m]."""
    body, part = model.body(strip)
    means: Floats = body.mesh.sections @ (body.mesh.nodes + state.u[part])
    return body.strip.to_global(means)


def axis_line(result: Result, strip: str, k: int) -> Floats:
    """Section means ``(m, 2)`` from start to end at the accepted load parameter ``k``, in the global frame [m]."""
    model, state = result.model, result.states[k]
    arcs, numbers = _bent_sections(model, strip)
    origin = np.array(model.problem.strips[0].start)
    means = [origin + model.sections[i].position + state.poses[i].displacement for i in numbers]
    before = np.searchsorted(model.body(strip)[0].mesh.stations, arcs)
    return np.insert(section_means(model, state, strip), before, np.reshape(means, (-1, 2)), axis=0)


def axis_stations(result: Result, strip: str) -> Floats:
    """Undeformed axial coordinates ``(m,)`` of the points in `axis_line` [m]: the mesh's sections, and those inside that bear a moment."""
    stations = result.model.body(strip)[0].mesh.stations
    arcs, _ = _bent_sections(result.model, strip)
    return np.insert(stations, np.searchsorted(stations, arcs), arcs)


def _bent_sections(model: Model, strip: str) -> tuple[Floats, list[int]]:
    """Axial coordinates, increasing, and numbers of the sections inside a strip that bear a moment between two sections of its mesh."""
    body, _ = model.body(strip)
    places = {load.node: load.at for load in model.problem.inner_moments if load.strip == strip}
    found = sorted(
        (places[section.node] * body.strip.length, number)
        for number, section in enumerate(model.sections)
        if section.node in places
    )
    apart = 1e-9 * body.strip.length
    between = [item for item in found if np.abs(body.mesh.stations - item[0]).min() > apart]
    return np.array([arc for arc, _ in between]), [number for _, number in between]


def nodal_stress(result: Result, k: int) -> Floats:
    """Cauchy stresses ``xx, yy, xy`` at the nodes, ``(n, 3)``, in the global frame [Pa].

    ``sigma = P F^T / det F`` is the force per current length in the plane and per reference thickness. It is evaluated at
    the nodes of every element and averaged over the elements with a common node.
    """
    u = result.states[k].u
    return np.concatenate([_nodal_stress(body, u[part]) for body, part in result.model.bodies_and_nodes()])


def _nodal_stress(body: Body, u: Floats) -> Floats:
    _, local = _cauchy_stress(body, u)
    Q = body.strip.frame
    sigma = np.einsum("ai,ij...,bj->ab...", Q, local, Q)
    return _averaged(body, np.stack([sigma[0, 0], sigma[1, 1], sigma[0, 1]], axis=-1))


def fibre_stress(result: Result, k: int) -> Floats:
    """Cauchy stress ``t . sigma t`` ``(n,)`` at the nodes, with the unit vector t along the deformed fibre along the axis [Pa]."""
    u = result.states[k].u
    return np.concatenate(
        [_fibre_stress(body, u[part])[:, 0] for body, part in result.model.bodies_and_nodes()]
    )


def _fibre_stress(body: Body, u: Floats) -> Floats:
    F, sigma = _cauchy_stress(body, u)
    T, _ = body.strip.directions(body.mesh.places[body.mesh.cells, 0])
    along = F[:, 0] * T[0] + F[:, 1] * T[1]
    stress = np.einsum("i...,ij...,j...->...", along, sigma, along) / np.einsum(
        "i...,i...->...", along, along
    )
    return _averaged(body, stress[..., None])


def _cauchy_stress(body: Body, u: Floats) -> tuple[Floats, Floats]:
    """Deformation gradient and Cauchy stress at the nodes of every element, in the strip's frame."""
    F = deformation_gradient(body.mesh, u, body.mesh.at_nodes)
    sigma = np.einsum("ik...,jk...->ij...", body.law.stress(F), F) / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])
    return F, sigma


def _averaged(body: Body, values: Floats) -> Floats:
    """Mean over the elements with a common node."""
    mesh = body.mesh
    total = np.zeros((len(mesh.nodes), values.shape[-1]))
    np.add.at(total, mesh.cells, values)
    return total / np.bincount(mesh.cells.ravel())[:, None]


def energy(result: Result, k: int) -> tuple[float, float]:
    """Strain energy and contact energy ``eps g^2 / 2`` at the accepted load parameter ``k`` [J]."""
    state = result.states[k]
    return result.model.strain_energy(state.u), contact_energy(state)
