"""Where nodes lie relative to beams, in many structures: `tsm.contact` with the structure as last axis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm import projection
from tsm.batch.constants import BatchConstants
from tsm.batch.equations import Configurations, Equations, coupling_of, properties_of
from tsm.elements.curve import Curve
from tsm.elements.properties import Array, Properties
from tsm.pairs import BeamModel


class Projections(NamedTuple):
    """Closest points of a beam's axis, each of shape (m,), see `tsm.projection.Projection`."""

    element: Array
    xi: Array
    gap: Array
    overshoot: Array


def slide(
    l0: Array, target: BeamModel, element: Array, xi: Array, which: Array, past: float = 0.0
) -> tuple[Array, Array]:
    """Hand positions that left their element over to the neighbours, see `tsm.projection.slide`.

    Parameters
    ----------
    l0 : ndarray, shape (e, N)
        Lengths of the elements.
    target : BeamModel
        The touched beam.
    element, xi : ndarray, shape (m,)
        Owners and positions.
    which : ndarray of int, shape (m,)
        Structures.
    past : float
        Part of the length by which a position may lie past a node.
    """
    outside = np.flatnonzero((xi < -past) | (xi > 1 + past))
    if not len(outside):
        return element, xi
    element, xi, elements = element.copy(), xi.copy(), slice(target.first, target.last + 1)
    for n, lengths in zip(outside.tolist(), l0[elements, which[outside]].T.tolist(), strict=True):
        k, xi[n] = projection.slide(lengths, int(element[n]) - target.first, float(xi[n]), past)
        element[n] = target.first + k
    return element, xi


def measure(
    equations: Equations, constants: BatchConstants, iterate: Configurations, which: Array
) -> tuple[Array, Array]:
    """Contact forces and arc positions of all pairs in some structures, shapes (p, m); 0 and nan where a pair is open.

    Forces are positive where they push.
    """
    p, dofs = constants.properties, equations.model.dofs
    normal, arc = np.zeros((2, len(iterate.closed), len(which)))
    arc[:] = np.nan
    for k, closed in enumerate(iterate.closed[:, which]):
        here = which[closed]
        e = iterate.element[k, here]
        shift = iterate.q[dofs[3:5, e], here] - iterate.q[dofs[:2, e], here]
        fx, fy = iterate.force[k][:, here]
        push = constants.side[k, here] * (fy * (p.dx0[e, here] + shift[0]) - fx * (p.dy0[e, here] + shift[1]))
        size = np.sqrt(fx * fx + fy * fy)
        normal[k, closed] = np.where(push >= 0, size, -size)
        arc[k, closed] = constants.arc[e, here] + iterate.xi[k, here] * p.l0[e, here]
    return normal, arc


def project(
    equations: Equations, constants: BatchConstants, iterate: Configurations, k: int, which: Array
) -> Projections:
    """Closest points of the deflected axis to pair k's node, with the dents of the contacts that are closed."""
    model = equations.model
    pair = model.pairs[k]
    node = equations.node(constants, iterate, k, which)
    nodes = pair.target.nodes
    shift = iterate.q[3 * nodes[:, None] + np.arange(2)][..., which]
    owner, xis = projection.project_on_chords(constants.coordinates[nodes][..., which] + shift, node)
    element, xi = pair.target.first + owner, xis[owner, np.arange(len(which))]
    l0 = constants.properties.l0
    for _ in range(projection.PROJECTIONS):
        p, x = properties_of(constants, element, which), iterate.q[model.dofs[:, element], which]
        curve = Curve(p, x)
        start = constants.coordinates[model.element_nodes[element, 0], :, which].T
        step, (px, py), (tx, ty) = curve.approach(xi, *(start + x[:2] - node))
        element, xi = slide(l0, pair.target, element, xi - step, which)
        if not (np.abs(step) >= projection.PROJECTED).any():
            break
    coupling = coupling_of(pair)
    for other in range(len(model.pairs)):
        there = iterate.closed[other, which] & (iterate.element[other, which] == element)
        if there.any():
            constants_there = Properties(
                *(column[there] for column in properties_of(constants, element, which))
            )
            xis = np.stack([xi[there], iterate.xi[other, which[there]]])
            dent = coupling.dent(constants_there, xis.min(axis=0), xis.max(axis=0))
            fx, fy = iterate.force[other][:, which[there]]
            px[there] += dent * fx
            py[there] += dent * fy
    height = (py * tx - px * ty) / np.hypot(tx, ty)
    arc = constants.arc[element, which] + xi * l0[element, which]
    beyond = np.maximum(np.maximum(arc - constants.span[k, which], -arc), 0.0)
    beyond[(xi >= 0) & (xi <= 1)] = 0.0
    return Projections(element, xi, constants.side[k, which] * height - constants.offset[k, which], beyond)
