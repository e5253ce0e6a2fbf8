"""The figures of [P] that can be reproduced."""

FIGURES = {
    "fig7a": "the cantilever lifted by a pin from six starting positions",
    "fig7b": "the critical area of every element formulation",
    "fig8": "the cantilever of Konyukhov and Schweizerhof by TSM and by solid elements",
    "fig9": "two cantilevers in contact under one pin",
}
"""What they show, by name."""
