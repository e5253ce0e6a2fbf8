"""What the figures of [P] show, and what is asked of the solid, by name."""

FIGURES = {
    "fig7a": "the cantilever lifted by a pin from six starting positions",
    "fig7b": "the critical area of every element formulation",
    "fig8": "the cantilever of Konyukhov and Schweizerhof by TSM and by solid elements",
    "fig9": "two cantilevers in contact under one pin",
}
"""What they show, by name."""


QUESTIONS = {
    "locking": "which element locks, in thin strips and with nearly incompressible materials",
    "thin-beams": "whether the solid with the rod's law becomes the rod as h^2",
    "scatter": "how much the answers differ between meshes",
    "penalty": "from which penalty to which the answers hold",
    "peers": "whether CalculiX, a program of others, gives the same answers; needs its program ccx",
}
"""What the studies answer, by name."""
