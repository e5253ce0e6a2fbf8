"""The referee's equilibrium in the scene's units: what a response states, exactly, and the shape everywhere along the beams."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import VALUES, WEIGHTS, shapes, up_to
from comparisons.referee.equations import fields, rotations
from comparisons.referee.equilibrium import Found, Solution, solve
from comparisons.referee.layout import NONE, Layout, Part, Touch
from comparisons.referee.stability import count
from comparisons.referee.start import Given
from comparisons.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Contact:
    """A closed contact in exact equilibrium.

    Attributes
    ----------
    force : ndarray, shape (2,)
        Force on the beam.
    push : float
        Its part along the normal to the mean of the two tangent directions, positive where it pushes from the stated side.
    drag : float
        Its part along that mean direction, which no friction leaves at zero.
    arc_position : float
        Distance along the undeformed axis from the beam's start.
    point : ndarray, shape (2,)
        The touching point.
    """

    force: Array
    push: float
    drag: float
    arc_position: float
    point: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Shape:
    """Places on a beam's axis.

    Attributes
    ----------
    position, tangent : ndarray, shape (m, 2)
        Position and its derivative by arc length; at a contact that behind it.
    rotation, moment, N, Q : ndarray, shape (m,)
        Rotation of the section, bending moment, normal and shear force.
    """

    position: Array
    tangent: Array
    rotation: Array
    moment: Array
    N: Array
    Q: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Equilibrium:
    """The exact equilibrium next to an answer, or why there is none.

    Attributes
    ----------
    found : Found
        How the search ended; of another end than `Found.FOUND` nothing else holds.
    message : str
        In a sentence.
    load_parameter : float
        Of the answer.
    contacts : dict of Contact
        By pair, the closed ones.
    reactions : dict of ndarray, shape (3,)
        Force and moment of every support, by the held end.
    ends : dict of ndarray, shape (2,)
        Position of every beam's ends, as ``upper.end``.
    strain_energy : float
        Of all rods.
    index : int
        Number of negative eigenvalues of the energy's Hessian on the admissible variations; -1 where there is none.
    margin : float
        Smallest eigenvalue in size of the scaled Hessian: the index is uncertain where this is round-off.
    error : float
        Estimated relative error: the last correction and the last terms of the rotation.
    iterations : int
        Of Newton's method.
    solution : Solution
        In the referee's own terms.
    """

    found: Found
    message: str
    load_parameter: float
    contacts: dict[str, Contact]
    reactions: dict[str, Array]
    ends: dict[str, Array]
    strain_energy: float
    index: int
    margin: float
    error: float
    iterations: int
    solution: Solution = field(repr=False)

    def shape(self, beam: str, arc: Array) -> Shape:
        """Return the places at the given arc lengths of a beam."""
        return _shape(self.solution, beam, np.asarray(arc, dtype=np.float64))

    def turned(self, end: str) -> Array:
        """Return position and rotation ``x, y, theta`` of a beam's end, ``upper.end``."""
        layout = self.solution.layout
        number = next(k for k, station in enumerate(layout.stations) if end in station.ends)
        return np.append(self.ends[end], layout.turned(self.solution.z, number))

    def material_force(self, beam: str, arc: Array) -> Array:
        """Return ``H = m^2/2EI + N + N^2/2EA + Q^2/2GA`` at the given arc lengths of a beam."""
        there, spec = self.shape(beam, arc), self.solution.layout.scene.beam(beam)
        stretched = there.N + there.N**2 / (2.0 * spec.EA) + there.Q**2 / (2.0 * spec.GA)
        return np.asarray(there.moment**2 / (2.0 * spec.EI) + stretched)


def equilibrium(scene: Scene, given: Given) -> Equilibrium:
    """Return the exact equilibrium of `scene` next to `given`.

    Rods between ends, joints and contacts carry a constant force; the rotation is a polynomial of degree 16 on elements that are
    halved until their last terms are round-off; Newton's method with the exact Hessian starts from the answer.

    Examples
    --------
    >>> from comparisons.models import solve
    >>> from comparisons.referee import equilibrium, given_by
    >>> from comparisons.scene import load_scene
    >>> scene = load_scene("ks-cantilever")
    >>> exact = equilibrium(scene, given_by(solve(scene, "tsm"), scene, -1))
    >>> f"{exact.contacts['pin->cantilever'].push:.12e}", exact.index
    ('2.288274307175e-03', 0)
    """
    solution = solve(scene, given)
    if solution.found is not Found.FOUND or solution.system is None:
        return Equilibrium(
            found=solution.found,
            message=solution.reason or solution.found.value,
            load_parameter=given.load_parameter,
            contacts={},
            reactions={},
            ends={},
            strain_energy=np.nan,
            index=-1,
            margin=np.nan,
            error=np.inf,
            iterations=solution.iterations,
            solution=solution,
        )
    layout = solution.layout
    contacts = {touch.spec.pair: _contact(solution, touch) for touch in layout.touches}
    index, margin = count(solution)
    origin = np.array(scene.beams[0].start)
    return Equilibrium(
        found=solution.found,
        message=solution.found.value,
        load_parameter=given.load_parameter,
        contacts=contacts,
        reactions=_reactions(solution, contacts),
        ends={
            end: origin + layout.length * station.place.at(solution.z)
            for station in layout.stations
            for end in station.ends
        },
        strain_energy=solution.system.energy * layout.force * layout.length,
        index=index,
        margin=margin,
        error=max(solution.correction, solution.tail),
        iterations=solution.iterations,
        solution=solution,
    )


def _parts_at(layout: Layout, touch: Touch) -> tuple[Part, Part]:
    """Parts before and behind a contact."""
    number = next(
        k
        for k, item in enumerate(layout.stations)
        if item.touch != NONE and layout.touches[item.touch] is touch
    )
    before = next(part for part in layout.parts if part.last == number)
    behind = next(part for part in layout.parts if part.first == number)
    return before, behind


def _tangents(solution: Solution, touch: Touch) -> tuple[Array, Array]:
    """Return ``r'_-`` and ``r'_+`` at a contact."""
    before, behind = _parts_at(solution.layout, touch)
    return _tangent_at(solution, before, before.last), _tangent_at(solution, behind, behind.first)


def _tangent_at(solution: Solution, part: Part, station: int) -> Array:
    theta = np.array(solution.layout.turned(solution.z, station))
    there = fields(theta, solution.z[part.force : part.force + 2], part.stretch, part.shear)
    return np.asarray(part.axes @ (there.tangent + np.array([1.0, 0.0])))


def _contact(solution: Solution, touch: Touch) -> Contact:
    layout, z = solution.layout, solution.z
    before, behind = _parts_at(layout, touch)
    force = (
        layout.force * before.axes @ (z[before.force : before.force + 2] - z[behind.force : behind.force + 2])
    )
    first, second = _tangents(solution, touch)
    x, y = (first + second) / np.hypot(*(first + second))
    side = 1.0 if touch.spec.side == "left" else -1.0
    return Contact(
        force=force,
        push=float(side * (y * force[0] - x * force[1])),
        drag=float(x * force[0] + y * force[1]),
        arc_position=float(z[touch.arc]) * layout.length,
        point=np.array(layout.scene.beams[0].start) + layout.length * touch.place.at(z),
    )


def _reactions(solution: Solution, contacts: dict[str, Contact]) -> dict[str, Array]:
    """Force and moment that the supports add to balance parts, loads and contacts, zero in free components."""
    layout, z, mesh = solution.layout, solution.z, solution.mesh
    assert solution.system is not None, "an equilibrium has its equations"
    found: dict[str, Array] = {}
    for support in layout.scene.all_supports:
        number = next(k for k, item in enumerate(layout.stations) if support.node in item.ends)
        station = layout.stations[number]
        total = -np.array([*station.force, station.moment])
        for k, part in enumerate(layout.parts):
            own = np.flatnonzero(mesh.part == k)
            for end, sign, e, side in ((part.first, -1.0, own[0], 0), (part.last, 1.0, own[-1], 1)):
                if end == number:
                    total[:2] += sign * part.axes @ z[part.force : part.force + 2]
                    total[2] += solution.system.ends[e, side]
        total *= layout.force * np.array([1.0, 1.0, layout.length])
        for touch in layout.touches:
            if touch.spec.node in station.ends:
                total[:2] += contacts[touch.spec.pair].force
        held = [value is not None for value in support.motion]
        found[support.node] = np.where(held, total, 0.0)
    return found


def _shape(solution: Solution, beam: str, arc: Array) -> Shape:
    layout, z, mesh = solution.layout, solution.z, solution.mesh
    coefficients = rotations(mesh, z, solution.bubbles)
    number = [item.name for item in layout.scene.beams].index(beam)
    at = arc / layout.length
    table = np.empty((len(at), 8))
    own = [k for k, part in enumerate(layout.parts) if part.beam == number]
    for k in own:
        part = layout.parts[k]
        first, extent = layout.arc(z, part.first, part), layout.extent(z, part)
        here = ((at >= first) | (k == own[0])) & ((at < first + extent) | (k == own[-1]))
        if not here.any():
            continue
        elements = np.flatnonzero(mesh.part == k)
        n = z[part.force : part.force + 2]
        half = mesh.share[elements] * extent / 2.0
        inner = fields(coefficients[elements] @ VALUES.T, n, part.stretch, part.shear).tangent
        starts = np.zeros((len(elements) + 1, 2))
        np.cumsum(half[:, None] * (WEIGHTS @ inner), axis=0, out=starts[1:])
        share = (at[here] - first) / extent
        e = np.clip(np.searchsorted(mesh.start[elements], share, side="right") - 1, 0, len(elements) - 1)
        xi = 2.0 * (share - mesh.start[elements][e]) / mesh.share[elements][e] - 1.0
        values, slopes = shapes(xi)
        theta = np.einsum("mi,mi->m", values, coefficients[elements][e])
        bent = np.einsum("mi,mi->m", slopes, coefficients[elements][e]) / half[e]
        N, Q, tangent = fields(theta, n, part.stretch, part.shear)
        along = starts[e] + half[e][:, None] * np.einsum("mq,mqk->mk", up_to(xi), inner[e])
        along[:, 0] += at[here] - first
        tangent[:, 0] += 1.0
        position = layout.position(z, part.first) + along @ part.axes.T
        table[here] = np.column_stack([position, tangent @ part.axes.T, theta, part.EI * bent, N, Q])
    unit = layout.force * layout.length
    return Shape(
        position=np.array(layout.scene.beams[0].start) + layout.length * table[:, :2],
        tangent=table[:, 2:4],
        rotation=table[:, 4],
        moment=unit * table[:, 5],
        N=layout.force * table[:, 6],
        Q=layout.force * table[:, 7],
    )
