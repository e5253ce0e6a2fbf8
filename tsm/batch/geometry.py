"""Where nodes lie relative to beams, in many structures: `tsm.contact` with the structure as last axis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.batch.equations import Equations, Points, coupling_of, properties_of
from tsm.batch.numbers import Numbers
from tsm.elements.curve import Curve
from tsm.elements.properties import Array, Properties
from tsm.model import BeamModel

_EXACT = 1e-14
"""Step at which a projection is found."""
_STEPS = 20


class Seen(NamedTuple):
    """Closest points of a beam's axis, each of shape (m,), see `tsm.contact.Projection`."""

    element: Array
    xi: Array
    gap: Array
    overshoot: Array


def slide(l0: Array, target: BeamModel, element: Array, xi: Array, which: Array) -> tuple[Array, Array]:
    """Hand positions that left their element over to the neighbours, by distances along the axis.

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
    """
    if ((xi >= 0) & (xi <= 1)).all():
        return element, xi
    element, xi = element.copy(), xi.copy()
    for _ in range(target.last - target.first):
        on, back = (xi > 1) & (element < target.last), (xi < 0) & (element > target.first)
        moving = np.flatnonzero(on | back)
        if not len(moving):
            break
        old, s = element[moving], which[moving]
        new = np.where(on[moving], old + 1, old - 1)
        start = np.where(on[moving], 1.0, 0.0)
        end = 1 - start
        xi[moving] = end + (xi[moving] - start) * (l0[old, s] / l0[new, s])
        element[moving] = new
    return element, xi


def measure(equations: Equations, numbers: Numbers, at: Points, which: Array) -> tuple[Array, Array]:
    """Contact forces and arc positions of all pairs in some structures, shapes (p, m); 0 and nan where a pair is open.

    Forces are positive where they push.
    """
    p, dofs = numbers.properties, equations.model.dofs
    normal, arc = np.zeros((2, len(at.closed), len(which)))
    arc[:] = np.nan
    for k, closed in enumerate(at.closed[:, which]):
        here = which[closed]
        e = at.element[k, here]
        shift = at.q[dofs[3:5, e], here] - at.q[dofs[:2, e], here]
        fx, fy = at.force[k][:, here]
        push = numbers.side[k, here] * (fy * (p.dx0[e, here] + shift[0]) - fx * (p.dy0[e, here] + shift[1]))
        size = np.sqrt(fx * fx + fy * fy)
        normal[k, closed] = np.where(push >= 0, size, -size)
        arc[k, closed] = numbers.arc[e, here] + at.xi[k, here] * p.l0[e, here]
    return normal, arc


def project(equations: Equations, numbers: Numbers, at: Points, k: int, which: Array) -> Seen:
    """Closest points of the deflected axis to pair k's node, with the dents of the contacts that are closed."""
    model = equations.model
    pair = model.pairs[k]
    node = equations.node(numbers, at, k, which)
    element, xi = _nearest_chord(numbers, at, pair.target, node, which)
    l0 = numbers.properties.l0
    for _ in range(_STEPS):
        p, x = properties_of(numbers, element, which), at.q[model.dofs[:, element], which]
        curve = Curve(p, x)
        start = numbers.coordinates[model.element_nodes[element, 0], :, which].T
        rx, ry = start + x[:2] - node
        (w, dw, ddw), dx, dy = curve.deflection(xi), curve.dx, curve.dy
        px, py = rx + xi * dx - w * dy, ry + xi * dy + w * dx
        tx, ty = dx - dw * dy, dy + dw * dx
        step = (px * tx + py * ty) / (tx * tx + ty * ty + ddw * (py * dx - px * dy))
        element, xi = slide(l0, pair.target, element, xi - step, which)
        if not (np.abs(step) >= _EXACT).any():
            break
    coupling = coupling_of(pair)
    for other in range(len(model.pairs)):
        there = at.closed[other, which] & (at.element[other, which] == element)
        if there.any():
            own = Properties(*(column[there] for column in properties_of(numbers, element, which)))
            xis = np.stack([xi[there], at.xi[other, which[there]]])
            dent = coupling.dent(own, xis.min(axis=0), xis.max(axis=0))
            fx, fy = at.force[other][:, which[there]]
            px[there] += dent * fx
            py[there] += dent * fy
    height = (py * tx - px * ty) / np.hypot(tx, ty)
    arc = numbers.arc[element, which] + xi * l0[element, which]
    beyond = np.maximum(np.maximum(arc - numbers.span[k, which], -arc), 0.0)
    beyond[(xi >= 0) & (xi <= 1)] = 0.0
    return Seen(element, xi, numbers.side[k, which] * height - numbers.offset[k, which], beyond)


def _nearest_chord(
    numbers: Numbers, at: Points, target: BeamModel, node: Array, which: Array
) -> tuple[Array, Array]:
    """Owner by projection on the chords."""
    nodes = target.nodes
    dofs = 3 * nodes[:, None] + np.arange(2)
    positions = numbers.coordinates[nodes][..., which] + at.q[dofs][..., which]
    d = np.diff(positions, axis=0)
    r = node - positions[:-1]
    xi = (d * r).sum(axis=1) / (d * d).sum(axis=1)
    miss = r - np.clip(xi, 0.0, 1.0)[:, None] * d
    owner = np.argmin((miss * miss).sum(axis=1), axis=0)
    return target.first + owner, xi[owner, np.arange(len(which))]
