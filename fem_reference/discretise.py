"""The mesh of a strip, its own or the user's."""

from fem_reference.mesh import Discretisation, structured_mesh
from fem_reference.strip import Strip


def discretise(strip: Strip) -> Discretisation:
    """Mesh a strip: equal rows and a geometric series along it, or the user's own mesh."""
    if strip.mesh_file is None:
        return structured_mesh(strip)
    from fem_reference.mesh_file import read_mesh

    return read_mesh(strip)
