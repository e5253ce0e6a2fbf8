"""What a model states about a scene, and the records of contacts, supports, events and meshes in it."""

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from comparisons.frozen import Frozen, Value
from comparisons.scene import Scene

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

OPEN = "open"
SLIPS = {0: "sticks", 1: "slips to the end", -1: "slips to the start"}
"""The states of a closed contact with friction, by the sign of the slip."""
CONTACT_STATES = {OPEN: "#BBBBBB", SLIPS[0]: "#0072B2", SLIPS[1]: "#E69F00", SLIPS[-1]: "#CC79A7"}
"""The states of a contact with friction, and the colour of each in pictures."""


class ContactHistory(Frozen):
    """One contact pair over the load parameters."""

    force: Array  #: Magnitude of the contact force, shape (s,).
    arc_position: Array  #: Distance along the undeformed axis from the start (s,); nan where open.
    gap: Array  #: Gap (s,): 0 or minus the penetration of a penalty where closed, positive or nan where open.
    slip_off: float = np.nan  #: Load parameter at which the node left over the free end; nan if it did not.
    vector: Array | None = None  #: The contact force on the beam (s, 2), where the model states it.
    friction: "FrictionHistory | None" = None  #: What friction does; None without friction.


class FrictionHistory(Frozen):
    """Friction of one contact pair over the load parameters, 0 where the pair is open."""

    tangential: Array  #: Force on the beam along its tangent, positive from start to end, shape (s,).
    normal: Array  #: Force on the beam across its tangent, away from the node (s,).
    slip: Ints  #: Sign of the slip rate (s,): +1 towards the end, -1 to the start, 0 in stick.
    dissipated: Array  #: Energy dissipated since the start (s,); nan where the model does not state it.

    def states(self, force: Array) -> list[str]:
        """Return the state of the contact at every load parameter, a key of `CONTACT_STATES`; `force` (s,) is the contact force."""
        return [SLIPS[int(slip)] if size else OPEN for slip, size in zip(self.slip, force, strict=True)]


class SupportHistory(Frozen):
    """Force and moment of a support on the end of its beam."""

    force: Array  #: Force of the support, shape (s, 2), zero in a free direction.
    moment: Array  #: Moment about the supported end (s,), zero where the rotation is free.


class ContactEvent(Value):
    """A change of the contact, located by the model; in a pass-through the contact moves on to the next element."""

    kind: str  #: ``touch``, ``release``, ``slip-off``, ``slip``, ``stick`` or ``pass-through``.
    load_parameter: float  #: Load parameter of the event.
    pair: str  #: ``node->beam``.
    element: int  #: Number of the element in contact, from 0 at the beam's start; the next one after a pass-through.
    arc_position: float  #: Distance along the undeformed axis from the beam's start.
    force: float  #: Contact force before the event.
    released: float  #: Strain energy less work of the loads that is released in the jump after a slip-off.
    #: Number of the stage, from 1; an event as a stage begins belongs to it if it happens because the load goes on.
    stage: int = 1


class CriticalPoint(Frozen):
    """A point of the path where the tangent is singular, located by the model."""

    kind: str  #: ``limit point`` or ``bifurcation``.
    load_parameter: float  #: Load parameter of the point.
    mode: dict[str, Array]  #: Displacements of the axes (m, 2) in the buckling mode by beam, the largest 1.


class Deformation(Frozen):
    """The largest deformation of any element, for the check that the element's kinematics still approximate it.

    The bend of an element in contact is at least ``F min(a, b) l/EI``, that under a constant moment of the contact force, with the
    distances a and b of the contact from the ends of the element.
    """

    load_parameter: Array  #: Load parameters of the n entries, of beams all accepted steps, shape (n,).
    turn: Array  #: Largest angle by which an element bends between its ends (n,) [rad].
    strain: Array  #: Largest section or contact force over the smaller of EA and GA (n,); 0 without small strains.
    bearable: float  #: Bend up to which the first neglected term is at most a fifth of the force [rad].


class Grid(Frozen):
    """The mesh of a beam in its undeformed state with fields at its points."""

    points: Array  #: Undeformed positions, shape (n, 2).
    cells: dict[str, Ints]  #: Points of the cells (e, k) by VTK type in its order, as ``quad9``.
    #: Fields (n,) or (n, c); always ``displacement`` and ``deformed`` (n, 2).
    point_data: dict[str, Array]


class Sections(Frozen):
    """Section forces along a beam at stations from its start to its end; a place where they jump is stated twice, from both sides."""

    arc: Array  #: Distance along the undeformed axis, not falling, shape (m,).
    N: Array  #: Axial force, positive in tension (m,).
    V: Array  #: Shear force, positive to the left of the beam's direction on the part before the section (m,).
    M: Array  #: Bending moment on the part before the section, anticlockwise (m,).


def not_kept(*_: object) -> NoReturn:
    """Raise: a stored answer has no mesh, and one without a load parameter has no axis."""
    raise NotImplementedError("a stored response has no mesh")


class Answer(Frozen):
    """What one model states about one scene at s load parameters. What it cannot state is None or empty."""

    model: str = ""  #: Name of the model.
    scene: str = ""  #: Name of the scene.
    status: str  #: Status with which the run ended.
    message: str  #: Its sentence.
    load_parameter: Array = field(default_factory=lambda: np.empty(0))  #: The accepted load parameters (s,).
    contacts: dict[str, ContactHistory] = field(default_factory=dict)  #: By pair, ``node->beam``.
    supports: dict[str, SupportHistory] = field(default_factory=dict)  #: By supported end, ``beam.start``.
    springs: dict[str, SupportHistory] = field(default_factory=dict)  #: Springs to the ground, by end.
    #: Position of the tip of each beam (s, 2), the end with fewer held components; at equality the beam's ``end``.
    tips: dict[str, Array] = field(default_factory=dict)
    #: Newton iterations since the previous load parameter (s,), rejected steps included.
    newton_iterations: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    cutbacks: int = 0  #: Rejected steps.
    unknowns: int = 0  #: Size of the system of equations.
    wall_seconds: float = np.nan  #: Time of the solution alone [s].
    #: ``axis_line(beam, k)``: arc length (m,) and deformed positions (m, 2) of an axis at load parameter k. A stored response has
    #: `comparisons.answer.axis.SampledAxes` here.
    axis_line: Callable[[str, int], tuple[Array, Array]] = not_kept
    grid: Callable[[str, int], Grid] = not_kept  #: ``grid(beam, k)``; not of a stored response.
    sections: Callable[[str, int], Sections] | None = None  #: ``sections(beam, k)``; not stored.
    events: tuple[ContactEvent, ...] | None = None  #: Contact events in their order.
    continuum: bool = False  #: Whether the model is a two-dimensional body and not a rod.
    outside: bool = False  #: Whether a program of others gave the answer, and it balances to its accuracy.
    #: Estimated error of the integration inside exact elements: the largest of positions over the longest beam, of angles, and of
    #: forces over ``EI/L^2``.
    integration_error: float = 0.0
    #: Force to which the reactions balance, where that is more than the round-off of a rod.
    round_off: float = 0.0
    work: Array | None = None  #: Work of pins, supports and loads since the start (s,), with friction.
    deformation: Deformation | None = None  #: Deformation of the most deformed element.
    #: Negative eigenvalues of the second variation of the energy under the supports and closed contacts (s,): 0 where the
    #: equilibrium is stable, -1 where it is not defined.
    index: Ints | None = None
    critical: tuple[CriticalPoint, ...] = ()  #: Critical points that the model met.
    certificate: Any = None  #: The `comparisons.referee.Certificate` of the answer, None if it is not judged.
    #: Sum of the tangential contact forces on a beam (s,), positive away from its clamp, by beam: see `comparisons.answer.material`.
    material_force: Mapping[str, Array] = field(default_factory=dict)
    reported_success: bool = False  #: Whether the model itself reported success, whatever the checks found.
    setting: str = ""  #: Elements or mesh of the model, as ``mixed 20``.
    definition: Scene | None = None  #: The scene itself; None for a response that was read from a file.

    @property
    def named(self) -> str:
        """Name of the model and, where it is known, its setting, as ``tsm mixed 20``."""
        return f"{self.model} {self.setting}".rstrip()

    @property
    def ended(self) -> str:
        """How the solution ended: its status and the sentence."""
        return f"{self.status}: {self.message}"

    def stop(self, scene: Scene) -> str:
        """Return how the solution ended, and at how many of a scene's load parameters."""
        return f"{self.ended}; {len(self.load_parameter)} of {len(scene.times)} load parameters reached"

    @property
    def completed(self) -> bool:
        """Whether the solution is complete, and neither a check nor the referee refused it."""
        return self.status == "COMPLETED"

    @property
    def false_success(self) -> bool:
        """Whether the model reported a complete solution that a check or the referee refused: it said success and was wrong."""
        return self.reported_success and not self.completed

    @property
    def stage(self) -> Ints:
        """Number of the stage, from 1, at every load parameter (s,); at a boundary, the stage that ends there."""
        return np.maximum(np.ceil(self.load_parameter), 1.0).astype(np.int64)

    @property
    def iterations(self) -> int:
        """Newton iterations of the whole path."""
        return int(self.newton_iterations.sum())
