"""The quantities that are compared between two responses to one scene; `comparisons.errors` measures their errors."""

QUANTITIES = {
    "force": "contact forces, of a scene without contact the support forces, over the largest",
    "arc": "arc positions of the contacts over the length",
    "moment": "support moments over the largest",
    "friction": "material force at the clamp of a beam with a free end, over the contact forces on the beam",
    "tip": "positions of the beams' ends over the length",
    "shape": "deflected axes at equal arc lengths, the largest distance over the length",
    "shape_mean": "deflected axes at equal arc lengths, the mean distance over the length",
    "stress": "stress at the faces over the largest, away from clamp, tip and contacts; of one beam, by the solid",
}
"""Quantities by name. `crossval solve --accuracy` takes each of them, and `crossval compare --max-error` can bound each."""
PATH = {
    "gap": "gaps of contacts that are open in one of the two, over the length",
    "event": "load parameters of events and slip-offs, as absolute differences; infinite where one of the two has no such event",
}
"""Quantities that tell whether two responses follow one path. `crossval compare` writes them, and can bound them too."""
COMPARED = {**QUANTITIES, **PATH}
KEPT = tuple(name for name in QUANTITIES if name != "stress")
"""The quantities that every model states and that a stored response keeps."""
SCOPES = ("end", "path")
"""``end``: the error at one load parameter; ``path``: the largest error over all load parameters that both responses have."""
