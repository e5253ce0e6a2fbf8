"""What can be seen of a solution: lines, stresses, energies."""

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.assembly import deformation_gradient
from fem_reference.model import Model
from fem_reference.result import Result
from fem_reference.state import State


def section_means(model: Model, at: State) -> Floats:
    """Section-mean positions ``(m, 2)`` in the strip's frame [m]."""
    x = model.mesh.nodes + at.u
    return np.asarray(model.mesh.section_weights @ x[model.mesh.columns])


def axis_line(result: Result, k: int) -> Floats:
    """Deformed axis at the accepted load parameter ``k``: section means ``(m, 2)``, from start to end [m]."""
    model = result.model
    return np.asarray(model.problem.strip.to_global(section_means(model, result.states[k])))


def axis_stations(result: Result) -> Floats:
    """Undeformed axial coordinates ``(m,)`` of the points of `axis_line` [m]."""
    return result.model.mesh.stations


def nodal_stress(result: Result, k: int) -> Floats:
    """Cauchy stresses ``xx, yy, xy`` at the nodes, ``(n, 3)``, in the global frame [Pa].

    ``sigma = P F^T / det F``, evaluated at each element's nodes and averaged over the elements that meet there: force
    per current length in the plane and reference thickness.
    """
    model = result.model
    mesh, Q = model.mesh, model.problem.strip.frame
    F = deformation_gradient(mesh, result.states[k].u, mesh.nodal_gradients)
    P = model.law.stress(F)
    local = np.einsum("ik...,jk...->ij...", P, F) / (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0])
    sigma = np.einsum("ai,ij...,bj->ab...", Q, local, Q)
    components = np.stack([sigma[0, 0], sigma[1, 1], sigma[0, 1]], axis=-1)
    total = np.zeros((len(mesh.nodes), 3))
    np.add.at(total, mesh.cells, components)
    return total / np.bincount(mesh.cells.ravel())[:, None]


def energy(result: Result, k: int) -> tuple[float, float]:
    """Strain energy and contact energy ``lam^2 / (2 eps)`` at the accepted load parameter ``k`` [J]."""
    at, model = result.states[k], result.model
    spring = at.force**2 / (2 * model.problem.contact.penalty)
    return model.strain_energy(at.u), spring
