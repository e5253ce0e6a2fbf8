"""Integrators of the exact element on the KS cantilever with one element: error, cost, iterations, in one table.

Gauss collocation (`tsm.elements.rod`) against shooting with DOP853 (Hairer, Norsett and Wanner 1993: 12 stages, order 8). Both in their
best form: the tangent is the exact derivative of the discrete solution, all segments are computed at once, and what can be is
batched over stages and sub-steps. `phi'` is linear in m, so the stages of m drop out (``A @ A``), and two stages at a time become independent.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from scipy.integrate import DOP853

import tsm
from comparisons.exact.rod import rod_under_pin
from comparisons.models.translate import to_rod, to_structure
from comparisons.scene import load_scene
from tsm import path
from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.groups import exact
from tsm.rods import assembly, profile, shape
from tsm.rods.assembly import Rods
from tsm.rods.layout import layout
from tsm.state import Cuts, Profile, State, Touch
from tsm.system import Assembler

STAGES = 12
A, B, C = DOP853.A, DOP853.B, DOP853.C
AA, BA = A @ A, B @ A
SHAPE_ORDER = 16
EXPLICIT, GAUSS = (2, 3, 4, 6, 8), (6, 8, 10, 12, 14, 16)


class Course(NamedTuple):
    """What one integration leaves: sub-steps n, segments s.

    Attributes
    ----------
    sums : ndarray, shape (3, s, 1)
        Integrals of f and r' over the unit interval.
    end : ndarray, shape (s, 1)
        Angle on arrival.
    moment : ndarray, shape (n, s, 1)
        At the start of every sub-step.
    values : ndarray, shape (3, n, s, 12)
        f and r' at the stages.
    c, s, N, q, turn, gq : ndarray, shape (n, s, 12)
        As in `rod.Field`.
    """

    sums: Array
    end: Array
    moment: Array
    values: Array
    c: Array
    s: Array
    N: Array
    q: Array
    turn: Array
    gq: Array


class Explicit:
    """Stands in for `tsm.elements.rod`; the inner unknowns are the angle and moment (s, 2) that a segment starts with.

    Kept in the profile, they let all segments of a chain be integrated at once; a full iteration makes them those of the chain.
    """

    tangent = staticmethod(rod.tangent)

    def __init__(self, steps: int) -> None:
        self.steps = steps

    def field(self, at: rod.Segments) -> Course:
        """Integrate from the starts in the profile."""
        (nx, ny), (stretch, shear, bend) = at.force[..., 0], (value[:, 0] for value in at.flexibility)
        g, h = stretch - shear, at.length[:, 0] / self.steps
        by_bend = h * bend
        square = by_bend * h
        angle, moment = at.angle.T
        phi = np.empty((self.steps, STAGES, len(h)), dtype=np.result_type(angle, nx, h))
        f, moments = np.empty_like(phi), np.empty_like(phi[:, 0])
        for k in range(self.steps):
            moments[k] = moment
            rise = by_bend * moment
            here, known = phi[k], f[k]
            here[:] = angle + C[:, None] * rise
            for i in range(0, STAGES, 2):
                pair = slice(i, i + 2)
                here[pair] += square * (AA[pair, :i] @ known[:i])
                c, s = np.cos(here[pair]), np.sin(here[pair])
                known[pair] = (nx * s - ny * c) * (1 + g * (nx * c + ny * s))
            angle = angle + rise + square * (BA @ known)
            moment = moment + h * (B @ known)
        return self._course(at, angle, moments, phi.transpose(0, 2, 1))

    def _course(self, at: rod.Segments, end: Array, moments: Array, phi: Array) -> Course:
        c, s = np.cos(phi), np.sin(phi)
        nx, ny = at.force
        stretch, shear, _ = at.flexibility
        g = stretch - shear
        N, q = nx * c + ny * s, nx * s - ny * c
        turn, gq = 1 + g * N, g * q
        values = np.stack([q * turn, c + stretch * nx - gq * s, s + stretch * ny + gq * c])
        sums = (values @ B).sum(axis=1) / self.steps
        return Course(sums[:, :, None], end[:, None], moments[:, :, None], values, c, s, N, q, turn, gq)

    def arrival(self, at: rod.Segments, of: Course, start: Array, moment: Array, end: Array) -> rod.Arrival:
        """Residuals as of `rod.arrival`; instead of `bent`, how far the profile's starts are from those given."""
        gap = at.angle - np.concatenate([start, moment], axis=1)
        inside = np.concatenate([gap[:, :1], gap[:, 1:] * (at.length * at.flexibility.bend)], axis=1)
        return rod.Arrival((of.end - end)[:, 0], inside, gap)

    def condense(self, at: rod.Segments, of: Course, found: rod.Arrival, _: Array) -> rod.Condensed:
        """Exact derivative of the integration, sub-steps chained."""
        steps, gap = self._steps(at, of), found.bent
        count = len(gap)
        chain = np.zeros((count, 5, 5), dtype=steps.dtype)
        chain[:] = np.eye(5)
        moved = np.zeros_like(chain[:, :2])
        for step in steps:
            out = step @ chain
            chain[:, :2] = out[:, :2]
            moved += out[:, 2:]
        by = np.concatenate([chain[:, :2], moved], axis=1)
        transfer = np.zeros((count, 4, rod.INPUTS), dtype=by.dtype)
        transfer[:, :, [0, 1, 3, 4]] = by[:, :, :4]
        transfer[:, :, 5] = by[:, :, 4] / self.steps
        transfer[:, 0, 2] = -1
        transfer[:, :, 6] = -(by[:, :, :2] @ gap[:, :, None])[:, :, 0]
        transfer[:, 1, 6] += gap[:, 1]
        inner = np.zeros((count, 2, rod.INPUTS), dtype=by.dtype)
        inner[:, 0, 0] = inner[:, 1, 1] = 1
        inner[:, :, 6] = -gap
        return rod.Condensed(transfer, inner)

    def _steps(self, at: rod.Segments, of: Course) -> Array:
        """Derivatives of angle, moment and position after every sub-step by angle, moment, force, length before, (n, s, 4, 5)."""
        stretch, shear, bend = at.flexibility
        g, h = stretch - shear, at.length / self.steps
        by_bend = h * bend
        square = by_bend * h
        f, slope = of.values[0], of.N * of.turn - of.gq * of.q
        turned = np.stack([-of.gq * of.c - of.turn * of.s, of.turn * of.c - of.gq * of.s], axis=-1)
        right = np.empty((*f.shape, 5), dtype=f.dtype)
        right[..., 0] = 1
        right[..., 1] = C * by_bend
        right[..., 2:4] = -square[..., None] * (AA @ turned)
        right[..., 4] = C * (bend * of.moment) + 2 * by_bend * (f @ AA.T)
        matrix = (-square * slope)[..., None, :] * AA
        matrix.reshape(*f.shape[:2], -1)[..., :: STAGES + 1] += 1
        by = np.linalg.solve(matrix, right)

        rates = np.empty((3, *by.shape), dtype=by.dtype)
        rates[0] = slope[..., None] * by
        rates[0, ..., 2:4] -= turned
        rates[1:] = np.moveaxis(turned, -1, 0)[..., None] * by
        cc, cs = g * of.c * of.c, g * of.c * of.s
        rates[1, ..., 2] += shear + cc
        rates[1, ..., 3] += cs
        rates[2, ..., 2] += cs
        rates[2, ..., 3] += stretch - cc
        steps = np.empty((*f.shape[:2], 4, 5), dtype=by.dtype)
        steps[..., 0, :] = square * (BA @ rates[0])
        steps[..., 1:, :] = np.moveaxis(h * (B @ rates), 0, 2)
        steps[..., 0, 0] += 1
        steps[..., 0, 1] += by_bend[:, 0]
        steps[..., 0, 4] += (bend * of.moment)[..., 0] + 2 * by_bend[:, 0] * (f @ BA)
        steps[..., 1, 1] += 1
        steps[..., 1:, 4] += np.moveaxis(of.values @ B, 0, -1)
        return steps


def starts_undeformed(rods: Rods, touches: tuple[Touch | None, ...]) -> Profile:
    """Profile that holds the angle and moment at the start of every segment, in place of angles at Gauss nodes."""
    straight = profile.undeformed(rods, touches)
    return Profile(cuts=straight.cuts, angle=straight.angle[:, :2] * [1.0, 0.0])


def starts_sampled(rods: Rods, axis: shape.RodShape, state: State, cuts: Cuts, _: int) -> State:
    """Take such a profile from a shape."""
    place, inside = layout(len(rods.length), cuts), dict(cuts)
    starts = np.empty((len(place.owner), 2))
    for element, (first, last) in enumerate(zip(place.first, place.last, strict=True)):
        xi = [0.0, *(assembly.touch_of(state, k).xi for k in inside.get(element, ()))]
        at = axis.at(element, np.array(xi) * rods.length[element])
        starts[first : last + 1] = np.stack([at.angle, at.moment], axis=1)
    return replace(state, profile=Profile(cuts=cuts, angle=starts))


def axis_by_steps(rods: Rods, state: State, *_: Any) -> shape.RodShape:
    """Deflected axis, integrated to `SHAPE_ORDER` Gauss nodes of every segment."""
    entry = rods.enter(state)
    at, nodes = entry.segments, collocation(SHAPE_ORDER).c
    own = np.repeat(np.arange(len(at.length)), SHAPE_ORDER)
    flexibility = rod.Flexibility(*(value[own] for value in at.flexibility))
    arcs = (at.length * nodes).reshape(-1, 1)
    course = assembly.rod.field(rod.Segments(flexibility, at.force[:, own], arcs, at.angle[own]))
    at = at._replace(angle=course.end.reshape(-1, SHAPE_ORDER))
    return shape.plain_shape(rods, state, entry._replace(segments=at, field=rod.field(at)))


@contextmanager
def fixed() -> Iterator[None]:
    """Keep the accuracy inside exact elements as it is, and count no index: it is made from Gauss nodes."""
    with patch.object(exact, "finer", lambda *_: None), patch.object(path, "index", lambda *_: 0):
        yield


@contextmanager
def explicit(steps: int) -> Iterator[None]:
    """Integrate exact elements by DOP853."""
    with (
        patch.object(assembly, "rod", Explicit(steps)),
        patch.object(exact, "undeformed", starts_undeformed),
        patch.object(profile, "sampled", starts_sampled),
        patch.object(profile, "plain_shape", axis_by_steps),
        patch.object(exact, "deflected", axis_by_steps),
        fixed(),
    ):
        yield


@contextmanager
def gauss(order: int) -> Iterator[None]:
    """Integrate exact elements with a fixed number of Gauss nodes."""
    with patch.object(profile, "START_ORDER", order), fixed():
        yield


def errors(result: tsm.Result) -> tuple[float, float]:
    """Largest errors of contact force (relative) and arc position against the shooting solution of KS."""
    local = to_rod(load_scene("ks-cantilever"))
    beam = local.beam
    path = rod_under_pin(local.path, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
    contact = result.contacts["pin->cantilever"]
    F, s = path.magnitude[local.hits], path.arc_position[local.hits]
    return float(np.abs(contact.force / F - 1).max()), float(np.abs(contact.arc_position - s).max())


def least(action: Callable[[], Any], repeats: int) -> float:
    """Shortest seconds of an action."""
    taken = []
    for _ in range(repeats):
        begin = time.perf_counter()
        action()
        taken.append(time.perf_counter() - begin)
    return min(taken)


def main() -> None:
    structure = to_structure(load_scene("ks-cantilever"), elements=1, element="exact")
    fifty, one = np.arange(1, 51) / 50, np.array([1.0])
    rows = [("explicit, sub-steps", explicit, n) for n in EXPLICIT] + [
        ("Gauss, nodes", gauss, p) for p in GAUSS
    ]
    seconds, iteration = np.full((2, len(rows)), np.inf)
    found: dict[int, tuple[float, float, int, int, int]] = {}
    for _ in range(4):
        for k, (_, integrated, size) in enumerate(rows):
            with integrated(size):
                path, end = tsm.solve(structure, fifty), tsm.solve(structure, one)
                assembler, state = Assembler(end.model), end.equilibria[-1].state
                once = least(lambda a=assembler, x=state: a.solve(a.linearise(x)), 200)
                whole = least(lambda: tsm.solve(structure, fifty), 2)
            iteration[k], seconds[k] = min(iteration[k], once), min(seconds[k], whole)
            many, few = (int(result.newton_iterations.sum()) for result in (path, end))
            found[k] = *errors(path), many, few, end.cutbacks
    titles = (
        "error of F",
        "error of s",
        "us/iteration",
        "iterations, 50",
        "1",
        "cut-backs, 1",
        "seconds, 50",
    )
    print(" " * 23, *(f"{title:>{max(len(title), 4)}}" for title in titles), sep="  ")
    for k, (name, _, size) in enumerate(rows):
        force, arc, many, few, cutbacks = found[k]
        print(
            f"{name + f' {size}':23}  {force:10.1e}  {arc:10.1e}  {1e6 * iteration[k]:12.0f}"
            f"  {many:14}  {few:4}  {cutbacks:12}  {seconds[k]:11.3f}"
        )


if __name__ == "__main__":
    main()
