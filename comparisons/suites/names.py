"""What there is to run, by name: a sentence each."""

FIGURES = {
    "fig7a": "the cantilever lifted by a pin from six starting positions",
    "fig7b": "the critical area of every element formulation",
    "fig8": "the cantilever of Konyukhov and Schweizerhof by TSM and by solid elements",
    "fig9": "two cantilevers in contact under one pin",
}
"""What the figures of [P] show."""
QUESTIONS = {
    "locking": "which element locks, in thin strips and with nearly incompressible materials",
    "thin-beams": "whether the solid with the rod's law becomes the rod as h^2",
    "scatter": "how much the answers differ between meshes",
    "penalty": "from which penalty to which the answers hold",
    "peers": "whether CalculiX, a program of others, gives the same answers; needs its program ccx",
}
"""What is asked of the solid."""
SUITES = {
    "paper": "all figures of the paper, and its claims",
    **FIGURES,
    "manual": "the verification manual, problems with exact answers, put to every model that can state them",
    "bench": "the answers of a model to the benchmark set, for its scorer",
    "extremes": "where the models hold and where they stop, over units, slenderness, shear, meshes, contact positions, load steps, "
    "penalty, Poisson's ratio, depth and time",
    "trade": "what accuracy costs on SCENE, error against seconds, iterations and unknowns of many settings",
    **QUESTIONS,
}
"""All suites, in the order of the help."""
