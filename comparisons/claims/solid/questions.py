"""What is asked of the solid model."""

QUESTIONS = {
    "locking": "which element locks, in thin strips and with nearly incompressible materials",
    "thin-beams": "whether the solid with the rod's law becomes the rod as h^2",
    "scatter": "how much the answers differ between meshes",
    "penalty": "from which penalty to which the answers hold",
    "peers": "whether CalculiX, a program of others, gives the same answers; needs its program ccx",
}
"""What the studies answer, by name."""
