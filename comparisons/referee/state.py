"""The exact equilibrium in the units of the scene: contacts, reactions, ends, and shapes of the beams."""

from dataclasses import field, replace
from enum import Enum
from functools import cached_property

import numpy as np

from comparisons.answer import Array, Ints
from comparisons.frozen import Frozen
from comparisons.referee.elements import AMPLITUDE, WEIGHTS, Mesh, at_gauss, rotations, shapes, up_to
from comparisons.referee.equations import System, assemble, index_of
from comparisons.referee.layout import NONE, Layout, Touch
from comparisons.referee.rod import cross
from comparisons.scene import Scene

_INSIDE = 1.0 - 1e-9
"""Fraction of a part up to which points lie before its end."""


class Contact(Frozen):
    """A closed contact in exact equilibrium."""

    force: Array  #: Contact force on the beam, shape (2,).
    push: float  #: Component along the normal to the mean of the two tangents; positive in compression.
    drag: float  #: Component along the mean of the two tangents; zero without friction.
    arc_position: float  #: Distance along the undeformed axis from the beam's start.


class Shape(Frozen):
    """Positions and section forces at m places along a beam."""

    position: Array  #: Positions (m, 2).
    tangent: Array  #: Derivative of the position by arc length (m, 2); at a contact the one behind it.
    rotation: Array  #: Rotation of the section (m,).
    moment: Array  #: Bending moment (m,).
    N: Array  #: Normal force (m,).
    Q: Array  #: Shear force (m,).


class SearchStatus(Enum):
    """Outcome of the search for an equilibrium; the value is the message for the user."""

    FOUND = "the exact equilibrium was found"
    NO_EQUILIBRIUM = "no equilibrium was found near the answer"
    NOT_RESOLVED = "the deflection has layers that are not resolved"
    NOT_JUDGED = "the scene or the arrangement of its contacts is beyond double precision"


class Equilibrium(Frozen):
    """The exact equilibrium near an answer, or a guess of it, by the unknowns of a layout."""

    mesh: Mesh = field(repr=False)
    z: Array = field(
        repr=False
    )  #: Unknowns, those of the layout first and the coefficients of the bubbles last.
    #: Outcome of the search; what follows from the unknowns is valid for `SearchStatus.FOUND` only.
    status: SearchStatus = SearchStatus.NO_EQUILIBRIUM
    reason: str = ""  #: Why there is none, where more is known than the status says.
    iterations: int = 0  #: Number of Newton iterations.
    correction: float = np.inf  #: Last correction of the unknowns.

    def plus(self, change: Array) -> "Equilibrium":
        """Return the guess with other unknowns."""
        return replace(self, z=self.z + change)

    @property
    def layout(self) -> Layout:
        """The layout."""
        return self.mesh.layout

    @property
    def found(self) -> bool:
        """Whether it is an equilibrium."""
        return self.status is SearchStatus.FOUND

    @property
    def message(self) -> str:
        """The outcome as a sentence."""
        return self.reason or self.status.value

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.layout.scene

    @property
    def load_parameter(self) -> float:
        """The load parameter."""
        return self.layout.load_parameter

    @cached_property
    def closed(self) -> dict[str, float]:
        """Arc positions of the closed contacts, by pair."""
        return {
            pair: float(self.z[touch.arc]) * self.layout.length for pair, touch in self.layout.touches.items()
        }

    @cached_property
    def system(self) -> System:
        """The equations in the units of the layout."""
        return assemble(self.mesh, self.z)

    @cached_property
    def contacts(self) -> dict[str, Contact]:
        """Closed contacts, by pair."""
        found, layout = dict[str, Contact](), self.layout
        for pair, touch in layout.touches.items():
            before, behind = layout.beside(touch)
            force = layout.force * (before.constant(self.z) - behind.constant(self.z))[:, 0]
            mean = np.sum(self.tangents(touch), axis=0)
            size = np.hypot(*mean)
            push, drag = float(-touch.face.left * cross(mean, force) / size), float(mean @ force / size)
            found[pair] = Contact(force=force, push=push, drag=drag, arc_position=self.closed[pair])
        return found

    @cached_property
    def reactions(self) -> dict[str, Array]:
        """Force and moment (3,) of every support, by the supported end; zero in free components."""
        layout, found = self.layout, dict[str, Array]()
        unit = layout.force * np.array([1.0, 1.0, layout.length])
        for support in self.scene.all_supports:
            numbers = layout.stations[layout.joints[support.node]].numbers
            given = [value is not None for value in support.motion]
            found[support.node] = np.where(given, unit * self.system.held[np.minimum(numbers, NONE)], 0.0)
        return found

    @cached_property
    def ends(self) -> dict[str, Array]:
        """Positions (2,) of the beams' ends, by names such as ``upper.end``."""
        layout, moved = self.layout, self.layout.motions(self.z)
        return {
            end: self.scene.beams[0].start + layout.length * (layout.references[k] + moved[k, :2])
            for end, k in layout.joints.items()
        }

    @property
    def strain_energy(self) -> float:
        """Energy of all rods, springs and hinges."""
        return self.system.energy * self.layout.force * self.layout.length

    @cached_property
    def index(self) -> int:
        """Number of negative eigenvalues of the energy's Hessian on the admissible variations; -1 with friction."""
        return index_of(self.mesh, self.z, self.system)

    @property
    def tails(self) -> Array:
        """Largest amplitude of the last two bubbles of every element."""
        return np.asarray((np.abs(rotations(self.mesh, self.z))[:, -2:] * AMPLITUDE[-2:]).max(axis=1))

    @property
    def error(self) -> float:
        """Estimated relative error: the last correction and the last terms of the rotation."""
        return max(self.correction, float(self.tails.max()))

    @cached_property
    def _strained(self) -> tuple[Array, Array]:
        """Derivatives (2, e, g) of the strained way by xi at the Gauss points, and its integrals (2, e + 1) over the elements before."""
        theta, _, *c, half, s = at_gauss(self.mesh, self.z)
        ways = half * self.layout.pieces(self.mesh.part).strained(np.array(c), s, theta).way
        return ways, np.cumsum(np.pad(ways @ WEIGHTS, ((0, 0), (1, 0))), axis=1)

    def located(self, part: Ints, x: Array) -> tuple[Ints, Array, Array, Array]:
        """Return elements, xi, rotations and their derivatives by xi at fractions x (...) of the parts `part` (...)."""
        mesh = self.mesh
        e = np.searchsorted(mesh.part + mesh.start, part + np.clip(x, 0.0, _INSIDE), side="right") - 1
        xi = 2.0 * (x - mesh.start[e]) / mesh.share[e] - 1.0
        rotation = rotations(mesh, self.z)[e]
        theta, bent = ((item * rotation).sum(axis=-1) for item in shapes(xi))
        return e, xi, theta, bent

    def shape(self, beam: str, arc: Array) -> Shape:
        """Return the shape of a beam at arc lengths (m,)."""
        layout, z, s = self.layout, self.z, np.asarray(arc) / self.layout.length
        parts = [k for k, part in enumerate(layout.parts) if part.beam == beam]
        extents = layout.extents(z)
        part = np.array(parts)[np.searchsorted(extents[parts[1:], 0], s, side="right")]
        first, last = extents[part].T
        e, xi, theta, bent = self.located(part, (s - first) / (last - first))
        ways, before = self._strained
        begun = before[:, np.searchsorted(self.mesh.part, part)]
        along = before[:, e] - begun + (up_to(xi) * ways[:, e]).sum(axis=2)
        c = z[self.mesh.local[e, 2:4]].T[..., None]
        pieces, at, turned = layout.pieces(part), s[:, None], theta[:, None]
        begins = (layout.references + layout.shifts(z))[layout.chords[0][0, part]]
        there, half = pieces.strained(c, at, turned), self.mesh.share[e] * (last - first) / 2.0
        position = begins + (along + pieces.between(first[:, None], at)[..., 0]).T
        return Shape(
            position=np.array(layout.scene.beams[0].start) + layout.length * position,
            tangent=pieces.tangent(c, at, turned)[..., 0].T,
            rotation=theta,
            moment=layout.force * layout.length * there.EI[:, 0] * bent / half,
            N=layout.force * there.N[:, 0],
            Q=layout.force * there.Q[:, 0],
        )

    def tangents(self, touch: Touch) -> tuple[Array, Array]:
        """Return ``r'_-`` and ``r'_+`` at a contact."""
        parts, z = self.layout.beside(touch), self.z
        s, theta = z[[touch.arc]], self.layout.motions(z)[touch.station, 2]
        before, behind = (part.piece.tangent(part.constant(z), s, theta)[:, 0] for part in parts)
        return before, behind

    def place(self, node: str) -> Array:
        """Return the position of a beam's end such as ``upper.end``, or of a pin."""
        if "." in node:
            return self.ends[node]
        return np.array(self.scene.pin(node).position(self.load_parameter))
