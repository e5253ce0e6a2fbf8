"""The answers of a model as files for ParaView.

A load parameter has one VTU file for each beam, one for the contacts, one for the supports, and a VTM file that names these blocks.
The PVD file lists the load parameters.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Array, Grid, Response
from comparisons.answer.axis import place_of
from comparisons.answer.table import unit_names
from comparisons.files import OutputError, alone_in, check_free, interrupts_held, move, own, staging
from comparisons.report.symbols import at_arcs, inward, kinds
from comparisons.report.vtk import read_entries, read_grid, read_units, write_blocks, write_grid, write_list
from comparisons.scene import ContactSpec, Scene

CONTACTS, SUPPORTS, HINGES = POINTS = ("contact points", "support points", "hinge points")
"""Names of the blocks besides the beams; no beam has a name with a space."""
FIELDS = {
    "length": "displacement deformed arc height beam_displacement gap radius",
    "angle": "rotation",
    "force": "N V contact_force tangential normal reaction_force",
    "moment": "M dissipated reaction_moment",
    "stress": "stress_xx stress_yy stress_xy von_mises axial_stress axial_stress_right axial_stress_left",
}
"""The fields that have a unit, by the kind of quantity; other fields are plain numbers."""


def field_units(scene: Scene) -> dict[str, str]:
    """Return the units of all fields in the scene's units of force and length."""
    units = unit_names(scene.units) | {"angle": "rad"}
    return {name: units[kind] for kind, names in FIELDS.items() for name in names.split()}


def blocks(response: Response, scene: Scene, k: int) -> dict[str, Grid]:
    """Return the grids of a load parameter by name: every beam with its fields, then those of `POINTS` that the scene has.

    Every point of a beam has the index: 0 where the equilibrium is stable, -1 where it is not known. The other fields are those of
    ``docs/how-to/paraview.md``; what a model does not state is nan.
    """
    found = {beam.name: response.grid(beam.name, k) for beam in scene.beams}
    if response.index is not None:
        for grid in found.values():
            grid.point_data["index"] = np.full(len(grid.points), int(response.index[k]))
    if scene.contacts:
        found[CONTACTS] = _points(response, scene, k, scene.contacts, _touching(response, scene, k))
    if scene.holding:
        found[SUPPORTS] = _points(response, scene, k, scene.holding, _reactions(response, scene, k))
    if scene.hinges:
        found[HINGES] = _points(response, scene, k, scene.hinges, {})
    return found


def _touching(response: Response, scene: Scene, k: int) -> dict[str, Array]:
    """Return what acts on the beams at the contacts: at pins, and at ends that touch another beam."""
    histories = [response.contacts[contact.pair] for contact in scene.contacts]
    # a model without force vectors has one pair, which the supports balance
    balance = -sum((one.force[k] for one in response.supports.values()), np.zeros(2))
    forces = [balance if one.vector is None else one.vector[k] for one in histories]
    data = {
        "beam_displacement": np.array([_touched(response, scene, contact, k) for contact in scene.contacts]),
        "radius": np.array([scene.radius(contact) for contact in scene.contacts]),
        "contact_force": np.array(forces),
        "gap": np.array([history.gap[k] for history in histories]),
    }
    rubbed = [history.friction for history in histories]
    for name in ("tangential", "normal", "slip", "dissipated") if any(rubbed) else ():
        data[name] = np.array([np.nan if one is None else getattr(one, name)[k] for one in rubbed])
    return data


def _touched(response: Response, scene: Scene, contact: ContactSpec, k: int) -> Array:
    """Return the displacement of the beam where a contact is closed, of its node where it is open."""
    arc, beam = response.contacts[contact.pair].arc_position[k], scene.beam(contact.beam)
    if np.isfinite(arc):
        return at_arcs(arc, *response.axis_line(beam.name, k)) - beam.place(arc / beam.length)
    return place_of(response, scene, contact.node, k) - place_of(response, scene, contact.node, -1)


def _reactions(response: Response, scene: Scene, k: int) -> dict[str, Array]:
    """Return force and moment of supports and springs on the beam; for pictures, what is held (1, by a spring 2) and the way into the beam."""
    found = [response.supports.get(one.node) for one in scene.all_supports]
    found += [response.springs.get(one.node) for one in scene.springs]
    return {
        "reaction_force": np.array([(np.nan, np.nan) if one is None else one.force[k] for one in found]),
        "reaction_moment": np.array([np.nan if one is None else one.moment[k] for one in found]),
        "held": np.array([kinds(one) for one in scene.holding]),
        "inward": np.array([inward(scene, one) for one in scene.holding]),
    }


def _points(response: Response, scene: Scene, k: int, items: Sequence[Any], data: dict[str, Array]) -> Grid:
    """Return the nodes of some items, pins or ends of beams, as a grid with their displacement and other fields."""
    start, deformed = (
        np.array([place_of(response, scene, one.node, step) for one in items]) for step in (-1, k)
    )
    cells = {"vertex": np.arange(len(start)).reshape(-1, 1)}
    moved = {"displacement": deformed - start, "deformed": deformed}
    return Grid(points=start, cells=cells, point_data={**moved, **data})


def check_series(folder: Path, model: str, scene: Scene) -> None:
    """Raise `OutputError` with the first file in the way, unless each of a series is not there yet, or is as this program wrote it."""
    count = len(scene.beams) + sum(map(bool, (scene.contacts, scene.holding, scene.hinges)))
    names = (name for k in range(len(scene.times)) for name in _names(model, k, count))
    check_free(folder, *names, f"{model}.pvd")


def _names(model: str, k: int, count: int) -> list[str]:
    """Return the names of the VTM and the VTU files of a load parameter."""
    # a number for a block: names of beams may differ in capitals only, which some systems do not tell apart
    stem = f"{model}-{k + 1:04d}"
    return [f"{stem}.vtm", *(f"{stem}-{number}.vtu" for number in range(count))]


def write_series(folder: Path, response: Response, scene: Scene) -> list[Path]:
    """Write the VTU files of the `blocks` and a VTM that names them, per load parameter, and ``MODEL.pvd`` that lists them.

    Files of the same model that this program wrote here before are replaced, and removed where the series is shorter now.
    Nothing is written if another file has a name of the series. All files are written to a folder aside first. A run waits while
    another run writes into `folder`.

    Returns
    -------
    list of Path
        The VTM files, in the order of the load parameters.

    Raises
    ------
    OutputError
        If there is no room, or a file is there that this program did not write.
    """
    model, units = response.model, field_units(scene)
    with alone_in(folder):
        check_series(folder, model, scene)
        with staging(folder) as aside:
            files, sets = list[str](), list[str]()
            for k in range(len(response.load_parameter)):
                grids = blocks(response, scene, k)
                whole, *parts = _names(model, k, len(grids))
                for name, grid in zip(parts, grids.values(), strict=True):
                    write_grid(aside / name, grid, units)
                fields = set().union(*(grid.point_data for grid in grids.values()))
                there = {field: unit for field, unit in units.items() if field in fields}
                write_blocks(aside / whole, dict(zip(grids, parts, strict=True)), there)
                files += [*parts, whole]
                sets.append(whole)
            write_list(aside / f"{model}.pvd", zip(response.load_parameter.tolist(), sets, strict=True))
            series = re.compile(re.escape(model) + r"-\d{4,}(\.vtm|-\d+\.vtu)")
            with interrupts_held():
                earlier = own(folder, (path.name for path in folder.iterdir() if series.fullmatch(path.name)))
                move(aside, folder, [*files, f"{model}.pvd"])
                # last, so that no list names a file that is gone
                for name in earlier - set(files):
                    (folder / name).unlink()
    return [folder / name for name in sets]


class Series(NamedTuple):
    """The `blocks` of a model's answer at load parameter k, its load parameters (s,), and the units of the fields by name."""

    title: str
    load_parameter: Array
    blocks: Callable[[int], Mapping[str, Grid]]
    units: Mapping[str, str]


def solved_series(response: Response, scene: Scene, title: str) -> Series:
    """Return the series of a response."""
    return Series(title, response.load_parameter, lambda k: blocks(response, scene, k), field_units(scene))


def read_series(folder: Path) -> list[Series]:
    """Return the series of the PVD files in a folder or in the folders in it, as `write_series` writes them.

    Raises
    ------
    OutputError
        One line, if there is none or one cannot be read.
    """
    files = sorted(folder.glob("*.pvd")) or sorted(folder.glob("*/*.pvd"), reverse=True)
    if not files:
        raise OutputError(
            f"{folder}: has no PVD file, `crossval solve --out` and `crossval compare` write them"
        )
    return [_read(path) for path in files]


def _read(path: Path) -> Series:
    entries = read_entries(path, "timestep")
    times = np.array([float(t) for t, _ in entries])

    def read(k: int) -> dict[str, Grid]:
        return {name: read_grid(file) for name, file in read_entries(entries[k][1], "name")}

    return Series(path.stem, times, read, read_units(entries[0][1]) if entries else {})
