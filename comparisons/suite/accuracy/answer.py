"""The answer to a scene at a requested accuracy: the model that the scene requires, and the cheapest setting that suffices."""

from collections.abc import Iterator, Mapping
from time import perf_counter
from typing import Any

import numpy as np

from comparisons.answer import Array, Response
from comparisons.answer.file import SCHEMA
from comparisons.answer.quantities import QUANTITIES, names
from comparisons.frozen import Frozen, Value
from comparisons.models import MODELS, SOLID, TSM, Model, solve
from comparisons.models.model import ModelError, Options
from comparisons.scene import BeamSpec, Scene
from comparisons.suite.accuracy import trials
from tsm.elements import ClosedForm

STOCKY = 0.1
"""Height over length from which a beam is solved as a solid."""
LOOKED_AT = 8
"""Number of states that are searched for the largest strain."""


class Theory(Value):
    """Error of beam theory against the solid body, which no finer mesh of the beam removes."""

    error: float  #: Expected relative error of a contact force.
    slenderness: float  #: Largest h/L.
    strain: float  #: Largest bending strain at a face, ``h kappa/2``.
    kink: float  #: Largest angle by which shear kinks the axis at a contact, ``F/GA`` [rad].


class Answer(Frozen):
    """A response to a stated accuracy."""

    response: Response  #: The response at all load parameters.
    scene: Scene  #: The solved scene, with the chosen elements and meshes.
    model: str  #: The model that was chosen.
    resolution: str  #: Its elements or mesh.
    quantity: str  #: A name in `comparisons.answer.quantities.QUANTITIES`.
    asked: float  #: The error of the quantity that was asked for.
    estimate: float  #: The error that is left, infinite without an estimate.
    beam_theory: Theory | None  #: None for the solid, and where a section's height is not known.
    decisions: tuple[str, ...]  #: Every decision, in order.
    seconds: float  #: Total time [s].

    @property
    def reached(self) -> bool:
        """Whether the solution is complete and its estimate within the accuracy."""
        return self.response.completed and self.estimate <= self.asked

    def as_dict(self) -> dict[str, Any]:
        """Return the choice and the estimates by the names of the JSON file."""
        return {key: getattr(self, key) for key in SCHEMA["properties"]["accuracy"]["properties"]}

    def lines(self) -> Iterator[tuple[str, str]]:
        """Yield the choice and the estimates in words."""
        yield "resolution", f"{self.model}: {self.resolution}"
        mark = "" if self.reached else ", NOT REACHED"
        yield "estimated error", f"{self.estimate:.2g} of {self.quantity}, asked {self.asked:g}{mark}"
        if self.beam_theory is not None:
            what = f"h/L {self.beam_theory.slenderness:.3g}, strain {self.beam_theory.strain:.2g}, shear kink {self.beam_theory.kink:.2g}"
            exceeds = self.beam_theory.error > self.asked
            more = ": more than asked; the solid has no such error" if exceeds else ""
            yield "beam theory itself", f"about {self.beam_theory.error:.1g} ({what}){more}"
        yield "seconds in all", f"{self.seconds:.3f}"


def solve_to(
    scene: Scene,
    accuracy: float,
    quantity: str = "force",
    *,
    model: str | None = None,
    element: str | None = None,
) -> Answer:
    """Solve `scene` to an accuracy with the cheapest model that the scene allows.

    Parameters
    ----------
    scene : Scene
        The scene to solve.
    accuracy : float
        Largest discretisation error over all load parameters: against the exact rod for beams, against the limit of fine meshes for
        the solid. The error of beam theory itself is estimated separately.
    quantity : str
        A name in `comparisons.answer.quantities.QUANTITIES`.
    model : {"tsm", "solid"}, optional
        Model to use; by default the one that the scene requires.
    element : str, optional
        Type of the TSM elements; by default ``exact``.

    Raises
    ------
    ModelError
        If the quantity is unknown, or the model cannot state it or the scene.
    """
    if quantity not in names("path"):
        raise ModelError(f"quantity = {quantity}: must be one of {', '.join(names('path'))}")
    began, said = perf_counter(), list[str]()
    if model is None:
        model, reason = _required(scene, quantity, element)
        said.append(f"{model}: {reason}")
    chosen = _checked(scene, quantity, model, element)
    kind = TSM.element(Options(element=element) if element else chosen.reference or Options())
    if chosen.continuum:
        tried = trials.solid(scene, accuracy, quantity)
    elif isinstance(kind, ClosedForm):
        tried = trials.graded(scene, accuracy, quantity, kind)
    else:
        tried = trials.exact(scene, accuracy, quantity, alone=element is not None)
    for trial in tried:
        said += trial.said
        if trial.estimate <= accuracy:
            break
    response = trial.response or solve(trial.scene, chosen.name, trial.options)
    return Answer(
        response=response,
        scene=trial.scene,
        model=chosen.name,
        resolution=f"{trial.words}, {response.unknowns} unknowns",
        quantity=quantity,
        asked=accuracy,
        estimate=trial.estimate,
        beam_theory=None if chosen.continuum else beam_theory(response, trial.scene),
        decisions=tuple(said),
        seconds=perf_counter() - began,
    )


def _required(scene: Scene, quantity: str, element: str | None) -> tuple[str, str]:
    """Return the model that a scene and a quantity require, and why."""
    if element is not None:
        return TSM.name, f"{element} elements asked for"
    if QUANTITIES[quantity].kind == "mesh":
        return SOLID.name, f"{quantity} is read from its mesh"
    for beam in scene.beams:
        slenderness = max(beam.height_at(0.0), beam.height_at(1.0)) / beam.length
        if slenderness > STOCKY:
            what = f'beam "{beam.name}" is stocky, h/L = {slenderness:.3g} > {STOCKY:g}'
            refused = SOLID.refusal(scene)
            return (SOLID.name, what) if refused is None else (TSM.name, f"{what}, but {refused}")
    rods = "one slender beam" if len(scene.beams) == 1 else f"{len(scene.beams)} slender beams"
    return TSM.name, f"{rods}: exact rods suffice, which one exact element a beam solves"


def _checked(scene: Scene, quantity: str, model: str, element: str | None) -> Model:
    """Return a model with a mesh that can state the scene and the quantity."""
    chosen = MODELS.get(model)
    if chosen is None or not chosen.refinable:
        refinable = " and ".join(name for name, other in MODELS.items() if other.refinable)
        raise ModelError(f"model = {model}: has no resolution to choose; {refinable} have")
    if element is not None and "element" not in chosen.options:
        raise ModelError(f"{model}: element = {element}: not an option of this model")
    unknown = QUANTITIES[quantity].refusal(scene, chosen.continuum)
    refused = chosen.refusal(scene) or (unknown and f"quantity = {quantity}: {unknown}")
    if refused:
        raise ModelError(refused)
    return chosen


def beam_theory(response: Response, scene: Scene) -> Theory | None:
    """Return an estimate of the difference between beams and the solid bodies that they approximate."""
    # plane sections neglect second orders of the face strain h kappa/2 and of h/l, l the length or the radius
    # of an undeformed arc; on KS with h/L = .02, .01, .005 `crossval run thin-beams` prints 8.6e-4, 2.1e-4,
    # 5.7e-5, and this 1.0e-3, 2.5e-4, 6.3e-5
    known = [beam for beam in scene.beams if beam.height is not None]
    count = len(response.load_parameter)
    if not known or not count:
        return None
    steps = np.unique(np.linspace(0, count - 1, LOOKED_AT).astype(int)).tolist()
    slender = max(beam.rectangle_height * max(1.0 / beam.length, abs(beam.curvature)) for beam in known)
    strain = max(_face_strain(beam, response.grid(beam.name, k).point_data) for beam in known for k in steps)
    error = max(strain**2 / 2, slender**2)
    return Theory(error=error, slenderness=slender, strain=strain, kink=trials.shear_kink(response, scene))


def _face_strain(beam: BeamSpec, data: Mapping[str, Array]) -> float:
    """Return the largest bending strain at a face, ``h M/(2 EI)``, by the fields of its grid."""
    moment = data["M"]
    if not beam.tapers:
        return beam.rectangle_height / 2 * float(np.abs(moment).max()) / beam.EI
    parts = np.clip(data["arc"] / beam.length, 0.0, 1.0).tolist()
    compliance = [beam.height_at(part) / (2.0 * beam.stiffness(part)[2]) for part in parts]
    return float(np.abs(moment * compliance).max())
