"""The text of VTK's XML files: an unstructured grid, a set of named blocks, a series over the load parameters.

Every array has its unit as VTK's information key ``UNITS_LABEL``, and a set of blocks has the list of all units as the field data
`units`. The names of arrays have no unit, so that one script reads the files of scenes in other units.
"""

import base64
import re
import zlib
from collections.abc import Iterable, Mapping, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from comparisons.response import Grid

CELLS = {"vertex": 1, "line": 3, "quad": 9, "quad9": 28}
"""VTK's numbers of cell types."""
TYPES = {"f8": "Float64", "i8": "Int64", "u1": "UInt8"}
HEAD = '<?xml version="1.0"?>\n<VTKFile type="{}" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">'


def grid_text(grid: Grid, units: Mapping[str, str]) -> str:
    """Return a grid with its undeformed points as a VTU file; 2D points and vectors get a zero third component.

    Parameters
    ----------
    grid : Grid
        The grid.
    units : mapping of str
        Units of the fields by name.
    """
    counts = [len(cells) for cells in grid.cells.values()]
    sizes = np.repeat([cells.shape[1] for cells in grid.cells.values()], counts)
    types = np.repeat([CELLS[kind] for kind in grid.cells], counts).astype(np.uint8)
    fields = (_array(name, values, units.get(name)) for name, values in grid.point_data.items())
    lines = [
        HEAD.format("UnstructuredGrid"),
        "<UnstructuredGrid>",
        f'<Piece NumberOfPoints="{len(grid.points)}" NumberOfCells="{sum(counts)}">',
        "<Points>",
        _array("Points", grid.points, None),
        "</Points>",
        "<Cells>",
        _array("connectivity", np.concatenate([cells.ravel() for cells in grid.cells.values()]), None),
        _array("offsets", np.cumsum(sizes), None),
        _array("types", types, None),
        "</Cells>",
        "<PointData>",
        *fields,
        "</PointData>",
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
    ]
    return "\n".join(lines) + "\n"


def _array(name: str, values: NDArray[np.generic], unit: str | None) -> str:
    """Return an array in base64, compressed; a vector in the plane becomes one in space."""
    if values.shape[1:] == (2,):
        values = np.pad(values, ((0, 0), (0, 1)))
    values = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    packed = zlib.compress(values.tobytes(), 1)
    head = np.array([1, values.nbytes, 0, len(packed)], dtype="<u8").tobytes()
    text = (base64.b64encode(head) + base64.b64encode(packed)).decode("ascii")
    if unit is not None:
        text += f'<InformationKey name="UNITS_LABEL" location="vtkDataArray">{escape(unit)}</InformationKey>'
    kind = TYPES[values.dtype.str[1:]]
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{width} format="binary">{text}</DataArray>'


def blocks_text(files: Mapping[str, str], units: Mapping[str, str]) -> str:
    """Return a set of blocks as a VTM file.

    Parameters
    ----------
    files : mapping of str
        VTU files by the names of the blocks.
    units : mapping of str
        Units of the fields by name.
    """
    sets = [
        f'<DataSet index="{number}" name={quoteattr(name)} file={quoteattr(file)}/>'
        for number, (name, file) in enumerate(files.items())
    ]
    words = [f"{name} [{unit}]" for name, unit in units.items()]
    codes = " ".join(str(code) for word in words for code in (*word.encode(), 0))
    return "\n".join(
        [
            HEAD.format("vtkMultiBlockDataSet"),
            "<vtkMultiBlockDataSet>",
            *sets,
            "</vtkMultiBlockDataSet>",
            "<FieldData>",
            f'<Array type="String" Name="units" NumberOfTuples="{len(words)}" format="ascii">{codes}</Array>',
            "</FieldData>",
            "</VTKFile>\n",
        ]
    )


def units_in(words: Iterable[str]) -> dict[str, str]:
    """Return the units by field from the field data `units`.

    Examples
    --------
    >>> units_in(["stress_xx [N/m^2]", "gap [m]"])
    {'stress_xx': 'N/m^2', 'gap': 'm'}
    """
    found = (re.fullmatch(r"(\S+) \[(.*)\]", word) for word in words)
    return {match[1]: match[2] for match in found if match}


def series_text(entries: Sequence[tuple[float, str]]) -> str:
    """Return files by their load parameters as a PVD file."""
    sets = [f'<DataSet timestep="{t!r}" file={quoteattr(name)}/>' for t, name in entries]
    head = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "<Collection>"]
    return "\n".join([*head, *sets, "</Collection>", "</VTKFile>\n"])
