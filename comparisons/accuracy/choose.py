"""From a scene and an accuracy to a model, a resolution and an answer."""

from time import perf_counter

from comparisons.accuracy.answer import Answer, Discretised
from comparisons.accuracy.beams import exact_to, graded_to
from comparisons.accuracy.require import Requirement, required
from comparisons.accuracy.solid import solid_to
from comparisons.accuracy.theory import beam_theory
from comparisons.models import TSM
from comparisons.models.options import ModelError
from comparisons.quantities import QUANTITIES
from comparisons.scene import Scene
from tsm.elements import MIXED, ClosedForm


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
        Key of `QUANTITIES`.
    model : {"tsm", "solid"}, optional
        Model to use; by default the one that the scene requires.
    element : str, optional
        Type of the TSM elements; by default ``exact``.

    Raises
    ------
    ModelError
        If the quantity is unknown, or the model cannot state it or the scene.
    """
    if quantity not in QUANTITIES:
        raise ModelError(f"quantity = {quantity}: must be one of {', '.join(QUANTITIES)}")
    began = perf_counter()
    needed = required(scene, quantity, model=model, element=element)
    found, said = _discretised(needed, accuracy, quantity, free=element is None)
    return Answer(
        found=found,
        model=needed.model.name,
        accuracy=accuracy,
        quantity=quantity,
        theory=beam_theory(found.response, found.scene) if not needed.model.continuum else None,
        decisions=(*needed.decisions, *said),
        seconds=perf_counter() - began,
    )


def _discretised(
    needed: Requirement, accuracy: float, quantity: str, *, free: bool
) -> tuple[Discretised, tuple[str, ...]]:
    if needed.model.continuum:
        found = solid_to(needed.scene, accuracy, quantity)
        return found, found.decisions
    kind = TSM.element(needed.options)
    if isinstance(kind, ClosedForm):
        found = graded_to(needed.scene, accuracy, quantity, kind)
        return found, found.decisions
    found = exact_to(needed.scene, accuracy, quantity)
    if found.response.status != "INACCURATE" or not free:
        return found, found.decisions
    other = graded_to(needed.scene, accuracy, quantity, MIXED)
    instead = f"{kind.name} stopped: INACCURATE; {MIXED.name} instead"
    return other, (*found.decisions, instead, *other.decisions)
