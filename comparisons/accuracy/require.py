"""The bodies of a scene that carry load, and the model that the scene requires."""

from dataclasses import dataclass, replace

from comparisons.models import MODELS, SOLID, TSM, Model
from comparisons.models.options import ModelError, Options
from comparisons.response.material import UNDEFINED, clamped
from comparisons.scene import BeamSpec, Scene

STOCKY = 0.1
"""Height over length from which a beam is solved as a solid."""


@dataclass(frozen=True, kw_only=True)
class Requirement:
    """The scene to solve, and the model and options to solve it with.

    Attributes
    ----------
    scene : Scene
        The scene without the beams that carry no load.
    model : Model
        A model with a mesh.
    options : Options
        Options with the element type, if the model has several.
    decisions : tuple of str
        Reasons for the choice.
    """

    scene: Scene
    model: Model
    options: Options
    decisions: tuple[str, ...]


def required(
    scene: Scene, quantity: str, *, model: str | None = None, element: str | None = None
) -> Requirement:
    """Return the requirement of `scene` and `quantity`; a given `model` or `element` takes precedence.

    Raises
    ------
    ModelError
        If the model cannot state the scene, or the quantity.
    """
    loaded, said = without_idle(scene)
    if model is None:
        model, reason = (
            _model(loaded, quantity) if element is None else (TSM.name, f"{element} elements asked for")
        )
        said = (*said, f"{model}: {reason}")
    chosen = MODELS.get(model)
    if chosen is None or not chosen.refinable:
        refinable = " and ".join(name for name, other in MODELS.items() if other.refinable)
        raise ModelError(f"model = {model}: has no resolution to choose; {refinable} have")
    if element is not None and "element" not in chosen.options:
        raise ModelError(f"{model}: element = {element}: not an option of this model")
    if quantity == "stress" and not chosen.continuum:
        raise ModelError(f"quantity = stress: beams have section forces; --model {SOLID.name} has stresses")
    refused = chosen.refusal(loaded)
    if refused is not None:
        raise ModelError(refused)
    if quantity == "stress" and len(loaded.beams) > 1:
        raise ModelError("quantity = stress: is defined for a scene with one beam, this one has more")
    if quantity == "friction" and not clamped(loaded):
        raise ModelError(f"quantity = friction: {UNDEFINED}")
    options = Options(element=element) if element is not None else chosen.reference or Options()
    TSM.element(options)
    return Requirement(scene=loaded, model=chosen, options=options, decisions=said)


def _model(scene: Scene, quantity: str) -> tuple[str, str]:
    if quantity == "stress":
        return SOLID.name, "stresses through the thickness are asked for"
    stocky = [beam for beam in scene.beams if _height(beam) > STOCKY * beam.length]
    if stocky:
        beam = stocky[0]
        what = f'beam "{beam.name}" is stocky, h/L = {_height(beam) / beam.length:.3g} > {STOCKY:g}'
        refused = SOLID.refusal(scene)
        return (SOLID.name, what) if refused is None else (TSM.name, f"{what}, but {refused}")
    rods = "one slender beam" if len(scene.beams) == 1 else f"{len(scene.beams)} slender beams"
    return TSM.name, f"{rods}: exact rods suffice, which one exact element a beam solves"


def _height(beam: BeamSpec) -> float:
    """Return the largest height of a beam's section, zero where the section has none."""
    return max(beam.height_at(0.0), beam.height_at(1.0))


def without_idle(scene: Scene) -> tuple[Scene, tuple[str, ...]]:
    """Return the scene without beams that no load, weight, moving support or pin can reach, and a sentence for each."""
    groups = {beam.name: {beam.name} for beam in scene.beams}

    def join(one: str, other: str) -> None:
        both = groups[one] | groups[other]
        for name in both:
            groups[name] = both

    for beam in scene.beams:
        for other in scene.beams:
            if {beam.start, beam.end} & {other.start, other.end}:
                join(beam.name, other.name)
    pins = {pin.name for pin in scene.pins}
    for contact in scene.contacts:
        if contact.node not in pins:
            join(contact.node.split(".")[0], contact.beam)
    driven = {contact.beam for contact in scene.contacts if contact.node in pins}
    driven |= {history.load.beam for history in scene.load_histories}
    driven |= {beam.name for beam in scene.beams if beam.density is not None}
    driven |= {motion.support.beam for motion in scene.prescribed_motions.values() if motion.moves}
    idle = [beam.name for beam in scene.beams if not groups[beam.name] & driven]
    if not idle:
        return scene, ()
    kept = replace(
        scene,
        beams=tuple(beam for beam in scene.beams if beam.name not in idle),
        supports=tuple(support for support in scene.supports if support.beam not in idle),
        springs=tuple(spring for spring in scene.springs if spring.beam not in idle),
        hinges=tuple(hinge for hinge in scene.hinges if hinge.beam not in idle),
        contacts=tuple(contact for contact in scene.contacts if contact.beam not in idle),
    )
    return kept, tuple(f'beam "{name}" lies on no load path: left out' for name in idle)
