"""Keys that not every model, check and study knows, and the sentence that refuses a scene which uses one of them."""

from collections.abc import Callable, Iterable, Iterator
from typing import Final

from comparisons.scene.scene import Scene

_SPECIAL: Final[dict[str, tuple[str, Callable[[Scene], object]]]] = {
    "turn": ("a natural curvature (turn)", lambda scene: any(beam.turn for beam in scene.beams)),
    "taper": (
        "a section that tapers (height or width of two values)",
        lambda scene: any(beam.tapers for beam in scene.beams),
    ),
    "density": ("a weight (density)", lambda scene: scene.gravity),
    "force_per_length": (
        "a load along a beam (force_per_length)",
        lambda scene: any(item.load.force_per_length for item in scene.load_histories),
    ),
    "at": (
        "a load inside a beam (at)",
        lambda scene: any(item.load.at for item in scene.load_histories),
    ),
    "hinge": ("a hinge ([[hinge]])", lambda scene: scene.hinges),
    "spring": ("a spring ([[spring]])", lambda scene: scene.springs),
    "stage": ("a stage after the first one ([[stage]])", lambda scene: scene.stages),
}
SPECIAL: Final = {key: sentence for key, (sentence, _) in _SPECIAL.items()}
"""The keys and what each states, in the order in which they are refused."""
BEAMS = STRIPS = REFEREE = RODS = frozenset(SPECIAL)
"""Keys that beams, solids, the referee, and the exact rods state."""
ONE_ROD = PROGRAMS = frozenset[str]()
"""Keys that the exact answers by quadrature state, and the resolved scene that programs of others read."""
MATERIAL: Final = frozenset({"turn"})
"""Keys under which the material force is defined."""


def special_keys(scene: Scene) -> Iterator[str]:
    """Yield the keys of `SPECIAL` that `scene` uses."""
    yield from (key for key, (_, used) in _SPECIAL.items() if used(scene))


def unstated(scene: Scene, who: str, known: Iterable[str] = ()) -> str | None:
    """Return the line with which `who` refuses the first special key that it does not know; None if it knows all that `scene` uses.

    Examples
    --------
    >>> from comparisons.scene import load_scene
    >>> unstated(load_scene("ks-cantilever"), "the elastica") is None
    True
    """
    missing = next((key for key in special_keys(scene) if key not in set(known)), None)
    return None if missing is None else f"{who} does not state {SPECIAL[missing]}, which the scene uses"
