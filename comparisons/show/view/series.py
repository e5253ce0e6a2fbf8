"""Blocks over the load parameters: of a response, or of the files that one was written to."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from comparisons.files import OutputError
from comparisons.response import Array, Grid, Response
from comparisons.scene import Scene
from comparisons.show.export import blocks, field_units
from comparisons.show.vtu import units_in


@dataclass(frozen=True, kw_only=True)
class Series:
    """The blocks of a model's answer at s load parameters.

    Attributes
    ----------
    title : str
        What it shows.
    load_parameter : ndarray, shape (s,)
        Load parameters.
    blocks : callable
        The blocks at load parameter k, as `comparisons.show.export.blocks` gives them.
    units : mapping of str
        Units of the fields by name.
    """

    title: str
    load_parameter: Array
    blocks: Callable[[int], Mapping[str, Grid]]
    units: Mapping[str, str] = field(default_factory=dict)


def solved_series(response: Response, scene: Scene, title: str) -> Series:
    """Return the series of a response."""
    return Series(
        title=title,
        load_parameter=response.load_parameter,
        blocks=lambda k: blocks(response, scene, k),
        units=field_units(scene),
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
    entries = [(float(t), path.parent / file) for t, file in _listed(path, "timestep")]
    units = _units(entries[0][1]) if entries else {}
    return Series(
        title=path.stem,
        load_parameter=np.array([t for t, _ in entries]),
        blocks=lambda k: _blocks(entries[k][1]),
        units=units,
    )


def _blocks(path: Path) -> dict[str, Grid]:
    return {name: _grid(path.parent / file) for name, file in _listed(path, "name")}


def _listed(path: Path, attribute: str) -> list[tuple[str, str]]:
    """Return an attribute and the file of every entry of a PVD or VTM file."""
    found = _parsed(path).iter("DataSet")
    try:
        return [(entry.attrib[attribute], entry.attrib["file"]) for entry in found]
    except KeyError as error:
        raise OutputError(f"{path}: cannot be read: an entry has no {error}") from None


def _units(path: Path) -> dict[str, str]:
    """Return the units that a set of blocks states."""
    words = "".join(array.text or "" for array in _parsed(path).iter("Array") if array.get("Name") == "units")
    return units_in(bytes(map(int, words.split())).decode().split("\0"))


def _parsed(path: Path) -> ET.Element:
    try:
        return ET.parse(path).getroot()  # noqa: S314 - a file of our own
    except (OSError, ET.ParseError) as error:
        raise OutputError(f"{path}: cannot be read: {error}") from None


def _grid(path: Path) -> Grid:
    from meshio import ReadError, vtu

    try:
        mesh = vtu.read(path)  # meshio.read ends the process where a file is broken
    except (OSError, ReadError, ET.ParseError) as error:
        raise OutputError(f"{path}: cannot be read: {error or 'not a VTU file'}") from None
    data = {
        name: values[:, :2]
        if values.shape[1:] == (3,) and name != "held"
        else values[:, 0]
        if values.shape[1:] == (1,)
        else values
        for name, values in mesh.point_data.items()
    }
    return Grid(points=mesh.points[:, :2], cells=dict(mesh.cells_dict), point_data=data)
