"""Results: histories over the accepted load parameters."""

from dataclasses import dataclass
from typing import Any

from fem_reference import present
from fem_reference.arrays import Floats, Ints
from fem_reference.critical import CriticalPoint
from fem_reference.events import ContactEvent
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
    normal_force, tangential_force
        Components of the force, ``(s,)`` [N]: the compression, and the friction on the strip along its direction from start
        to end.
    arc_position
        Undeformed axial coordinate of the contact; nan while open, ``(s,)`` [m].
    gap
        Signed distance of node and strip, negative in penetration, ``(s,)`` [m].
    vector
        Contact force on the strip in the global frame, ``(s, 2)`` [N].
    slip_off
        Load parameter at which the contact first slipped off an end of the strip; nan without slip-off.
    direction
        Direction in which the node slips along the strip, 1 or -1, ``(s,)``; 0 where it sticks, is open or has no friction.
    slip
        Sum of the slips, along the strip positive, ``(s,)`` [m].
    dissipated
        Energy that friction has dissipated, ``(s,)`` [J].
    events
        Changes of the contact, in order.
    """

    force: Floats
    normal_force: Floats
    tangential_force: Floats
    arc_position: Floats
    gap: Floats
    vector: Floats
    slip_off: float
    direction: Ints
    slip: Floats
    dissipated: Floats
    events: tuple[ContactEvent, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportHistory:
    """History of the reaction of one clamp or support on its strip.

    Parameters
    ----------
    force
        Reaction force in the global frame, ``(s, 2)`` [N].
    moment
        Reaction moment, anticlockwise positive, about the middle of the clamped edge or the section's mean, ``(s,)`` [N m].
    """

    force: Floats
    moment: Floats


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Result:
    """A complete or incomplete solution, in the global frame. It prints itself in a line and draws itself.

    Parameters
    ----------
    status
        ``Status.COMPLETED``, or the reason why the solution stopped.
    message
        The status as one sentence with its numbers.
    load_parameter
        Accepted load parameters, ``(s,)``.
    reached
        Load parameter of the last accepted state, including sub-steps, or of the event that ends the path.
    contacts, supports, tips
        Contact histories by pair ``"pin->strip"``, reactions by supported end ``"strip.start"``, and positions ``(s, 2)`` of
        section means by strip: of the end, or of the start where only the end is clamped [m].
    springs
        Forces and moments of the springs on their strips by end ``"strip.start"``.
    newton_iterations
        Number of linear solutions for each load parameter, including sub-steps and rejected attempts, ``(s,)``.
    cutbacks
        Total number of rejected attempts.
    substeps
        Total number of accepted states, including sub-steps.
    index
        Number of negative eigenvalues of the energy's Hessian over the displacements that supports and closed contacts
        admit, ``(s,)``. Zero is stable. -1 if a closed contact without force makes the index ambiguous, or if a closed
        contact has friction: then stability is not judged.
    critical
        Critical points on the path, including sub-steps.
    unknowns
        Number of unknown displacements.
    round_off
        Round-off of a sum of nodal forces: reactions balance to this force [N].
    wall_seconds
        Wall time of the solution without model generation [s].
    mesh_points
        Reference positions of the nodes, ``(n, 2)`` [m].
    mesh_cells
        Nodes of the elements ``(e, k)`` by meshio cell type, ``"quad"`` or ``"quad9"``, in VTK's order.
    displacement
        Nodal displacements, ``(s, n, 2)`` [m].
    model, states
        The discrete model, and the accepted states with displacements in the frames of the strips.
    """

    status: Status
    message: str
    load_parameter: Floats
    reached: float
    contacts: dict[str, ContactHistory]
    supports: dict[str, SupportHistory]
    tips: dict[str, Floats]
    springs: dict[str, SupportHistory]
    newton_iterations: Ints
    cutbacks: int
    substeps: int
    index: Ints
    critical: tuple[CriticalPoint, ...]
    unknowns: int
    round_off: float
    wall_seconds: float
    mesh_points: Floats
    mesh_cells: dict[str, Ints]
    displacement: Floats
    model: Model
    states: tuple[State, ...]

    def __repr__(self) -> str:
        return present.line(self)

    def _repr_html_(self) -> str:
        return present.html(self)

    def table(self) -> dict[str, Any]:
        """Return the histories as columns of equal length, what data frames take: see `fem_reference.present.table`."""
        return present.table(self)

    def plot(self, axes: Any = None, shown: int = present.SHOWN) -> Any:
        """Draw the deformed meshes and the pins: see `fem_reference.present.plot`."""
        return present.plot(self, axes, shown)


class SolveError(RuntimeError):
    """The solution stopped early; ``result`` is the incomplete solution."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.message)
        self.result = result
