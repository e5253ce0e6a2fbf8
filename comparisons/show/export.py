"""VTU files through meshio, and the PVD file of a series."""

from dataclasses import replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from comparisons.files import alone_in, interrupts_held, replacing, staging, write_text
from comparisons.response import Array, Grid, Response
from comparisons.scene import Scene
from comparisons.show.listing import check_free, digest, listed, unchanged, with_digests


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


def body_grid(response: Response, k: int) -> Grid:
    """Return the body with its fields and, at every point, the index: 0 where the equilibrium is stable, -1 where it is not known."""
    grid = response.grid(k)
    if response.index is None:
        return grid
    index = np.full(len(grid.points), int(response.index[k]))
    return replace(grid, point_data={**grid.point_data, "index": index})


def pin_grid(response: Response, scene: Scene, k: int) -> Grid:
    """Return the pins as points: displacement, contact force on the beam, and gap (nan without contact).

    With friction there are `tangential`, `normal`, `slip` and `dissipated` of `FrictionHistory` too, nan at a pin without. A model that states no force vectors has one pair, whose force is the one that the support balances.
    """
    t = float(response.load_parameter[k])
    pins = [(contact, scene.pin(contact.node)) for contact in scene.contacts if "." not in contact.node]
    start = np.array([pin.points[0] for _, pin in pins]).reshape(-1, 2)
    deformed = np.array([pin.position(t) for _, pin in pins]).reshape(-1, 2)
    force = np.zeros_like(start)
    for i, (contact, _) in enumerate(pins):
        history = response.contacts[contact.pair]
        held = sum(support.force[k] for support in response.supports.values())
        force[i] = -held if history.vector is None else history.vector[k]
    data = {
        "displacement": deformed - start,
        "deformed": deformed,
        "contact_force": force,
        "gap": np.array([response.contacts[contact.pair].gap[k] for contact, _ in pins]),
    }
    rubbed = [response.contacts[contact.pair].friction for contact, _ in pins]
    if any(rubbed):
        for name in ("tangential", "normal", "slip", "dissipated"):
            data[name] = np.array([np.nan if one is None else getattr(one, name)[k] for one in rubbed])
    return Grid(points=start, cells={"vertex": np.arange(len(pins)).reshape(-1, 1)}, point_data=data)


def check_series(folder: Path, model: str, scene: Scene) -> None:
    """Raise unless the files of a series may be written: each is not there yet, or is as this program wrote it.

    Raises
    ------
    OutputError
        One line, with the first file in the way.
    ImportError
        If meshio is not installed.
    """
    import meshio  # noqa: F401 - before anything is computed for files that cannot be written

    names = [f"{part}-{k:04d}.vtu" for part in _parts(model) for k in range(1, scene.load_parameters + 1)]
    check_free(folder, names, _lists(folder, model))


def write_series(folder: Path, response: Response, scene: Scene) -> list[Path]:
    """Write one VTU of the body and one of the pins, if any, per load parameter, and ``MODEL.pvd`` that lists them with their digests.

    Files that the same model wrote here before, as its list gives them, are replaced, and removed where the series is shorter now; a
    file of anybody else's ends it before anything is written. All are written aside first. Of runs that write at the same time one
    waits for the other.

    Returns
    -------
    list of Path
        The body's files, in the order of the load parameters.

    Raises
    ------
    OutputError
        If there is no room, or a file is there that this program did not write.
    """
    with alone_in(folder):
        check_series(folder, response.model, scene)
        with staging(folder) as aside:
            entries = _write_grids(aside, response, scene)
            digests = {name: digest(aside / name) for _, _, name in entries}
            with interrupts_held():
                _move(aside, folder, response.model, _collection(entries), digests)
    return [folder / name for _, part, name in entries if part == 0]


def _parts(model: str) -> tuple[str, str]:
    return model, f"{model}-pin"


def _lists(folder: Path, model: str) -> tuple[Path, Path]:
    """The list of a series, and the one of a run that was ended while it moved its files."""
    return folder / f"{model}.pvd", folder / f".{model}.pvd"


def _write_grids(folder: Path, response: Response, scene: Scene) -> list[tuple[float, int, str]]:
    """Write every grid; return load parameter, part and name of every file."""
    entries: list[tuple[float, int, str]] = []
    for k, t in enumerate(response.load_parameter):
        grids = [body_grid(response, k), *([pin_grid(response, scene, k)] if scene.pins else [])]
        for part, (name, grid) in enumerate(zip(_parts(response.model), grids, strict=False)):
            file = f"{name}-{k + 1:04d}.vtu"
            write_vtu(folder / file, grid)
            entries.append((float(t), part, file))
    return entries


def _collection(entries: list[tuple[float, int, str]]) -> str:
    sets = [f'<DataSet timestep="{t!r}" part="{part}" file={quoteattr(name)}/>' for t, part, name in entries]
    head = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "<Collection>"]
    return "\n".join([*head, *sets, "</Collection>", "</VTKFile>\n"])


def _move(aside: Path, folder: Path, model: str, collection: str, digests: dict[str, str]) -> None:
    """Put a finished series in its place; wherever this is ended, one of the two lists knows every file."""
    shown, kept = _lists(folder, model)
    earlier = {**(listed(kept) or {}), **(listed(shown) or {})}
    stale = {name: value for name, value in earlier.items() if name not in digests}
    write_text(kept, with_digests(collection, {**stale, **digests}))
    for name in digests:
        (aside / name).replace(folder / name)
    kept.replace(shown)
    # last, so that no list names a file that is gone
    for path in unchanged(folder, stale):
        path.unlink()
