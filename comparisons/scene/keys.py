"""Keys that not every model, check and study knows, and the sentence that refuses a scene which uses one of them."""

from collections.abc import Iterable, Iterator
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

BEAMS: Final = frozenset(SPECIAL)
"""Keys that the tangent stiffness method states."""
STRIPS: Final = frozenset(SPECIAL)
"""Keys that the solid states."""
REFEREE: Final[frozenset[str]] = frozenset(SPECIAL)
"""Keys that the referee judges."""
RODS: Final[frozenset[str]] = REFEREE & BEAMS
"""Keys that the exact rods state: the referee solves them along the path that exact elements follow."""
ONE_ROD: Final[frozenset[str]] = frozenset()
"""Keys that the exact answers by quadrature state, for one beam under a pin."""
PROGRAMS: Final[frozenset[str]] = frozenset()
"""Keys that the resolved scene states, which programs of others read."""
MATERIAL: Final = frozenset({"turn"})
"""Keys under which the material force is defined."""


def special_keys(scene: Scene) -> Iterator[str]:
    """Yield the keys of `SPECIAL` that `scene` uses."""
    loads = [history.load for history in scene.load_histories]
    used = {
        "turn": any(beam.turn for beam in scene.beams),
        "taper": any(beam.tapers for beam in scene.beams),
        "density": scene.gravity is not None,
        "force_per_length": any(load.force_per_length is not None for load in loads),
        "at": any(load.at is not None for load in loads),
        "hinge": bool(scene.hinges),
        "spring": bool(scene.springs),
        "stage": bool(scene.stages),
    }
    yield from (key for key in SPECIAL if used[key])


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
