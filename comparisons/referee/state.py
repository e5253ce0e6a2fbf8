"""The exact equilibrium in the units of the scene: contacts, reactions, ends, and shapes of the beams."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import GAUSS, VALUES, WEIGHTS, shapes, up_to
from comparisons.referee.elements import Fields, fields, rotations
from comparisons.referee.equilibrium import SearchStatus, Solution, solve
from comparisons.referee.layout import Part, Touch
from comparisons.referee.stability import index_of
from comparisons.referee.start import AnswerState
from comparisons.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Contact:
    """A closed contact in exact equilibrium.

    Attributes
    ----------
    force : ndarray, shape (2,)
        Contact force on the beam.
    push : float
        Component of the force along the normal to the mean of the two tangent directions; positive in compression.
    drag : float
        Component of the force along the mean of the two tangent directions; zero without friction.
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
    """Positions and section forces along a beam.

    Attributes
    ----------
    position, tangent : ndarray, shape (m, 2)
        Position and its derivative by arc length; at a contact the derivative behind it.
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
    """The exact equilibrium near an answer, or the reason why there is none.

    Attributes
    ----------
    status : SearchStatus
        Outcome of the search; the other attributes are valid for `SearchStatus.FOUND` only.
    message : str
        The status as a sentence.
    load_parameter : float
        Load parameter of the answer.
    contacts : dict of Contact
        Closed contacts, by pair.
    reactions : dict of ndarray, shape (3,)
        Force and moment of every support, by the supported end.
    ends : dict of ndarray, shape (2,)
        Positions of the beams' ends, by names such as ``upper.end``.
    strain_energy : float
        Energy of all rods, springs and hinges.
    index : int
        Number of negative eigenvalues of the energy's Hessian on the admissible variations; -1 without an equilibrium.
    error : float
        Estimated relative error: the last correction and the last terms of the rotation.
    iterations : int
        Number of Newton iterations.
    solution : Solution
        The solution in the units of `Layout`.
    """

    status: SearchStatus
    message: str
    load_parameter: float
    contacts: dict[str, Contact]
    reactions: dict[str, Array]
    ends: dict[str, Array]
    strain_energy: float
    index: int
    error: float
    iterations: int
    solution: Solution = field(repr=False)

    def shape(self, beam: str, arc: Array) -> Shape:
        """Return the shape of a beam at arc lengths (m,)."""
        return _shape(self.solution, beam, np.asarray(arc, dtype=np.float64))

    def pose(self, end: str) -> Array:
        """Return position and rotation ``x, y, theta`` of a beam's end such as ``upper.end``."""
        layout = self.solution.layout
        number = next(k for k, station in enumerate(layout.stations) if end in station.ends)
        return np.append(self.ends[end], layout.rotation(self.solution.z, number))

    def joint_rotation(self, end: str) -> float:
        """Return the rotation of the joint to which a beam's end belongs, which differs from the end's behind a hinge."""
        layout = self.solution.layout
        number = next(k for k, station in enumerate(layout.stations) if end in station.joint)
        return layout.rotation(self.solution.z, number)


def equilibrium(scene: Scene, answer: AnswerState) -> Equilibrium:
    """Return the exact equilibrium of `scene` near an answer.

    The force in a rod between ends, joints and contacts is constant but for the load along the rod. The rotation is a polynomial of
    degree 16 on elements that are halved until its last terms are round-off. Newton's method with the exact Hessian starts from the
    answer.

    Examples
    --------
    >>> from comparisons.models import solve
    >>> from comparisons.referee import equilibrium, answer_state
    >>> from comparisons.scene import load_scene
    >>> scene = load_scene("ks-cantilever")
    >>> exact = equilibrium(scene, answer_state(solve(scene, "tsm"), scene, -1))
    >>> f"{exact.contacts['pin->cantilever'].push:.12e}", exact.index
    ('2.288274307175e-03', 0)
    """
    solution = solve(scene, answer)
    if solution.status is not SearchStatus.FOUND or solution.system is None:
        return Equilibrium(
            status=solution.status,
            message=solution.reason or solution.status.value,
            load_parameter=answer.load_parameter,
            contacts={},
            reactions={},
            ends={},
            strain_energy=np.nan,
            index=-1,
            error=np.inf,
            iterations=solution.iterations,
            solution=solution,
        )
    return described(scene, solution)


def described(scene: Scene, solution: Solution) -> Equilibrium:
    """Return an equilibrium that was found, in the units of the scene."""
    assert solution.system is not None, "an equilibrium has its equations"
    layout = solution.layout
    contacts = {touch.spec.pair: touching(solution, touch) for touch in layout.touches}
    origin = np.array(scene.beams[0].start)
    return Equilibrium(
        status=solution.status,
        message=solution.status.value,
        load_parameter=layout.load_parameter,
        contacts=contacts,
        reactions=_reactions(solution, contacts),
        ends={
            end: origin + layout.length * station.place.position(solution.z)
            for station in layout.stations
            for end in station.joint
        },
        strain_energy=solution.system.energy * layout.force * layout.length,
        index=index_of(solution),
        error=max(solution.correction, solution.tail),
        iterations=solution.iterations,
        solution=solution,
    )


def _tangents(solution: Solution, touch: Touch) -> tuple[Array, Array]:
    """Return ``r'_-`` and ``r'_+`` at a contact."""
    before, behind = solution.layout.beside(touch)
    return _tangent_at(solution, before, before.last), _tangent_at(solution, behind, behind.first)


def _tangent_at(solution: Solution, part: Part, station: int) -> Array:
    """Return ``r'`` of a part at one of its stations."""
    theta = np.array(solution.layout.rotation(solution.z, station))
    s = solution.layout.arc(solution.z, station, part)
    _, stretch, shear = part.rod.flexibility(s)
    there = fields(theta, part.local(solution.z[part.force : part.force + 2], s), stretch, shear)
    return np.asarray(part.rod.frame(s) @ (there.tangent + np.array([1.0, 0.0])))


def touching(solution: Solution, touch: Touch) -> Contact:
    """Return a contact in the units of the scene."""
    layout, z = solution.layout, solution.z
    before, behind = layout.beside(touch)
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
        point=np.array(layout.scene.beams[0].start) + layout.length * touch.place.position(z),
    )


def _reactions(solution: Solution, contacts: dict[str, Contact]) -> dict[str, Array]:
    """Reactions (3,) by supported end, from the balance of parts, loads and contacts; zero in free components."""
    layout = solution.layout
    reactions: dict[str, Array] = {}
    for support in layout.scene.all_supports:
        number = next(k for k, item in enumerate(layout.stations) if support.node in item.joint)
        total = _held(solution, number) * layout.force * np.array([1.0, 1.0, layout.length])
        for touch in layout.touches:
            if touch.spec.node in layout.stations[number].joint:
                total[:2] += contacts[touch.spec.pair].force
        held = [value is not None for value in support.motion]
        reactions[support.node] = np.where(held, total, 0.0)
    return reactions


def _held(solution: Solution, number: int) -> Array:
    """Force and moment (3,) of parts, springs and hinges less the loads at a joint, in units of `Layout`."""
    layout, z, mesh = solution.layout, solution.z, solution.mesh
    assert solution.system is not None, "an equilibrium has its equations"
    station = layout.stations[number]
    total = -np.array([*station.force, station.moment])
    total += np.array(station.springs) * [*station.place.displacement(z), layout.rotation(z, number)]
    here = {number}
    for hinge in layout.hinges:
        if hinge.joint == number:
            here.add(hinge.end)
            total[:2] -= layout.stations[hinge.end].force
            total[2] += hinge.stiffness * (layout.rotation(z, number) - layout.rotation(z, hinge.end))
    for k, part in enumerate(layout.parts):
        elements = np.flatnonzero(mesh.part == k)
        for end, sign, e, side in ((part.first, -1.0, elements[0], 0), (part.last, 1.0, elements[-1], 1)):
            if end in here:
                total[:2] += sign * part.axes @ z[part.force : part.force + 2]
            if end == number:
                total[2] += solution.system.ends[e, side]
    return total


def _shape(solution: Solution, beam: str, arc: Array) -> Shape:
    """Evaluate the shape of a beam at arc lengths (m,)."""
    layout, z, mesh = solution.layout, solution.z, solution.mesh
    coefficients = rotations(mesh, z, solution.bubbles)
    number = [item.name for item in layout.scene.beams].index(beam)
    s = arc / layout.length
    table = np.empty((len(s), 8))
    numbers = [k for k, part in enumerate(layout.parts) if part.beam == number]
    for k in numbers:
        part = layout.parts[k]
        first, extent = layout.arc(z, part.first, part), layout.extent(z, part)
        inside = ((s >= first) | (k == numbers[0])) & ((s < first + extent) | (k == numbers[-1]))
        if not inside.any():
            continue
        elements = np.flatnonzero(mesh.part == k)
        half = mesh.share[elements] * extent / 2.0
        points = first + extent * mesh.start[elements][:, None] + half[:, None] * (1.0 + GAUSS)
        inner = _fields(part, points, coefficients[elements] @ VALUES.T, z).tangent
        starts = np.zeros((len(elements) + 1, 2))
        np.cumsum(half[:, None] * (WEIGHTS @ inner), axis=0, out=starts[1:])
        share = (s[inside] - first) / extent
        e = np.clip(np.searchsorted(mesh.start[elements], share, side="right") - 1, 0, len(elements) - 1)
        xi = 2.0 * (share - mesh.start[elements][e]) / mesh.share[elements][e] - 1.0
        values, slopes = shapes(xi)
        theta = np.einsum("mi,mi->m", values, coefficients[elements][e])
        bent = np.einsum("mi,mi->m", slopes, coefficients[elements][e]) / half[e]
        N, Q, tangent = _fields(part, s[inside], theta, z)
        along = starts[e] + half[e][:, None] * np.einsum("mq,mqk->mk", up_to(xi), inner[e])
        if part.rod.turn:
            along += np.array([part.rod.between(first, float(x)) for x in s[inside]])
            tangent += np.array([part.rod.direction(float(x)) for x in s[inside]])
        else:
            along[:, 0] += s[inside] - first
            tangent[:, 0] += 1.0
        position = layout.position(z, part.first) + along @ part.axes.T
        moment = part.rod.flexibility(s[inside]).EI * bent
        table[inside] = np.column_stack([position, tangent @ part.axes.T, theta, moment, N, Q])
    unit = layout.force * layout.length
    return Shape(
        position=np.array(layout.scene.beams[0].start) + layout.length * table[:, :2],
        tangent=table[:, 2:4],
        rotation=table[:, 4],
        moment=unit * table[:, 5],
        N=layout.force * table[:, 6],
        Q=layout.force * table[:, 7],
    )


def _fields(part: Part, s: Array, theta: Array, z: Array) -> Fields:
    """Fields of a part at arc positions (...), with the tangent in the frame of the chord."""
    _, stretch, shear = part.rod.flexibility(s)
    N, Q, tangent = fields(theta, part.local(z[part.force : part.force + 2], s), stretch, shear)
    return Fields(N, Q, part.rod.turned(tangent, s, back=True))
