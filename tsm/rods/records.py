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
    """Constants of the elements, one for every segment.

    Attributes
    ----------
    place : Layout
        The segments.
    dofs : ndarray of int, shape (9, s)
        Degrees of freedom of the elements.
    angles : tuple of 2 ndarray, shape (s,)
        Angles of the undeformed elements at both ends.
    length : ndarray, shape (s,)
        Their length.
    flexibility : Flexibility
        Flexibilities of the elements.
    """

    place: Layout
    dofs: Array
    angles: tuple[Array, Array]
    length: Array
    flexibility: Flexibility


class Section(NamedTuple):
    """Flexibilities 1/EA, 1/GA, 1/EI of one section, and the natural curvature there."""

    stretch: float
    shear: float
    bend: float
    curvature: float


class Entry(NamedTuple):
    """Where the segments of a state begin and end.

    Attributes
    ----------
    place : Layout
        Elements of the segments.
    segments : rod.Segments or VaryingSegments
        Force, length and angles inside.
    field : rod.Field
        The rod's equations there.
    start, end, moment : ndarray, shape (s, 1)
        Angles at both ends, moment at the start.
    gain : ndarray, shape (s,)
        Moment at the end minus moment at the start.
    vector : ndarray, shape (2, s)
        Vector from start to end.
    rubbing : dict of Rubbing
        Contacts with friction, by pair.
    load_parameter : float
        Load parameter.
    """

    place: Layout
    segments: Any
    field: Field
    start: Array
    end: Array
    moment: Array
    gain: Array
    vector: Array
    rubbing: dict[int, Rubbing]
    load_parameter: float


class RodBalance(NamedTuple):
    """Residual of the exact elements.

    Attributes
    ----------
    entry : Entry
        The segments.
    arrival : rod.Arrival
        Their residuals.
    nodal : ndarray, shape (9, r)
        Forces on node i, arrival at node j, forces on node j.
    contacts : dict of list
        By pair: the rows of position (2), direction and arrival of the angle.
    tangents : dict of tuple
        By pair: the axis' tangent vectors before and after the contact.
    inside : float
        Largest residual inside [rad].
    """

    entry: Entry
    arrival: Arrival
    nodal: Array
    contacts: dict[int, list[Any]]
    tangents: dict[int, tuple[rod.Tangent, rod.Tangent]]
    inside: float

    @property
    def ends(self) -> Array:
        """Forces and moments at both ends of the elements, shape (6, r)."""
        ends: Array = self.nodal[[0, 1, 2, 6, 7, 8]]
        return ends


class CutElement(NamedTuple):
    """Tangent of an element with contacts; with loads along elements one more column, the load parameter, stands before the last.

    Attributes
    ----------
    element : int
        Counted over the exact elements.
    pairs : tuple of int
        Its contact pairs in order of arc position.
    tangent : ndarray, shape (9 + 4 k, 10 + 4 k)
        Tangent over the unknowns of the element, then of the contacts. The last column is the contribution of the inner residual.
    inputs : ndarray, shape (k + 1, 7, 10 + 4 k)
        Inputs of the segments by the same unknowns.
    slip : dict of ndarray, shape (10 + 4 k,)
        By pair with friction: its slip rate as a linear form over the same unknowns.
    """

    element: int
    pairs: tuple[int, ...]
    tangent: Array
    inputs: Array
    slip: dict[int, Array]


class RodTangent(NamedTuple):
    """Tangent of the exact elements.

    Attributes
    ----------
    condensed_residual : ndarray, shape (9, r)
        Contribution of the inner residual to the residual after the inner unknowns are eliminated.
    tangent : ndarray, shape (81, r)
        Derivative of the residual, row by row.
    cut : tuple of CutElement
        Tangents of the elements with contacts. The part without contacts is in the arrays above too.
    inner : ndarray, shape (s, p, 7)
        Derivatives of the angles inside by the inputs of the segments.
    transfer : ndarray, shape (s, 4, 7)
        Derivatives of their outputs, see `rod.Condensed`.
    """

    condensed_residual: Array
    tangent: Array
    cut: tuple[CutElement, ...]
    inner: Array
    transfer: Array


class Memo(NamedTuple):
    """Cache of the last deflected axis, with its state and the closest points by pair."""

    state: State
    shape: RodShape
    closest: dict[int, Any]
