"""The scenes that the exact models can state, and one line for each reason why they cannot."""

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, Scene, SupportSpec


def one_beam_under_a_pin(scene: Scene, model: str) -> SupportSpec:
    """Return the clamp of the single beam that a single pin touches.

    Raises
    ------
    ModelError
        If the scene has another form. The message begins with `model`.
    """
    if (len(scene.beams), len(scene.pins), len(scene.contacts)) != (1, 1, 1):
        raise ModelError(f"{model} one beam, one pin and one contact")
    clamp, *others = _supports(scene, scene.beams[0], model)
    if others:
        raise ModelError(f'{model} one support, beam "{clamp.beam}" has two')
    return clamp


def one_beam_with_tied_tip(scene: Scene, model: str) -> tuple[SupportSpec, SupportSpec]:
    """Return the clamp of the single beam and the pinned support that moves its other end.

    Raises
    ------
    ModelError
        If the scene has another form. The message begins with `model`.
    """
    if len(scene.beams) > 1 or scene.pins or scene.contacts:
        raise ModelError(f"{model} one beam, under one pin or with an end that is moved")
    clamp, *others = _supports(scene, scene.beams[0], model)
    if len(others) != 1 or others[0].held != ("x", "y"):
        raise ModelError(
            f'{model} a pinned support at the free end of beam "{clamp.beam}", to move it without a pin'
        )
    return clamp, others[0]


def _supports(scene: Scene, beam: BeamSpec, model: str) -> tuple[SupportSpec, ...]:
    """Return the supports of a beam without dead loads: first a clamp at rest, then any other."""
    if scene.loads:
        raise ModelError(f'{model} no dead loads, the scene loads "{scene.loads[0].node}"')
    clamp, *others = scene.supports_of(beam.name)
    if len(clamp.held) < 3:
        raise ModelError(f'{model} one end clamped, none of beam "{beam.name}" is')
    if scene.prescribed_motions[clamp.node].moves:
        raise ModelError(f'{model} the clamp at rest, "{clamp.node}" moves')
    return clamp, *others
