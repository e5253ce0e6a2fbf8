"""VTU files through meshio, and the PVD file of a series."""

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from comparisons.files import alone_in, replacing, write_text
from comparisons.response import Array, Grid, Response
from comparisons.scene import Scene


def write_vtu(path: Path, grid: Grid) -> None:
    """Write `grid` with its undeformed points; 2D points and vectors get a zero third component.

    Components of `cauchy_stress` are xx, yy, xy.
    """
    import meshio

    data = {
        name: _three(values) if values.shape[1:] == (2,) else values
        for name, values in grid.point_data.items()
    }
    mesh = meshio.Mesh(_three(grid.points), list(grid.cells.items()), point_data=data)
    with replacing(path) as temporary:
        mesh.write(temporary, file_format="vtu")


def _three(vectors: Array) -> Array:
    return np.pad(vectors, ((0, 0), (0, 1)))


def pin_grid(response: Response, scene: Scene, k: int) -> Grid:
    """Return the pins as points: displacement, contact force on the beam, and gap (nan without contact).

    A model that states no force vectors has one pair, whose force is the one that the support balances.
    """
    t = float(response.load_parameter[k])
    pins = [(contact, scene.pin(contact.node)) for contact in scene.contacts if "." not in contact.node]
    start = np.array([pin.points[0] for _, pin in pins]).reshape(-1, 2)
    deformed = np.array([pin.position(t) for _, pin in pins]).reshape(-1, 2)
    force = np.zeros_like(start)
    for i, (contact, _) in enumerate(pins):
        history = response.contacts[contact.pair]
        force[i] = -response.supports[contact.beam].force[k] if history.vector is None else history.vector[k]
    data = {
        "displacement": deformed - start,
        "deformed": deformed,
        "contact_force": force,
        "gap": np.array([response.contacts[contact.pair].gap[k] for contact, _ in pins]),
    }
    return Grid(points=start, cells={"vertex": np.arange(len(pins)).reshape(-1, 1)}, point_data=data)


def write_series(folder: Path, response: Response, scene: Scene) -> list[Path]:
    """Write one VTU of the body and one of the pins, if any, per load parameter, and ``MODEL.pvd`` that lists them.

    Files of an earlier, longer series are removed. Of runs that write at the same time one waits for the other.

    Returns
    -------
    list of Path
        The body's files, in the order of the load parameters.
    """
    with alone_in(folder):
        return _write_series(folder, response, scene)


def _write_series(folder: Path, response: Response, scene: Scene) -> list[Path]:
    bodies: list[Path] = []
    written: set[Path] = set()
    entries: list[str] = []
    for k, t in enumerate(response.load_parameter):
        parts = {response.model: response.grid(k)}
        if scene.pins:
            parts["pin"] = pin_grid(response, scene, k)
        for part, (name, grid) in enumerate(parts.items()):
            path = folder / f"{name}-{k + 1:04d}.vtu"
            write_vtu(path, grid)
            written.add(path)
            entries.append(f'<DataSet timestep="{float(t)!r}" part="{part}" file={quoteattr(path.name)}/>')
            if part == 0:
                bodies.append(path)
    body = "\n".join(
        ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "<Collection>", *entries]
    )
    write_text(folder / f"{response.model}.pvd", body + "\n</Collection>\n</VTKFile>\n")
    # last, so that no list names a file that is gone
    for stale in {
        path for name in (response.model, "pin") for path in folder.glob(f"{name}-????.vtu")
    } - written:
        stale.unlink()
    return bodies
