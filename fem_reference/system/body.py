"""A strip as a discrete solid: elements, material law and clamps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.contact.end_section import anchor
from fem_reference.solid.assembly import Pattern, element_entries, internal_force, pattern
from fem_reference.solid.mesh import Discretisation, structured_mesh
from fem_reference.statement.arrays import Floats
from fem_reference.statement.material import Law, elastic_law
from fem_reference.statement.strip import Strip


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """Constant data of a strip during a solution."""

    strip: Strip  # input data of the strip
    mesh: Discretisation  # discretisation of the strip
    law: Law  # material law
    part: slice  # range of the strip's nodes in the model's nodal arrays
    unknowns: slice  # range of its unknowns in the model's
    expansion: csr_matrix  # matrix ``(2 n, m)`` from the unknowns to the displacements, see `clamp`
    # sparsity pattern of the stiffness over the unknowns; with the springs of an anchor, which the border takes away
    stiffness: Pattern
    offset: Floats  # start ``(2,)`` from that of the first strip, so that a distant scene loses no digits [m]
    round_off: float  # round-off of a nodal force [N], see `force_round_off`

    def internal_force(self, F: Floats) -> Floats:
        """Internal nodal forces ``(n, 2)`` [N] from deformation gradients ``F`` ``(2, 2, e, q)``."""
        return internal_force(self.mesh, self.law.stress(F))

    def band(self, F: Floats) -> Floats:
        """Lower band of the tangent stiffness with the anchor."""
        return self.stiffness.band(element_entries(self.mesh, self.law.tangent(F)))

    def strain_energy(self, F: Floats) -> float:
        """Strain energy [J]."""
        return float((self.law.energy(F) * self.mesh.weights).sum())


def discretise(strip: Strip) -> Discretisation:
    """Return the mesh of a strip, structured or from the user's file."""
    if strip.mesh_file is None:
        return structured_mesh(strip)
    from fem_reference.solid.mesh_file import read_mesh

    return read_mesh(strip)


def build_body(strip: Strip, before: Sequence[Body] = ()) -> Body:
    """Discretise a strip and its clamps; its nodes and unknowns follow those of the bodies ``before``."""
    mesh = discretise(strip)
    expansion = clamp(strip, mesh)
    law = elastic_law(strip.material, strip.youngs_modulus, strip.poissons_ratio, strip.plane)
    first = before[0].strip if before else strip
    n, m = (before[-1].part.stop, before[-1].unknowns.stop) if before else (0, 0)
    return Body(
        strip=strip,
        mesh=mesh,
        law=law,
        part=slice(n, n + len(mesh.nodes)),
        unknowns=slice(m, m + expansion.shape[1]),
        expansion=expansion,
        stiffness=pattern(mesh, expansion, None if strip.clamped else anchor(strip, mesh, expansion)),
        offset=np.array(strip.start) - np.array(first.start),
        round_off=force_round_off(strip, mesh, law),
    )


def force_round_off(strip: Strip, mesh: Discretisation, law: Law) -> float:
    """Round-off of a nodal force [N]: ``4 eps M b L`` times the largest aspect ratio of an element.

    M is the modulus of uniaxial strain and eps the machine epsilon. The strain has the round-off ``eps L / short`` of an element's
    short side, its stress acts on the width b times the long side. The factor 4 is twice what is measured for L/h = 50 to 2000.
    """
    sides = np.ptp(mesh.places[mesh.cells[:, :4]], axis=1)
    aspect = float((sides.max(axis=1) / sides.min(axis=1)).max())
    width, modulus = (
        max(strip.width, strip.end_width or 0.0),
        float(law.tangent(np.eye(2)[:, :, None])[0, 0, 0, 0, 0]),
    )
    return 4 * float(np.finfo(float).eps) * modulus * width * strip.length * aspect


def clamp(strip: Strip, mesh: Discretisation) -> csr_matrix:
    """Matrix ``(2 n, m)`` from the unknowns, ordered along the strip, to the displacements that the clamps admit.

    The rod's clamp holds the displacement at the middle of the edge, interpolated from the nodes below and above, the latter maybe there.
    """
    n = len(mesh.nodes)
    factor = np.ones(2 * n)
    master = np.arange(2 * n)
    for end in strip.clamped:
        edge = mesh.edges[end]
        y = mesh.places[edge, 1] - mesh.places[edge[[0, -1]], 1].mean()
        across = strip.directions(0.0 if end == "start" else strip.length)[1]
        factor[2 * edge], factor[2 * edge + 1] = (0, 0) if strip.clamp == "full" else across
        master[2 * edge + 1] = 2 * edge
        if strip.clamp == "full":
            continue
        y[np.abs(y) < 1e-9 * strip.height] = 0
        k = int(np.searchsorted(y, 0.0))
        above = [2 * edge[k], 2 * edge[k] + 1]
        master[above] = 2 * edge[k - 1]
        factor[above] *= y[k] / y[k - 1]
    order = np.lexsort(np.round(mesh.places / strip.height, 9).T[::-1])
    along = (2 * order[:, None] + np.arange(2)).ravel()
    free = np.flatnonzero(factor)
    unknowns = along[np.isin(along, master[free])]
    column = np.empty(2 * n, dtype=int)
    column[unknowns] = np.arange(unknowns.size)
    return csr_matrix((factor[free], (free, column[master[free]])), shape=(2 * n, unknowns.size))
