"""Keys that not every model, check and study knows, and the sentence that refuses a scene which uses one of them."""

from collections.abc import Collection, Iterator
from typing import Final

from comparisons.scene.scene import Scene

SPECIAL: Final = {
    "turn": "a natural curvature (turn)",
    "taper": "a section that tapers (height or width of two values)",
    "density": "a weight (density)",
    "force_per_length": "a load along a beam (force_per_length)",
    "at": "a load inside a beam (at)",
    "hinge": "a hinge ([[hinge]])",
    "spring": "a spring ([[spring]])",
    "stage": "a stage after the first one ([[stage]])",
}
"""The keys and what each states, in the order in which they are refused."""


def special_keys(scene: Scene) -> Iterator[str]:
    """Yield the keys of `SPECIAL` that `scene` uses."""
    turns, tapers = any(beam.turn for beam in scene.beams), any(beam.tapers for beam in scene.beams)
    loads = [item.load for item in scene.load_histories]
    along, inside = any(load.force_per_length for load in loads), any(load.at for load in loads)
    used = (turns, tapers, scene.gravity, along, inside, scene.hinges, scene.springs, scene.stages)
    yield from (key for key, uses in zip(SPECIAL, used, strict=True) if uses)


def unstated(scene: Scene, who: str, known: Collection[str] = ()) -> str | None:
    """Return the line with which `who` refuses the first special key that it does not know; None if it knows all that `scene` uses.

    Examples
    --------
    >>> from comparisons.scene import load_scene
    >>> unstated(load_scene("ks-cantilever"), "the elastica") is None
    True
    """
    missing = (SPECIAL[key] for key in special_keys(scene) if key not in known)
    return next((f"{who} does not state {what}, which the scene uses" for what in missing), None)
