"""What can be seen of a solution: lines, stresses, energies."""

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.assembly import deformation_gradient
from fem_reference.body import Body
from fem_reference.model import Model
from fem_reference.result import Result
from fem_reference.state import State


def section_means(model: Model, at: State, strip: str) -> Floats:
    """Section-mean positions ``(m, 2)`` of a strip in the global frame [m]."""
    body, part = model.body(strip)
    means: Floats = body.mesh.sections @ (body.mesh.nodes + at.u[part])
    return body.strip.to_global(means)


def axis_line(result: Result, strip: str, k: int) -> Floats:
    """Deformed axis at the accepted load parameter ``k``: section means ``(m, 2)``, from start to end [m]."""
    return section_means(result.model, result.states[k], strip)


def axis_stations(result: Result, strip: str) -> Floats:
    """Undeformed axial coordinates ``(m,)`` of the points of `axis_line` [m]."""
    return result.model.body(strip)[0].mesh.stations


def nodal_stress(result: Result, k: int) -> Floats:
    """Cauchy stresses ``xx, yy, xy`` at the nodes, ``(n, 3)``, in the global frame [Pa].

    ``sigma = P F^T / det F``, evaluated at each element's nodes and averaged over the elements that meet there: force
    per current length in the plane and reference thickness.
    """
    u = result.states[k].u
    return np.concatenate([_nodal_stress(body, u[part]) for body, part in result.model.each()])


def _nodal_stress(body: Body, u: Floats) -> Floats:
    mesh, Q = body.mesh, body.strip.frame
    F = deformation_gradient(mesh, u, mesh.nodal_gradients)
    P = body.law.stress(F)
    local = np.einsum("ik...,jk...->ij...", P, F) / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])
    sigma = np.einsum("ai,ij...,bj->ab...", Q, local, Q)
    components = np.stack([sigma[0, 0], sigma[1, 1], sigma[0, 1]], axis=-1)
    total = np.zeros((len(mesh.nodes), 3))
    np.add.at(total, mesh.cells, components)
    return total / np.bincount(mesh.cells.ravel())[:, None]


def energy(result: Result, k: int) -> tuple[float, float]:
    """Strain energy and contact energy, ``eps g^2 / 2`` of every penalty, at the accepted load parameter ``k`` [J]."""
    at = result.states[k]
    springs = sum(touch.pair.penalty * touch.gap**2 / 2 for touch in at.closed)
    return result.model.strain_energy(at.u), springs
