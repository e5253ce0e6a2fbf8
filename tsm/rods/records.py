"""Records of the numerics of exact elements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from tsm.elements import rod
from tsm.elements.properties import Array
from tsm.elements.rod import Arrival, Field, Flexibility
from tsm.rods.friction_rows import Rubbing
from tsm.rods.layout import Layout
from tsm.state import State

if TYPE_CHECKING:
    from tsm.rods.shape import RodShape


class Owned(NamedTuple):
    """Constants of the elements, one for every segment."""

    place: Layout  # the segments
    dofs: Array  # degrees of freedom of the elements; shape (9, s)
    angles: tuple[Array, Array]  # angles of the undeformed elements at both ends; shape (s,)
    length: Array  # their length; shape (s,)
    flexibility: Flexibility  # flexibilities of the elements


class Section(NamedTuple):
    """Flexibilities 1/EA, 1/GA, 1/EI of one section, and the natural curvature there."""

    stretch: float
    shear: float
    bend: float
    curvature: float


class Entry(NamedTuple):
    """Where the segments of a state begin and end."""

    place: Layout  # elements of the segments
    segments: Any  # force, length and angles inside
    field: Field  # the rod's equations there
    start: Array  # start, end, moment: angles at both ends, moment at the start; shape (s, 1)
    end: Array
    moment: Array
    gain: Array  # moment at the end minus moment at the start; shape (s,)
    vector: Array  # vector from start to end; shape (2, s)
    rubbing: dict[int, Rubbing]  # contacts with friction, by pair
    load_parameter: float  # load parameter


class RodBalance(NamedTuple):
    """Residual of the exact elements."""

    entry: Entry  # the segments
    arrival: Arrival  # their residuals
    nodal: Array  # forces on node i, arrival at node j, forces on node j; shape (9, r)
    contacts: dict[int, list[Any]]  # by pair: the rows of position (2), direction and arrival of the angle
    # by pair: the axis' tangent vectors before and after the contact
    tangents: dict[int, tuple[rod.Tangent, rod.Tangent]]
    inside: float  # largest residual inside [rad]

    @property
    def ends(self) -> Array:
        """Forces and moments at both ends of the elements, shape (6, r)."""
        ends: Array = self.nodal[[0, 1, 2, 6, 7, 8]]
        return ends


class CutElement(NamedTuple):
    """Tangent of an element with contacts; under loads along it, the load parameter is the last column but one."""

    element: int  # counted over the exact elements
    pairs: tuple[int, ...]  # its contact pairs in order of arc position
    # tangent over the unknowns of the element, then of the contacts. The last column is the contribution of
    # the inner residual; shape (9 + 4 k, 10 + 4 k)
    tangent: Array
    inputs: Array  # inputs of the segments by the same unknowns; shape (k + 1, 7, 10 + 4 k)
    # by pair with friction: its slip rate as a linear form over the same unknowns; shape (10 + 4 k,)
    slip: dict[int, Array]


class RodTangent(NamedTuple):
    """Tangent of the exact elements."""

    # contribution of the inner residual to the residual after the inner unknowns are eliminated; shape
    # (9, r)
    condensed_residual: Array
    tangent: Array  # derivative of the residual, row by row; shape (81, r)
    # tangents of the elements with contacts. The part without contacts is in the arrays above too
    cut: tuple[CutElement, ...]
    inner: Array  # derivatives of the angles inside by the inputs of the segments; shape (s, p, 7)
    transfer: Array  # derivatives of their outputs, see `rod.Condensed`; shape (s, 4, 7)


class Memo(NamedTuple):
    """Cache of the last deflected axis, with its state and the closest points by pair."""

    state: State
    shape: RodShape
    closest: dict[int, Any]
