"""VTK's XML files, both ways: a grid by meshio, a set of named blocks, a series over the load parameters.

Every field has its unit as VTK's information key ``UNITS_LABEL``, and a set of blocks has the list of all
units as the field data `units`. The names of fields have no unit, so that one script reads the files of
scenes in other units. Files are written in place: the series that has them is written to a folder aside.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from comparisons.answer import Grid
from comparisons.files import OutputError, writing

LABEL = '<InformationKey name="UNITS_LABEL" location="vtkDataArray">{}</InformationKey>\n</DataArray>'
ARRAY = re.compile(r'(<DataArray [^>]*Name="(\w+)"[^>]*>[^<]*)</DataArray>')


def write_grid(path: Path, grid: Grid, units: Mapping[str, str]) -> None:
    """Write a grid, undeformed, as a VTU file with the units of its fields by name; the third component is 0."""
    from meshio import Mesh, vtu

    def in_space(values: Any) -> Any:
        return np.pad(values, ((0, 0), (0, 1))) if values.shape[1:] == (2,) else np.asarray(values)

    def labelled(array: re.Match[str]) -> str:
        unit = units.get(array[2])
        return array[0] if unit is None else array[1] + LABEL.format(escape(unit))

    data = {name: in_space(values) for name, values in grid.point_data.items()}
    with writing(path):
        vtu.write(path, Mesh(in_space(grid.points), grid.cells, point_data=data))
        path.write_text(ARRAY.sub(labelled, path.read_text("utf-8")), encoding="utf-8")


def read_grid(path: Path) -> Grid:
    """Return the grid of a VTU file in the plane; `OutputError`, one line, if it cannot be read."""
    from meshio import ReadError, vtu

    try:
        mesh = vtu.read(path)  # meshio.read ends the process where a file is broken
    except (OSError, ReadError, ET.ParseError) as error:
        raise OutputError(f"{path}: cannot be read: {error or 'not a VTU file'}") from None
    # the components that a support holds are the one field with three numbers that is no vector
    columns = {3: np.s_[:, :2], 1: np.s_[:, 0]}
    data = {
        name: values if name == "held" or values.ndim == 1 else values[columns[values.shape[1]]]
        for name, values in mesh.point_data.items()
    }
    return Grid(points=mesh.points[:, :2], cells=dict(mesh.cells_dict), point_data=data)


def write_blocks(path: Path, files: Mapping[str, str], units: Mapping[str, str]) -> None:
    """Write a VTM file: VTU files by the names of their blocks, and the units of all fields."""
    words = [f"{name} [{unit}]" for name, unit in units.items()]
    codes = " ".join(str(code) for word in words for code in (*word.encode(), 0))
    named = enumerate(files.items())
    sets = (f'index="{k}" name={quoteattr(name)} file={quoteattr(file)}' for k, (name, file) in named)
    field = f'<Array type="String" Name="units" NumberOfTuples="{len(words)}" format="ascii">{codes}</Array>'
    _write(path, "vtkMultiBlockDataSet", sets, f"<FieldData>\n{field}\n</FieldData>\n")


def write_list(path: Path, entries: Iterable[tuple[float, str]]) -> None:
    """Write files by their load parameters as a PVD file."""
    _write(path, "Collection", (f'timestep="{t!r}" file={quoteattr(name)}' for t, name in entries))


def _write(path: Path, kind: str, sets: Iterable[str], more: str = "") -> None:
    inner = "".join(f"<DataSet {attributes}/>\n" for attributes in sets)
    head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n'
    with writing(path):
        path.write_text(f"{head}<{kind}>\n{inner}</{kind}>\n{more}</VTKFile>\n", encoding="utf-8")


def read_entries(path: Path, attribute: str) -> list[tuple[str, Path]]:
    """Return an attribute and the file of every entry of a PVD or VTM file; it may raise `OutputError`."""
    sets = [one.attrib for one in _parsed(path).iter("DataSet")]
    try:
        return [(one[attribute], path.parent / one["file"]) for one in sets]
    except KeyError as error:
        raise OutputError(f"{path}: cannot be read: an entry has no {error}") from None


def read_units(path: Path) -> dict[str, str]:
    """Return the units by field that a set of blocks states; `OutputError` if it cannot be read."""
    words = "".join(array.text or "" for array in _parsed(path).iter("Array") if array.get("Name") == "units")
    return dict(re.findall(r"(\S+) \[(.*?)\]\0", bytes(map(int, words.split())).decode()))


def _parsed(path: Path) -> ET.Element:
    try:
        return ET.parse(path).getroot()  # noqa: S314 - a file of our own
    except (OSError, ET.ParseError) as error:
        raise OutputError(f"{path}: cannot be read: {error}") from None
