"""The discrete model: solid, clamp, contact curve and pin path, in the strip's frame."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.assembly import Pattern, deformation_gradient, element_tangents, internal_force, pattern
from fem_reference.contact import Curve, Projection, contact_curve, gap_derivatives, project
from fem_reference.material import Law, elastic_law
from fem_reference.mesh import Discretisation, discretise
from fem_reference.problem import SolidProblem, Strip


@dataclass(frozen=True, kw_only=True, eq=False)
class Model:
    """Everything that stays constant during a solution.

    Parameters
    ----------
    problem
        What is modelled.
    mesh
        Its discretisation.
    law
        Material law.
    stiffness
        Pattern of the stiffness over the unclamped degrees of freedom, in order along the strip.
    curve
        The contact curve.
    clamped, free_end
        Indices of the clamped and the free end's section in ``mesh.columns``.
    """

    problem: SolidProblem
    mesh: Discretisation
    law: Law
    stiffness: Pattern
    curve: Curve
    clamped: int
    free_end: int

    @property
    def force_scale(self) -> float:
        """``E I / L^2`` [N]: a force that bends the strip, whatever the load."""
        return self.problem.strip.bending_stiffness / self.problem.strip.length**2

    @property
    def round_off(self) -> float:
        """Round-off of a nodal force [N]: 4 machine epsilons times E b L times the elements' aspect ratio.

        Displacements of order L are differenced over an element's short side; the stress E eps L / short acts on
        b times its long side. Up to twice that was measured on strips from L/h = 50 to 2000.
        """
        strip = self.problem.strip
        sides = strip.length / strip.mesh[0], strip.height / strip.mesh[1]
        aspect = max(sides) / min(sides)
        return 4 * float(np.finfo(float).eps) * strip.youngs_modulus * strip.width * strip.length * aspect

    @property
    def length_round_off(self) -> float:
        """Round-off of a position [m]."""
        return 8 * float(np.finfo(float).eps) * self.problem.strip.length

    @property
    def clamped_point(self) -> Floats:
        """Middle of the clamped edge, ``(2,)`` [m]."""
        edge = self.mesh.columns[self.clamped]
        middle: Floats = self.mesh.nodes[edge[edge.size // 2]]
        return middle

    def pin_position(self, t: float) -> Floats:
        """Pin position ``(2,)`` in the strip's frame."""
        return self.problem.strip.to_local(self.problem.pin.position(t))

    def project(self, u: Array, pin: Floats) -> Projection:
        """Project the pin on the contact curve deformed by ``u`` ``(n, 2)``."""
        return project(self.curve, self.mesh.nodes + u, pin, self.problem.contact.sign)

    def internal_force(self, u: Array) -> Array:
        """Internal forces of the solid, ``(n, 2)``."""
        F = deformation_gradient(self.mesh, u)
        return internal_force(self.mesh, self.law.stress(F))

    def solid_stiffness(self, u: Array) -> csc_matrix:
        """Tangent stiffness of the solid over the unclamped degrees of freedom."""
        F = deformation_gradient(self.mesh, u)
        return self.stiffness.matrix(element_tangents(self.mesh, self.law.tangent(F)))

    def gap_derivatives(self, at: Projection) -> tuple[Array, Array]:
        """Factors of the gap's derivatives, see `fem_reference.contact.gap_derivatives`."""
        return gap_derivatives(self.curve, at, len(self.mesh.nodes), self.problem.contact.sign)

    def strain_energy(self, u: Array) -> float:
        """Strain energy of the solid [J]."""
        W = self.law.energy(deformation_gradient(self.mesh, u))
        return float((W * self.mesh.weights).sum())


def build(problem: SolidProblem) -> Model:
    """Discretise a problem."""
    strip = problem.strip
    mesh = discretise(strip)
    clamped, free_end = (0, -1) if strip.clamped == ("start",) else (-1, 0)
    held = clamped_dofs(strip, mesh.columns[clamped])
    along = (2 * mesh.columns.ravel()[:, None] + np.arange(2)).ravel()
    return Model(
        problem=problem,
        mesh=mesh,
        law=elastic_law(strip.material, strip.youngs_modulus, strip.poissons_ratio, strip.plane),
        stiffness=pattern(mesh, along[~np.isin(along, held)]),
        curve=contact_curve(mesh, problem.contact),
        clamped=clamped,
        free_end=free_end,
    )


def clamped_dofs(strip: Strip, edge: Ints) -> Ints:
    """Degrees of freedom that the clamp holds on the nodes ``edge`` of the clamped section."""
    if strip.clamp == "full":
        return (2 * edge[:, None] + np.arange(2)).ravel()
    return np.append(2 * edge, 2 * edge[edge.size // 2] + 1)
