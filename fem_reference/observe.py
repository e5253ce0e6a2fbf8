"""Post-processing of a solution: axis lines, stresses and energies."""

import numpy as np

from fem_reference.arrays import Floats, Ints
from fem_reference.assembly import deformation_gradient
from fem_reference.body import Body
from fem_reference.result import Result
from fem_reference.state import State, stored_energy


def section_means(state: State, strip: str) -> Floats:
    """Section-mean positions ``(m, 2)`` of a strip in the global frame [m]."""
    body = state.model.body(strip)
    return body.strip.to_global(body.mesh.sections @ (body.mesh.nodes + state.u[body.part]))


def axis_line(result: Result, strip: str, k: int) -> Floats:
    """Section means ``(m, 2)`` from start to end at the accepted load parameter ``k``, in the global frame [m]."""
    state = result.states[k]
    before, bent = _bent_sections(result, strip)
    origin = np.array(result.model.problem.strips[0].start)
    means = np.reshape([origin + state.poses[number].position for _, number in bent], (-1, 2))
    return np.insert(section_means(state, strip), before, means, axis=0)


def axis_stations(result: Result, strip: str) -> Floats:
    """Undeformed axial coordinates ``(m,)`` of the points in `axis_line` [m]: the mesh's sections, and those inside that bear a moment."""
    before, bent = _bent_sections(result, strip)
    return np.insert(result.model.body(strip).mesh.stations, before, [arc for arc, _ in bent])


def _bent_sections(result: Result, strip: str) -> tuple[Ints, list[tuple[float, int]]]:
    """Places among the mesh's sections, coordinates and numbers of the sections that bear a moment between two of them."""
    body = result.model.body(strip)
    stations, apart = body.mesh.stations, 1e-9 * body.strip.length
    bent = sorted(
        (section.arc, number)
        for number, section in enumerate(result.model.sections)
        if section.strip == strip and np.abs(stations - section.arc).min() > apart
    )
    return np.searchsorted(stations, [arc for arc, _ in bent]), bent


def nodal_stress(result: Result, k: int) -> Floats:
    """Cauchy stresses ``xx, yy, xy`` at the nodes, ``(n, 3)``, in the global frame [Pa].

    ``sigma = P F^T / det F`` is the force per current length in the plane and per reference thickness. It is evaluated at
    the nodes of every element and averaged over the elements with a common node.
    """
    found = []
    for body in result.model.bodies:
        _, local = _cauchy_stress(body, result.states[k].u[body.part])
        sigma = np.einsum("ai,ijek,bj->abek", body.strip.frame, local, body.strip.frame)
        found.append(_averaged(body, np.stack([sigma[0, 0], sigma[1, 1], sigma[0, 1]], axis=-1)))
    return np.concatenate(found)


def fibre_stress(result: Result, k: int) -> Floats:
    """Cauchy stress ``t . sigma t`` ``(n,)`` at the nodes, with the unit vector t along the deformed fibre along the axis [Pa]."""
    found = []
    for body in result.model.bodies:
        F, sigma = _cauchy_stress(body, result.states[k].u[body.part])
        T, _ = body.strip.directions(body.mesh.places[body.mesh.cells, 0])
        along = np.einsum("ijek,jek->iek", F, T)
        stress = np.einsum("iek,ijek,jek->ek", along, sigma, along) / (along**2).sum(axis=0)
        found.append(_averaged(body, stress[..., None])[:, 0])
    return np.concatenate(found)


def _cauchy_stress(body: Body, u: Floats) -> tuple[Floats, Floats]:
    """Deformation gradient and Cauchy stress at the nodes of every element, in the strip's frame."""
    F = deformation_gradient(body.mesh, u, body.mesh.at_nodes)
    sigma = np.einsum("ikeq,jkeq->ijeq", body.law.stress(F), F) / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])
    return F, sigma


def _averaged(body: Body, values: Floats) -> Floats:
    """Mean over the elements with a common node."""
    cells = body.mesh.cells.ravel()
    return np.asarray((body.mesh.gather @ values.reshape(cells.size, -1)) / np.bincount(cells)[:, None])


def energy(result: Result, k: int) -> tuple[float, float]:
    """Strain energy and contact energy ``eps g^2 / 2`` at the accepted load parameter ``k`` [J]."""
    return stored_energy(result.states[k])
