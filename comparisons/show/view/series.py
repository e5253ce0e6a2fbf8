"""Grids over the load parameters: of a response, or of the files that one was written to."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from comparisons.files import OutputError
from comparisons.response import Array, Grid, Response
from comparisons.scene import Scene
from comparisons.show.export import pin_grid


@dataclass(frozen=True, kw_only=True)
class Series:
    """A body and its pins at s load parameters.

    Attributes
    ----------
    title : str
        What it shows.
    load_parameter : ndarray, shape (s,)
        Load parameters.
    body, pins : callable
        Their grids at load parameter k.
    """

    title: str
    load_parameter: Array
    body: Callable[[int], Grid]
    pins: Callable[[int], Grid]


def solved_series(response: Response, scene: Scene, title: str) -> Series:
    """Return the series of a response."""
    return Series(
        title=title,
        load_parameter=response.load_parameter,
        body=response.grid,
        pins=lambda k: pin_grid(response, scene, k),
    )


def read_series(folder: Path) -> list[Series]:
    """Return the series of the PVD files in a folder or in the folders in it, as `comparisons.show.export.write_series` writes them.

    Raises
    ------
    OutputError
        One line, if there is none or one cannot be read.
    """
    files = sorted(folder.glob("*.pvd")) or sorted(folder.glob("*/*.pvd"), reverse=True)
    if not files:
        raise OutputError(
            f"{folder}: has no PVD file, `crossval solve --vtk` and `crossval compare` write them"
        )
    return [_read(path) for path in files]


def _read(path: Path) -> Series:
    parts: dict[int, list[tuple[float, Path]]] = {0: [], 1: []}
    try:
        for entry in ET.parse(path).getroot().iter("DataSet"):  # noqa: S314 - a file of our own
            parts[int(entry.attrib["part"])].append(
                (float(entry.attrib["timestep"]), path.parent / entry.attrib["file"])
            )
    except (OSError, ET.ParseError, KeyError, ValueError) as error:
        raise OutputError(f"{path}: cannot be read: {error}") from None
    bodies, pins = parts[0], dict(parts[1])
    none = Grid(points=np.zeros((0, 2)), cells={}, point_data={})
    return Series(
        title=path.stem,
        load_parameter=np.array([t for t, _ in bodies]),
        body=lambda k: _grid(bodies[k][1]),
        pins=lambda k: _grid(pins[bodies[k][0]]) if bodies[k][0] in pins else none,
    )


def _grid(path: Path) -> Grid:
    from meshio import ReadError, vtu

    try:
        mesh = vtu.read(path)  # meshio.read ends the process where a file is broken
    except (OSError, ReadError, ET.ParseError) as error:
        raise OutputError(f"{path}: cannot be read: {error or 'not a VTU file'}") from None
    cut = {
        name: values[:, :2] if values.shape[1:] == (3,) else values
        for name, values in mesh.point_data.items()
    }
    cut["cauchy_stress"] = mesh.point_data.get("cauchy_stress", np.zeros((len(mesh.points), 3)))
    return Grid(points=mesh.points[:, :2], cells=dict(mesh.cells_dict), point_data=cut)
