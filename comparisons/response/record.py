"""The response of a model to a scene, and the records of contacts, supports, events and meshes in it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from comparisons.referee.certificate import Certificate
    from comparisons.scene import Scene

Array = NDArray[np.float64]


OPEN = "open"
SLIPS = {0: "sticks", 1: "slips to the end", -1: "slips to the start"}
"""The states of a closed contact with friction, by the sign of the slip."""
CONTACT_STATES = {OPEN: "#BBBBBB", SLIPS[0]: "#0072B2", SLIPS[1]: "#E69F00", SLIPS[-1]: "#CC79A7"}
"""The states of a contact with friction, and the colour of each in pictures."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactHistory:
    """One contact pair over the load parameters.

    Attributes
    ----------
    force : ndarray, shape (s,)
        Magnitude of the contact force.
    arc_position : ndarray, shape (s,)
        Distance along the undeformed axis from the beam's start; nan where the pair is open.
    gap : ndarray, shape (s,)
        Zero where closed, or minus the penetration for a penalty model; positive or nan where open.
    compliance : float or ndarray, shape (s,)
        Penetration per normal force of a penalty model, ``gap = -compliance force``.
    slip_off : float
        Load parameter at which the node left the beam over its free end; nan if it did not.
    vector : ndarray, shape (s, 2), optional
        The contact force on the beam, where the model states it.
    friction : FrictionHistory, optional
        What friction does; None without friction.
    """

    force: Array
    arc_position: Array
    gap: Array
    compliance: float | Array = 0.0
    slip_off: float = np.nan
    vector: Array | None = None
    friction: "FrictionHistory | None" = None


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionHistory:
    """Friction of one contact pair over the load parameters.

    Attributes
    ----------
    tangential, normal : ndarray, shape (s,)
        Force on the beam along its tangent, positive from start to end, and across it, away from the node; 0 where the pair is open.
    slip : ndarray of int, shape (s,)
        Sign of the slip rate: +1 where the node slips towards the beam's end, -1 towards its start, 0 in stick and where the pair is open.
    dissipated : ndarray, shape (s,)
        Energy that friction has dissipated since the start; nan where the model does not state it.
    """

    tangential: Array
    normal: Array
    slip: NDArray[np.int64]
    dissipated: Array

    def states(self, force: Array) -> list[str]:
        """Return the state of the contact at every load parameter, a key of `CONTACT_STATES`; `force` (s,) is the contact force."""
        return [SLIPS[int(slip)] if size else OPEN for slip, size in zip(self.slip, force, strict=True)]


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportHistory:
    """Force and moment of a support on the end of its beam.

    Attributes
    ----------
    force : ndarray, shape (s, 2)
        Force of the support, zero in a free direction.
    moment : ndarray, shape (s,)
        Moment about the supported end, zero where the rotation is free.
    """

    force: Array
    moment: Array


@dataclass(frozen=True, kw_only=True)
class ContactEvent:
    """A change of the contact, located by the model.

    Attributes
    ----------
    kind : str
        ``touch``, ``release``, ``slip-off``, ``slip``, ``stick`` or ``pass-through``. In a pass-through the contact point passes a beam node and moves on to the
        next element.
    load_parameter : float
        Load parameter of the event.
    pair : str
        ``node->beam``.
    element : int
        Number of the element in contact, from 0 at the beam's start. After a pass-through, number of the next element.
    arc_position : float
        Distance along the undeformed axis from the beam's start.
    force : float
        Contact force before the event.
    released : float
        Potential energy (strain energy less the work of the loads) that is released in the jump after a slip-off.
    stage : int
        Number of the stage, from 1. An event at the load parameter at which a stage begins belongs to that stage if it happens because
        the load goes on.
    """

    kind: str
    load_parameter: float
    pair: str
    element: int
    arc_position: float
    force: float
    released: float
    stage: int = 1


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """A point of the path where the tangent is singular, located by the model.

    Attributes
    ----------
    kind : str
        ``limit point`` or ``bifurcation``.
    load_parameter : float
        Load parameter of the point.
    mode : dict of ndarray, shape (m, 2)
        Displacements of the beams' axes in the buckling mode; the largest is 1.
    """

    kind: str
    load_parameter: float
    mode: dict[str, Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Deformation:
    """The largest deformation of any element, for the check that the element's kinematics still approximate it.

    Attributes
    ----------
    load_parameter : ndarray, shape (n,)
        Load parameters of the entries. Beams have one for each accepted step, also between the load parameters of the scene.
    turn : ndarray, shape (n,)
        Largest angle by which an element bends between its ends [rad]. For an element in contact the angle is at least
        ``F min(a, b) l/EI``, the bend under a constant moment of the contact force, with the distances a and b of the contact from the
        ends of the element.
    strain : ndarray, shape (n,)
        Largest section force or contact force over the smaller of EA and GA, for elements with small-strain theory; else zero.
    bearable : float
        Largest bend [rad] for which the element is an approximation: the first neglected term is then a fifth of the force.
    """

    load_parameter: Array
    turn: Array
    strain: Array
    bearable: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """A mesh in its undeformed state with fields at its points.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        Undeformed positions.
    cells : dict of ndarray, shape (e, k)
        Points of the cells by VTK type, in VTK's order: ``line``, ``quad9``.
    point_data : dict of ndarray, shape (n,) or (n, c)
        Fields; always there are ``displacement`` and ``deformed`` (n, 2), and ``beam`` (n,), the number of the beam in the scene.
    """

    points: Array
    cells: dict[str, NDArray[np.int64]]
    point_data: dict[str, Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sections:
    """Section forces along a beam at stations from its start to its end; a place where they jump is stated twice, from both sides.

    Attributes
    ----------
    arc : ndarray, shape (m,)
        Distance along the undeformed axis, not falling.
    N, V : ndarray, shape (m,)
        Axial force, positive in tension, and shear force, positive to the left of the beam's direction on the part before the section.
    M : ndarray, shape (m,)
        Bending moment on the part before the section, anticlockwise.
    """

    arc: Array
    N: Array
    V: Array
    M: Array


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Response:
    """The response of one model to one scene at s load parameters.

    It prints itself in a line, and in a notebook as the page that ``crossval solve`` prints.

    Attributes
    ----------
    model, scene : str
        Names of the model and of the scene.
    status, message : str
        Status with which the run ended, and its sentence.
    completed : bool
        Whether the model reports a complete solution.
    continuum : bool
        Whether the model is a two-dimensional body and not a rod.
    outside : bool
        Whether a program of others gave the answer, whose forces balance to its own accuracy only.
    load_parameter : ndarray, shape (s,)
        The accepted load parameters of the scene.
    contacts : dict of ContactHistory
        By pair, ``node->beam``; empty without contact.
    events : tuple of ContactEvent or None
        Contact events in their order; None for a model that does not locate events.
    supports : dict of SupportHistory
        By supported end, ``beam.start``, in the order of `Scene.all_supports`.
    springs : dict of SupportHistory
        Force and moment of the springs to the ground on the structure, by the end that a ``[[spring]]`` names, ``beam.end``.
    tips : dict of ndarray, shape (s, 2)
        Position of the tip of each beam, the end with fewer held components. At equality the tip is the beam's ``end``.
    newton_iterations : ndarray of int, shape (s,)
        Newton iterations since the previous load parameter, rejected steps included.
    cutbacks, unknowns : int
        Rejected steps; size of the system of equations.
    wall_seconds : float
        Time of the solution alone.
    axis_line : callable
        ``axis_line(beam, k)``: arc length (m,) and deformed positions (m, 2) of a beam's axis at load parameter k. A stored
        response has `comparisons.response.axis.SampledAxes` here.
    grid : callable
        ``grid(k)``: the model's mesh and fields at load parameter k; a response that was stored has none.
    round_off : float
        Force to which the reactions balance, where that is more than the round-off of a rod [force].
    integration_error : float
        Estimated error of the integration inside exact elements: the largest error of positions over the longest beam, of angles,
        and of forces over ``EI/L^2``.
    work : ndarray, shape (s,), optional
        Work of pins, supports and loads since the start, of a model that states it for a scene with friction.
    deformation : Deformation, optional
        Deformation of the most deformed element; None for models without approximating elements.
    index : ndarray of int, shape (s,), optional
        Number of negative eigenvalues of the second variation of the energy, under the supports and closed contacts. It is 0 where
        the equilibrium is stable, and -1 where it is not defined. None for a model that does not compute it.
    critical : tuple of CriticalPoint
        Critical points that the model met.
    certificate : Certificate, optional
        Verdict of the referee on the answer.
    material_force : mapping of ndarray, shape (s,)
        Sum of the tangential contact forces on a beam, positive away from its clamp, by beam: see `comparisons.response.material`. Empty
        without such a clamp, and for a solid of another program.
    reported_success : bool
        Whether the model itself reported a complete solution, whatever the checks found.
    sections : callable, optional
        ``sections(beam, k)``: the section forces of a beam at load parameter k. None for a model that does not state them, and for a
        stored response.
    setting : str
        Elements or mesh of the model, as ``mixed 20``; empty for a model without settings.
    definition : Scene, optional
        The scene itself. None for a response that was read from a file.
    """

    model: str
    scene: str
    status: str
    message: str
    completed: bool
    load_parameter: Array
    contacts: dict[str, ContactHistory]
    supports: dict[str, SupportHistory]
    tips: dict[str, Array]
    newton_iterations: NDArray[np.int64]
    cutbacks: int
    unknowns: int
    wall_seconds: float
    axis_line: Callable[[str, int], tuple[Array, Array]] = field(repr=False)
    grid: Callable[[int], Grid] = field(repr=False)
    events: tuple[ContactEvent, ...] | None = None
    continuum: bool = False
    outside: bool = False
    integration_error: float = 0.0
    round_off: float = 0.0
    work: Array | None = None
    deformation: Deformation | None = None
    index: NDArray[np.int64] | None = None
    critical: tuple[CriticalPoint, ...] = ()
    certificate: "Certificate | None" = None
    material_force: Mapping[str, Array] = field(default_factory=dict)
    reported_success: bool = False
    springs: dict[str, SupportHistory] = field(default_factory=dict)
    sections: Callable[[str, int], Sections] | None = None
    setting: str = ""
    definition: "Scene | None" = None

    def __repr__(self) -> str:
        reached = len(self.load_parameter)
        last = f", the last {self.load_parameter[-1]:g}" if reached else ""
        named = " ".join(filter(None, (self.model, self.setting)))
        return f"<Response {self.scene} by {named}: {self.status}, {reached} load parameters{last}>"

    def _repr_html_(self) -> str:
        from comparisons.response.page import html

        return html(self)

    def page(self) -> str:
        """Return the page that ``crossval solve`` prints: status, reactions, contacts, extremes and events."""
        from comparisons.response.page import text

        return text(self)

    def table(self) -> dict[str, NDArray[Any]]:
        """Return the histories by name, each of shape (s,): what ``pandas.DataFrame`` takes. See `comparisons.response.table`."""
        from comparisons.response.table import table

        return table(self)

    def plot(self, scene: "Scene | None" = None) -> "Figure":
        """Return a picture: deformed shape, section forces along each beam, and forces over the load parameter; needs matplotlib.

        Parameters
        ----------
        scene : Scene, optional
            The scene that was solved, for a response that was read from a file.
        """
        from comparisons.show.answer import picture

        return picture(self, scene)

    @property
    def false_success(self) -> bool:
        """Whether the model reported a complete solution that a check or the referee refused: it said success and was wrong."""
        return self.reported_success and not self.completed

    @property
    def stage(self) -> NDArray[np.int64]:
        """Number of the stage, from 1, at every load parameter (s,); at a boundary, the stage that ends there."""
        return np.maximum(np.ceil(self.load_parameter), 1.0).astype(np.int64)

    @property
    def iterations(self) -> int:
        """Newton iterations of the whole path."""
        return int(self.newton_iterations.sum())


def unanswered(status: str, message: str) -> Response:
    """Return an empty response, without load parameters and beams, for a model that gave no answer."""

    def nothing(*_: object) -> NoReturn:
        raise AssertionError("no load parameter was reached")

    return Response(
        model="",
        scene="",
        status=status,
        message=message,
        completed=False,
        load_parameter=np.empty(0),
        contacts={},
        supports={},
        tips={},
        newton_iterations=np.empty(0, dtype=np.int64),
        cutbacks=0,
        unknowns=0,
        wall_seconds=np.nan,
        axis_line=nothing,
        grid=nothing,
    )
