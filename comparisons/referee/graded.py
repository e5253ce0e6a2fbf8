"""Energy of the elements of rods that are curved, that taper or that carry a load along them, with its exact gradient and Hessian.

In the frame of the undeformed tangent, which has the angle beta(s) from the chord, the force is ``n = R(-beta) (c - W)``. An element from
the arc position ``s = a + l x`` on, x the fraction of the part, has the energy

    sum_g w [EI(s) theta_xi^2/2 half - half f],  f = n.(d - e) + N^2/2EA(s) + Q^2/2GA(s),  half = share l/2

whose derivatives in l and in the part's beginning a include those of EI, 1/EA, 1/GA and n by s.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import GAUSS, SLOPES, VALUES, WEIGHTS
from comparisons.referee.elements import Elements, Mesh, fields
from comparisons.referee.layout import Layout
from comparisons.referee.rods import Flexibility

Array = NDArray[np.float64]

OUTER = 6
"""Unknowns of an element outside its bubbles: two rotations, c, l and a."""


class Places(NamedTuple):
    """Rods at the Gauss points (e, g) of the elements.

    frame (e, g, 2, 2) : unit vectors along the undeformed axis and to its left in the frame of the chord, as columns.
    curvature (e, 1) : kappa0.
    force, slope, bend (e, g, 2) : n and its first and second derivatives by s.
    rod, first, second : EI, 1/EA, 1/GA and their derivatives by s.
    """

    frame: Array
    curvature: Array
    force: Array
    slope: Array
    bend: Array
    rod: Flexibility
    first: Flexibility
    second: Flexibility


class Coefficients(NamedTuple):
    """Polynomials in the arc position, ascending, by part, and what is constant along a part.

    stiffness (p, k, 3) : EI, EA and GA.
    load (p, k, 2) : W.
    curvature, turn (p,) : kappa0, and the angle by which the beam turns.
    """

    stiffness: Array
    load: Array
    curvature: Array
    turn: Array


def coefficients_of(layout: Layout) -> Coefficients:
    """Return the polynomials of all parts."""
    rods = [part.rod for part in layout.parts]
    return Coefficients(
        stiffness=_padded([_padded(rod.stiffness).T for rod in rods]),
        load=_padded([part.rod.load[part.piece] for part in layout.parts]),
        curvature=np.array([rod.curvature for rod in rods]),
        turn=np.array([rod.turn for rod in rods]),
    )


def _padded(tables: Sequence[Array]) -> Array:
    """Stack tables of coefficients of any degrees."""
    most = max(map(len, tables))
    return np.stack(
        [np.concatenate([item, np.zeros((most - len(item), *item.shape[1:]))]) for item in tables]
    )


def _evaluated(coefficients: Array, s: Array) -> tuple[Array, Array, Array]:
    """Value, first and second derivative (m, e, g) of polynomials with coefficients (e, k, m) at arc positions (e, g)."""
    rows = coefficients.transpose(1, 2, 0)[..., None]
    value = rows[-1] + np.zeros_like(s)
    first, second = np.zeros_like(value), np.zeros_like(value)
    for row in rows[-2::-1]:
        second = second * s + first
        first = first * s + value
        value = value * s + row
    return value, first, 2.0 * second


def places(given: Coefficients, parts: NDArray[np.int64], s: Array, c: Array) -> Places:
    """Evaluate the rods at arc positions (e, g) of elements of the parts `parts` (e,) with the constants c (e, 2)."""
    stiff, first, second = _evaluated(given.stiffness[parts], s)
    W, q, change = _evaluated(given.load[parts], s)
    k0 = given.curvature[parts][:, None]
    beta = k0 * s - given.turn[parts][:, None] / 2.0
    x, y = np.cos(beta), np.sin(beta)

    def turned(vector: Array) -> Array:
        return np.stack([x * vector[0] + y * vector[1], x * vector[1] - y * vector[0]], axis=-1)

    n, load = turned(c.T[:, :, None] - W), turned(q)
    slope = k0[..., None] * _across(n) - load
    flexible = 1.0 / stiff[1:]
    by_s = -first[1:] * flexible**2
    by_ss = (2.0 * first[1:] ** 2 * flexible - second[1:]) * flexible**2
    return Places(
        frame=np.stack([np.stack([x, -y], axis=-1), np.stack([y, x], axis=-1)], axis=-2),
        curvature=k0,
        force=n,
        slope=slope,
        bend=k0[..., None] * (_across(slope) - _across(load)) - turned(change),
        rod=Flexibility(stiff[0], *flexible),
        first=Flexibility(first[0], *by_s),
        second=Flexibility(second[0], *by_ss),
    )


def _across(vector: Array) -> Array:
    """Return vectors (..., 2) turned right by a right angle."""
    return np.stack([vector[..., 1], -vector[..., 0]], axis=-1)


class _Density(NamedTuple):
    """Derivatives of f at the Gauss points, with c and its derivatives in the frame of the chord."""

    f: Array
    turn: Array
    turn2: Array
    s: Array
    ss: Array
    turn_s: Array
    c: Array
    c_turn: Array
    c_s: Array
    cc: Array


def _density(theta: Array, there: Places) -> _Density:
    """Evaluate f at rotations (e, g)."""
    a, c = there.rod.stretch, there.rod.shear
    a1, c1 = there.first.stretch, there.first.shear
    n, n1, n2 = there.force, there.slope, there.bend
    cos, sin = np.cos(theta), np.sin(theta)
    d1, d2 = np.stack([cos, sin], axis=-1), np.stack([-sin, cos], axis=-1)
    N, Q, tangent = fields(theta, n, a, c)
    along, over = (n1 * d1).sum(axis=-1), (n1 * d2).sum(axis=-1)
    stretched = 1.0 + N * (a - c)
    turned = d2 * stretched[..., None] + d1 * (Q * (a - c))[..., None]
    steep = d1 * (a * along + a1 * N)[..., None] + d2 * (c * over + c1 * Q)[..., None]
    flexible = a[..., None, None] * d1[..., :, None] * d1[..., None, :]
    flexible = flexible + c[..., None, None] * d2[..., :, None] * d2[..., None, :]
    frame = there.frame
    return _Density(
        f=(n * tangent).sum(axis=-1) - a * N**2 / 2.0 - c * Q**2 / 2.0,
        turn=Q * stretched,
        turn2=Q**2 * (a - c) - N * stretched,
        s=(tangent * n1).sum(axis=-1) + a1 * N**2 / 2.0 + c1 * Q**2 / 2.0,
        ss=a * along**2 + c * over**2 + 2.0 * (a1 * N * along + c1 * Q * over) + (tangent * n2).sum(axis=-1)
        + there.second.stretch * N**2 / 2.0 + there.second.shear * Q**2 / 2.0,
        turn_s=(turned * n1).sum(axis=-1) + (a1 - c1) * N * Q,
        c=np.einsum("egij,egj->egi", frame, tangent),
        c_turn=np.einsum("egij,egj->egi", frame, turned),
        c_s=np.einsum("egij,egj->egi", frame, steep - there.curvature[..., None] * _across(tangent)),
        cc=frame @ flexible @ frame.swapaxes(-1, -2),
    )  # fmt: skip


def elements(layout: Layout, mesh: Mesh, z: Array, coefficients: Array, c: Array) -> Elements:
    """Evaluate the elements at the rotations (e, p + 1) and c (e, 2); unknowns `theta_a, theta_b, c_x, c_y, l, a` and the bubbles."""
    extent = np.array([layout.extent(z, part) for part in layout.parts])[mesh.part]
    begin = np.array([layout.arc(z, part.first, part) for part in layout.parts])[mesh.part]
    x = mesh.start[:, None] + mesh.share[:, None] * (1.0 + GAUSS) / 2.0
    there = places(coefficients_of(layout), mesh.part, begin[:, None] + extent[:, None] * x, c)
    half, grows = (mesh.share * extent / 2.0)[:, None], (mesh.share / 2.0)[:, None]
    f = _density(coefficients @ VALUES.T, there)
    w, bent = WEIGHTS, coefficients @ SLOPES.T
    size = coefficients.shape[1]
    turn = np.r_[0, 1, OUTER : size + 4]
    gradient, hessian = np.zeros((len(c), size + 4)), np.zeros((len(c), size + 4, size + 4))
    # of the bending energy e = EI theta_xi^2/2 half at the Gauss points
    e, e1, e2 = (item.EI * bent**2 / (2.0 * half) for item in (there.rod, there.first, there.second))
    moment, steep = there.rod.EI * bent / half, there.first.EI * bent / half
    by_s, by_half = e1 - half * f.s, -e / half - f.f
    both = -e1 / half - f.s
    gradient[:, turn] = (moment * w) @ SLOPES - (half * f.turn * w) @ VALUES
    gradient[:, 2:4] = -half * np.einsum("g,egi->ei", w, f.c)
    gradient[:, 4] = (by_half * grows + x * by_s) @ w
    gradient[:, 5] = by_s @ w
    inner = (SLOPES.T * (there.rod.EI / half * w)[:, None, :]) @ SLOPES
    hessian[:, turn[:, None], turn[None, :]] = inner - (VALUES.T * (half * f.turn2 * w)[:, None, :]) @ VALUES
    mixed = -half[:, :, None] * (VALUES.T @ (f.c_turn * w[:, None]))
    along = (steep * w) @ SLOPES - (half * f.turn_s * w) @ VALUES
    longer = (-moment / half * grows * w + x * steep * w) @ SLOPES - (
        (grows * f.turn + x * half * f.turn_s) * w
    ) @ VALUES
    c_s, c_x = (-half * np.einsum("eg,egi->ei", w * factor, f.c_s) for factor in (np.ones_like(x), x))
    c_l = c_x - grows * np.einsum("g,egi->ei", w, f.c)
    ss = e2 - half * f.ss
    for columns, block in (
        (slice(2, 4), mixed),
        (slice(4, 5), longer[:, :, None]),
        (slice(5, 6), along[:, :, None]),
    ):
        hessian[:, turn, columns] = block
        hessian[:, columns, turn] = block.transpose(0, 2, 1)
    for column, block in ((4, c_l), (5, c_s)):
        hessian[:, 2:4, column] = hessian[:, column, 2:4] = block
    hessian[:, 2:4, 2:4] = -half[:, :, None] * np.einsum("g,egij->eij", w, f.cc)
    hessian[:, 4, 4] = (2.0 * e / half**2 * grows**2 + 2.0 * x * both * grows + x**2 * ss) @ w
    hessian[:, 4, 5] = hessian[:, 5, 4] = (both * grows + x * ss) @ w
    hessian[:, 5, 5] = ss @ w
    N, Q, _ = fields(coefficients @ VALUES.T, there.force, there.rod.stretch, there.rod.shear)
    stored = (e + half * (there.rod.stretch * N**2 + there.rod.shear * Q**2) / 2.0) @ w
    return Elements(gradient, hessian, stored)
