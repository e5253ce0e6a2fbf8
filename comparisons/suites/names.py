"""What there is to run, by name: a sentence each."""

FIGURES = {
    "fig7a": "the cantilever lifted by a pin from six starting positions",
    "fig7b": "the critical area of every element formulation",
    "fig8": "the cantilever of Konyukhov and Schweizerhof by TSM and by solids",
    "fig9": "two cantilevers in contact under one pin",
}
"""What the figures of [P] show."""
QUESTIONS = {
    "locking": "which element locks, thin or nearly incompressible",
    "thin-beams": "whether the solid with the rod's law becomes the rod as h^2",
    "scatter": "how much the answers differ between meshes",
    "penalty": "from which penalty to which the answers hold",
    "peers": "whether CalculiX gives the same answers; needs its program ccx",
}
"""What is asked of the solid."""
SUITES = {
    "paper": "all figures of the paper, and its claims",
    **FIGURES,
    "manual": "the verification manual: problems with exact answers, every model",
    "bench": "the answers of a model to the benchmark set, for its scorer",
    "extremes": "where models hold and stop: units, slenderness, meshes, time, ...",
    "trade": "what accuracy costs on SCENE: error over time, for many settings",
    **QUESTIONS,
}
"""All suites, in the order of the help."""
