"""Results: histories over the accepted load parameters."""

from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from fem_reference.path.critical import CriticalPoint
from fem_reference.path.events import ContactEvent
from fem_reference.statement.arrays import Floats, Ints
from fem_reference.statement.status import Status
from fem_reference.system.model import Model
from fem_reference.system.state import State

OUTLINES = {"quad": [0, 1, 2, 3], "quad9": [0, 4, 1, 5, 2, 6, 3, 7]}
"""Nodes around an element in their order, by meshio cell type."""


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
        admit, ``(s,)``. Zero is stable. -1 if a closed contact without force makes the index ambiguous, or if a contact
        slips: then stability is not judged. A contact that sticks is held at its material point.
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
        The discrete model, and the accepted states.
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
        reached = len(self.load_parameter)
        last = f", the last {self.load_parameter[-1]:g}" if reached else ""
        unknowns = f"{self.unknowns} unknowns, {self.newton_iterations.sum()} iterations"
        return f"<Result {self.status.name}: {reached} load parameters{last}; {unknowns}>"

    def _repr_html_(self) -> str:
        """Return the status and the last value of every column as HTML."""
        last = [(escape(name), values[-1]) for name, values in self.table().items() if len(values)]
        rows = [f"<tr><td>{name}</td><td>{value:.6g}</td></tr>" for name, value in last]
        heading = escape(f"{self.status.name}: {self.message}")
        return f"<h4>{heading}</h4><table><tbody>{''.join(rows)}</tbody></table>"

    def table(self) -> dict[str, Any]:
        """Return the histories by name, each of shape ``(s,)``: what ``pandas.DataFrame`` takes.

        ``load_parameter``, ``newton_iterations``, ``index``; ``{pin->strip}.force``, ``.force_x``, ``.force_y``, ``.normal_force``,
        ``.tangential_force``, ``.arc_position``, ``.gap``, ``.slip``, ``.dissipated``; ``{strip}.start.force_x``, ``.force_y`` and
        ``.moment`` of each supported end; ``{strip}.tip_x``, ``.tip_y``.
        """
        columns: dict[str, Any] = {"load_parameter": self.load_parameter}

        def vectors(name: str, values: Floats) -> None:
            columns[f"{name}_x"], columns[f"{name}_y"] = values.T

        for pair, contact in self.contacts.items():
            columns[f"{pair}.force"] = contact.force
            vectors(f"{pair}.force", contact.vector)
            for name in ("normal_force", "tangential_force", "arc_position", "gap", "slip", "dissipated"):
                columns[f"{pair}.{name}"] = getattr(contact, name)
        for node, support in self.supports.items():
            vectors(f"{node}.force", support.force)
            columns[f"{node}.moment"] = support.moment
        for strip, tip in self.tips.items():
            vectors(f"{strip}.tip", tip)
        return {**columns, "index": self.index, "newton_iterations": self.newton_iterations}

    def plot(self, axes: Any = None, shown: int = 3) -> Any:
        """Draw the deformed meshes at `shown` of the accepted load parameters, evenly spread, with the pins; needs matplotlib.

        ``axes``: matplotlib's axes; the current ones of pyplot if not given.
        ``shown``: number of load parameters.
        """
        from matplotlib.collections import PolyCollection
        from matplotlib.patches import Circle

        if axes is None:
            import matplotlib.pyplot as plt

            axes = plt.gca()
        reached = len(self.load_parameter)
        steps = np.unique(np.linspace(0, reached - 1, shown if reached else 0).round().astype(int))
        for k, colour in [(-1, "0.8"), *((int(k), "C0") for k in steps)]:
            points = self.mesh_points + (self.displacement[k] if k >= 0 else 0.0)
            faint = 0.35 + 0.65 * (k + 1) / reached if k >= 0 else 1.0
            for kind, cells in self.mesh_cells.items():
                outlines = list(points[cells[:, OUTLINES[kind]]])
                drawn = PolyCollection(
                    outlines, facecolors="none", edgecolors=colour, linewidths=0.4, alpha=faint
                )
                axes.add_collection(drawn)
            axes.update_datalim(points)
        for pin in self.model.problem.pins:
            axes.plot(*np.array(pin.path).T, color="0.5", linewidth=0.8, linestyle=":")
            places = [pin.position(float(self.load_parameter[k])) for k in steps]
            for place in places:
                axes.add_patch(Circle((place[0], place[1]), pin.radius, color="black", fill=False))
            axes.plot(*np.array(places).reshape(-1, 2).T, ".", color="black", label=pin.name)
        axes.set_aspect("equal", adjustable="datalim")
        axes.autoscale_view()
        axes.set(xlabel="x", ylabel="y", title=self.status.name)
        if self.model.problem.pins:
            axes.legend(loc="best", fontsize="small")
        return axes


class SolveError(RuntimeError):
    """The solution stopped early; ``result`` is the incomplete solution."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.message)
        self.result = result
