"""What a solution is: histories over the accepted load parameters."""

from dataclasses import dataclass, field

from fem_reference.arrays import Floats, Ints
from fem_reference.critical import CriticalPoint
from fem_reference.model import Model
from fem_reference.state import State
from fem_reference.status import Status


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactHistory:
    """History of one contact.

    Parameters
    ----------
    force
        Magnitude of the contact force, ``(s,)`` [N].
    arc_position
        Distance of the contact along the undeformed axis from the strip's start, nan where open, ``(s,)`` [m].
    gap
        Signed distance, minus the penetration where closed, ``(s,)`` [m].
    vector
        Force on the strip, ``(s, 2)`` [N].
    slip_off
        Load parameter at which the contact first left the strip over an end, nan if it did not.
    """

    force: Floats
    arc_position: Floats
    gap: Floats
    vector: Floats
    slip_off: float


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportHistory:
    """History of one clamp: what it exerts on the strip.

    Parameters
    ----------
    force
        Force, ``(s, 2)`` [N].
    moment
        Moment about the clamped point, anticlockwise positive, ``(s,)`` [N m].
    """

    force: Floats
    moment: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Result:
    """A solution, or as much of it as was reached, in the global frame.

    Parameters
    ----------
    status
        ``Status.COMPLETED``, or why the solution stopped.
    message
        The same as one sentence with its numbers.
    load_parameter
        Accepted load parameters, ``(s,)``.
    reached
        Last accepted load parameter, sub-steps included, or that of the event at which the path ends.
    contacts, supports, tips
        Histories by pair ``"pin->strip"``, by strip, and the section mean of the free end ``(s, 2)`` by strip [m].
    newton_iterations
        Linear solutions since the load parameter before, sub-steps and cut-backs included, ``(s,)``.
    cutbacks
        Number of attempts that were given up.
    substeps
        Accepted states in all, those between the load parameters included.
    index
        Number of negative eigenvalues of the energy's Hessian over the displacements that supports and closed contacts
        admit, ``(s,)``: zero is stable; -1 where a contact is closed without force and the two sides differ.
    critical
        Critical points on the way, those between load parameters included.
    unknowns
        Number of unclamped degrees of freedom.
    wall_seconds
        Time of the solution, without building the model [s].
    mesh_points
        Reference positions of the nodes, ``(n, 2)`` [m].
    mesh_cells
        Nodes of the elements ``(e, k)`` by VTK's type, ``"quad"`` or ``"quad9"``, in VTK's order.
    displacement
        Nodal displacements, ``(s, n, 2)`` [m].
    model, states
        The discrete model and its accepted states, each strip in its own frame.
    """

    status: Status
    message: str
    load_parameter: Floats
    reached: float
    contacts: dict[str, ContactHistory]
    supports: dict[str, SupportHistory]
    tips: dict[str, Floats]
    newton_iterations: Ints
    cutbacks: int
    substeps: int
    index: Ints
    critical: tuple[CriticalPoint, ...]
    unknowns: int
    wall_seconds: float
    mesh_points: Floats = field(repr=False)
    mesh_cells: dict[str, Ints] = field(repr=False)
    displacement: Floats = field(repr=False)
    model: Model = field(repr=False)
    states: tuple[State, ...] = field(repr=False)


class SolveError(RuntimeError):
    """A solution that stopped early; ``result`` holds what was reached."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.message)
        self.result = result
