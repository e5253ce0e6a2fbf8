"""The exact equilibrium in the units of the scene: contacts, reactions, ends, and shapes of the beams."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import GAUSS, VALUES, WEIGHTS, fields, places, rotations, shapes, up_to
from comparisons.referee.guess import AnswerState
from comparisons.referee.layout import NONE, Touch
from comparisons.referee.newton import SearchStatus, Solution, solve, tails
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
    """

    force: Array
    push: float
    drag: float
    arc_position: float


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


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """The exact equilibrium near an answer, or the reason why there is none.

    All but `status`, `message` and `load_parameter` is valid for `SearchStatus.FOUND` only.

    Attributes
    ----------
    solution : Solution
        The solution in the units of `Layout`.
    """

    solution: Solution = field(repr=False)

    @property
    def status(self) -> SearchStatus:
        """Outcome of the search."""
        return self.solution.status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return self.solution.reason or self.status.value

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.solution.layout.scene

    @property
    def load_parameter(self) -> float:
        """Load parameter of the answer."""
        return self.solution.t

    @property
    def iterations(self) -> int:
        """Number of Newton iterations."""
        return self.solution.iterations

    @cached_property
    def contacts(self) -> dict[str, Contact]:
        """Closed contacts, by pair."""
        return {touch.spec.pair: touching(self.solution, touch) for touch in self.solution.layout.touches}

    @cached_property
    def reactions(self) -> dict[str, Array]:
        """Force and moment (3,) of every support, by the supported end; zero in free components."""
        layout, held = self.solution.layout, self.solution.system.held
        unit, found = layout.force * np.array([1.0, 1.0, layout.length]), dict[str, Array]()
        for support in self.scene.all_supports:
            numbers = layout.stations[layout.joint(support.node)].numbers
            given = [value is not None for value in support.motion]
            found[support.node] = np.where(given, unit * held[np.minimum(numbers, NONE)], 0.0)
        return found

    @cached_property
    def ends(self) -> dict[str, Array]:
        """Positions (2,) of the beams' ends, by names such as ``upper.end``."""
        layout, moved = self.solution.layout, self.solution.layout.motions(self.solution.z)
        return {
            end: np.array(self.scene.beams[0].start) + layout.length * (station.reference + moved[k, :2])
            for k, station in enumerate(layout.stations)
            for end in station.joint
        }

    @property
    def strain_energy(self) -> float:
        """Energy of all rods, springs and hinges."""
        return self.solution.system.energy * self.solution.layout.force * self.solution.layout.length

    @property
    def index(self) -> int:
        """Number of negative eigenvalues of the energy's Hessian on the admissible variations; -1 with friction."""
        return self.solution.index

    @property
    def error(self) -> float:
        """Estimated relative error: the last correction and the last terms of the rotation."""
        return max(self.solution.correction, float(tails(self.solution.bubbles).max()))

    def shape(self, beam: str, arc: Array) -> Shape:
        """Return the shape of a beam at arc lengths (m,)."""
        return _shape(self.solution, beam, np.asarray(arc, dtype=np.float64))

    def place(self, node: str) -> Array:
        """Return the position of a beam's end such as ``upper.end``, or of a pin."""
        if "." in node:
            return self.ends[node]
        return np.array(self.scene.pin(node).position(self.load_parameter))

    def joint_rotation(self, end: str) -> float:
        """Return the rotation of the joint to which a beam's end belongs, which differs from the end's behind a hinge."""
        layout = self.solution.layout
        return float(layout.motions(self.solution.z)[layout.joint(end), 2])


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
    return Equilibrium(solve(scene, answer))


def _tangents(solution: Solution, touch: Touch) -> tuple[Array, Array]:
    """Return ``r'_-`` and ``r'_+`` at a contact."""
    parts, z = solution.layout.beside(touch), solution.z
    s, theta = float(z[touch.arc]), float(solution.layout.motions(z)[parts[0].last, 2])
    before, behind = (np.asarray(part.rod.tangent(part.piece, part.constant(z), s, theta)) for part in parts)
    return before, behind


def touching(solution: Solution, touch: Touch) -> Contact:
    """Return a contact in the units of the scene."""
    layout, z = solution.layout, solution.z
    before, behind = layout.beside(touch)
    force = layout.force * before.rod.axes @ (before.constant(z) - behind.constant(z))
    x, y = np.sum(_tangents(solution, touch), axis=0)
    size = np.hypot(x, y)
    return Contact(
        force=force,
        push=float(touch.right * (x * force[1] - y * force[0]) / size),
        drag=float((x * force[0] + y * force[1]) / size),
        arc_position=float(z[touch.arc]) * layout.length,
    )


def _shape(solution: Solution, beam: str, arc: Array) -> Shape:
    """Evaluate the shape of a beam at arc lengths (m,)."""
    layout, z, mesh = solution.layout, solution.z, solution.mesh
    coefficients, s = rotations(layout, mesh, z, solution.bubbles), arc / layout.length
    number = [item.name for item in layout.scene.beams].index(beam)
    numbers = np.array([k for k, part in enumerate(layout.parts) if part.beam == number])
    begins = layout.extents(z)[numbers, 0]
    own = numbers[np.searchsorted(begins[1:], s, side="right")]
    table = np.empty((len(s), 8))
    for k in np.unique(own):
        part, inside, here = layout.parts[k], own == k, mesh.part == k
        first, extent = layout.extents(z)[k, 0], np.diff(layout.extents(z)[k])[0]
        start, half, rotation = mesh.start[here], mesh.share[here] * extent / 2.0, coefficients[here]
        points = first + extent * start[:, None] + half[:, None] * (1.0 + GAUSS)
        within = places(layout, mesh.part[here], points, z[mesh.local[here, 2:4]])
        inner = within.in_chord(fields(rotation @ VALUES.T, within)[2])
        starts = np.zeros((len(start) + 1, 2))
        np.cumsum(half[:, None] * (WEIGHTS @ inner), axis=0, out=starts[1:])
        share = (s[inside] - first) / extent
        e = np.clip(np.searchsorted(start, share, side="right") - 1, 0, len(start) - 1)
        xi = 2.0 * (share - start[e]) / mesh.share[here][e] - 1.0
        values, slopes = shapes(xi)
        theta, bent = (np.einsum("mi,mi->m", item, rotation[e]) for item in (values, slopes))
        there = places(layout, np.array([k]), s[None, inside], part.constant(z)[None])
        N, Q, tangent = (item[0] for item in fields(theta[None], there))
        along = starts[e] + half[e][:, None] * np.einsum("mq,mqk->mk", up_to(xi), inner[e])
        along = (
            layout.position(z, part.first) + (along + part.rod.between(first, s[inside])) @ part.rod.axes.T
        )
        tangent = there.in_chord(tangent[None])[0] + part.rod.direction(s[inside])
        moment = there.EI[0] * bent / half[e]
        table[inside] = np.column_stack([along, tangent @ part.rod.axes.T, theta, moment, N, Q])
    unit = layout.force * layout.length
    return Shape(
        position=np.array(layout.scene.beams[0].start) + layout.length * table[:, :2],
        tangent=table[:, 2:4],
        rotation=table[:, 4],
        moment=unit * table[:, 5],
        N=layout.force * table[:, 6],
        Q=layout.force * table[:, 7],
    )
