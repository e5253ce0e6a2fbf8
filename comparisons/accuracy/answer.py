"""The answer to a scene at a requested accuracy, with the decisions that led to it."""

from dataclasses import dataclass
from typing import Any

from comparisons.response import Response
from comparisons.scene import Scene


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretised:
    """A response and the error that its discretisation is estimated to leave.

    Attributes
    ----------
    response : Response
        Response at all load parameters of the scene.
    scene : Scene
        The solved scene, with the chosen elements and meshes.
    resolution : str
        Description of the mesh.
    estimate : float
        Estimated error of the requested quantity, infinite without an estimate.
    decisions : tuple of str
        Trials with their reasons, in order.
    """

    response: Response
    scene: Scene
    resolution: str
    estimate: float
    decisions: tuple[str, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Theory:
    """Error of beam theory against the solid body, which no finer mesh of the beam removes.

    Attributes
    ----------
    error : float
        Expected relative error of a contact force.
    slenderness : float
        Largest h/L.
    strain : float
        Largest bending strain at a face, ``h kappa/2``.
    kink : float
        Largest angle by which shear kinks the axis at a contact, ``F/GA`` [rad].
    """

    error: float
    slenderness: float
    strain: float
    kink: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """A response to a stated accuracy.

    Attributes
    ----------
    found : Discretised
        Response, resolution and estimate.
    model : str
        Model that was chosen.
    accuracy : float
        Requested accuracy.
    quantity : str
        Key of `QUANTITIES`.
    theory : Theory or None
        The beam theory's own error; None for the solid, and where a section's height is not known.
    decisions : tuple of str
        Every decision, in order.
    seconds : float
        Total time [s].
    """

    found: Discretised
    model: str
    accuracy: float
    quantity: str
    theory: Theory | None
    decisions: tuple[str, ...]
    seconds: float

    @property
    def response(self) -> Response:
        """The response at all load parameters."""
        return self.found.response

    @property
    def reached(self) -> bool:
        """Whether the solution is complete and its estimate within the accuracy."""
        return self.response.completed and self.found.estimate <= self.accuracy

    def as_dict(self) -> dict[str, Any]:
        """Return the choice and the estimates by the names of the JSON file."""
        theory = self.theory
        return {
            "asked": self.accuracy,
            "quantity": self.quantity,
            "reached": self.reached,
            "model": self.model,
            "resolution": self.found.resolution,
            "estimate": self.found.estimate,
            "beam_theory": theory
            and {
                "error": theory.error,
                "slenderness": theory.slenderness,
                "strain": theory.strain,
                "kink": theory.kink,
            },
            "decisions": list(self.decisions),
            "seconds": self.seconds,
        }

    def lines(self) -> list[tuple[str, str]]:
        """Return the choice and the estimates in words."""
        mark = "" if self.reached else ", NOT REACHED"
        rows = [
            ("resolution", f"{self.model}: {self.found.resolution}"),
            (
                "estimated error",
                f"{self.found.estimate:.2g} of {self.quantity}, asked {self.accuracy:g}{mark}",
            ),
        ]
        if self.theory is not None:
            what = f"h/L {self.theory.slenderness:.3g}, strain {self.theory.strain:.2g}, shear kink {self.theory.kink:.2g}"
            more = (
                "" if self.theory.error <= self.accuracy else ": more than asked; the solid has no such error"
            )
            rows.append(("beam theory itself", f"about {self.theory.error:.1g} ({what}){more}"))
        return [*rows, ("seconds in all", f"{self.seconds:.3f}")]
