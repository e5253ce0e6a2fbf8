"""The answers of a model as files for ParaView.

A load parameter has one VTU file for each beam, one for the contacts, one for the supports, and a VTM file that names these blocks.
The PVD file lists the load parameters.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from comparisons.files import OutputError, alone_in, check_free, interrupts_held, move, own, staging
from comparisons.response import Array, Grid, Response
from comparisons.scene import ContactSpec, Scene
from comparisons.scene.conditions import COMPONENTS
from comparisons.show.symbols import inward
from comparisons.show.vtk import read_entries, read_grid, read_units, write_blocks, write_grid, write_list

CONTACTS, SUPPORTS, HINGES = POINTS = ("contact points", "support points", "hinge points")
"""Names of the blocks besides the beams; no beam has a name with a space."""
DIMENSIONS = {
    "displacement": "L", "deformed": "L", "rotation": "rad", "N": "F", "V": "F", "M": "F L", "arc": "L", "height": "L",
    "stress_xx": "F/L^2", "stress_yy": "F/L^2", "stress_xy": "F/L^2", "von_mises": "F/L^2", "axial_stress": "F/L^2",
    "axial_stress_right": "F/L^2", "axial_stress_left": "F/L^2",
    "beam_displacement": "L", "contact_force": "F", "gap": "L", "radius": "L", "tangential": "F", "normal": "F", "dissipated": "F L",
    "reaction_force": "F", "reaction_moment": "F L",
}  # fmt: skip
"""Dimensions of the fields, in force F and length L; other fields are plain numbers."""


def field_units(scene: Scene) -> dict[str, str]:
    """Return the units of all fields in the scene's units of force and length."""
    force, length = (unit.strip() for unit in scene.units.split(","))
    symbols = {"F": force, "L": length}
    return {
        name: "".join(symbols.get(letter, letter) for letter in dimension)
        for name, dimension in DIMENSIONS.items()
    }


def blocks(response: Response, scene: Scene, k: int) -> dict[str, Grid]:
    """Return the grids of a load parameter by name: every beam with its fields, then those of `POINTS` that the scene has.

    Every point of a beam has the index: 0 where the equilibrium is stable, -1 where it is not known.
    """
    grid, found = response.grid(k), {}
    for number, beam in enumerate(scene.beams):
        own = grid.point_data["beam"] == number
        place = np.cumsum(own) - 1
        cells = {kind: place[table[own[table[:, 0]]]] for kind, table in grid.cells.items()}
        data = {name: values[own] for name, values in grid.point_data.items() if name != "beam"}
        if response.index is not None:
            data["index"] = np.full(own.sum(), int(response.index[k]))
        found[beam.name] = Grid(points=grid.points[own], cells=cells, point_data=data)
    if scene.contacts:
        found[CONTACTS] = contact_points(response, scene, k)
    if scene.holding:
        found[SUPPORTS] = support_points(response, scene, k)
    if scene.hinges:
        found[HINGES] = hinge_points(response, scene, k)
    return found


def contact_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the nodes of the contacts, in the order of the scene: pins, and ends that touch another beam.

    The fields are the displacement, the radius of a pin, the displacement of the beam where it is touched (of the node where the pair
    is open), the contact force on the beam, and the gap (nan without contact). With friction there are `tangential`, `normal`,
    `slip` and `dissipated` of `FrictionHistory` too, nan at a contact without. A model that states no force vectors has one pair,
    whose force is the one that the supports balance.
    """
    rows = [_contact(response, scene, contact, k) for contact in scene.contacts]
    start, deformed, beside, force = (np.array(column) for column in zip(*rows, strict=True))
    histories = [response.contacts[contact.pair] for contact in scene.contacts]
    data = {
        "beam_displacement": beside,
        "radius": np.array([scene.radius(contact) for contact in scene.contacts]),
        "contact_force": force,
        "gap": np.array([history.gap[k] for history in histories]),
    }
    rubbed = [history.friction for history in histories]
    if any(rubbed):
        for name in ("tangential", "normal", "slip", "dissipated"):
            data[name] = np.array([np.nan if one is None else getattr(one, name)[k] for one in rubbed])
    return _points(start, deformed, data)


def _contact(response: Response, scene: Scene, contact: ContactSpec, k: int) -> tuple[Array, ...]:
    """Return a contact's undeformed and deformed place, the displacement where it touches, and the force."""
    name, _, end = contact.node.partition(".")
    if end:
        start, deformed = np.array(scene.place(contact.node)), _end(response, name, end, k)
    else:
        pin = scene.pin(name)
        start, deformed = np.array(pin.points[0]), np.array(pin.position(float(response.load_parameter[k])))
    history, moved = response.contacts[contact.pair], deformed - start
    arc = float(history.arc_position[k])
    if np.isfinite(arc):
        stations, line = response.axis_line(contact.beam, k)
        beam = scene.beam(contact.beam)
        at = np.array([np.interp(arc, stations, line[:, i]) for i in (0, 1)])
        moved = at - np.array(beam.place(arc / beam.length))
    if history.vector is not None:
        return start, deformed, moved, history.vector[k]
    return start, deformed, moved, -sum((one.force[k] for one in response.supports.values()), np.zeros(2))


def support_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the ends on supports and springs: displacement, force and moment on the beam, and what a picture of them needs.

    `held` has 1 for each component x, y and rotation that a support holds, 2 for one that a spring resists; `inward` is the unit vector
    into the beam. What a model does not state is nan.
    """
    start = np.array([scene.place(one.node) for one in scene.holding])
    reactions = [response.supports.get(one.node) for one in scene.all_supports]
    reactions += [response.springs.get(one.node) for one in scene.springs]
    kinds = [1] * len(scene.all_supports) + [2] * len(scene.springs)
    held = [[name in one.held for name in COMPONENTS] for one in scene.holding]
    data = {
        "reaction_force": np.array(
            [np.full(2, np.nan) if one is None else one.force[k] for one in reactions]
        ),
        "reaction_moment": np.array([np.nan if one is None else one.moment[k] for one in reactions]),
        "held": np.array(kinds)[:, None] * np.array(held),
        "inward": np.array([inward(scene, one) for one in scene.holding]),
    }
    return _points(start, np.array([_end(response, one.beam, one.end, k) for one in scene.holding]), data)


def hinge_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the hinges: displacement."""
    start = np.array([scene.place(one.node) for one in scene.hinges])
    return _points(start, np.array([_end(response, one.beam, one.end, k) for one in scene.hinges]), {})


def _points(start: Array, deformed: Array, data: dict[str, Array]) -> Grid:
    """Return places as a grid of points with their displacement and other fields."""
    cells = {"vertex": np.arange(len(start)).reshape(-1, 1)}
    return Grid(
        points=start, cells=cells, point_data={"displacement": deformed - start, "deformed": deformed, **data}
    )


def _end(response: Response, beam: str, end: str, k: int) -> Array:
    """Return the deformed position of a beam's end."""
    return np.asarray(response.axis_line(beam, k)[1][0 if end == "start" else -1])


def check_series(folder: Path, model: str, scene: Scene) -> None:
    """Raise unless the files of a series may be written: each is not there yet, or is as this program wrote it.

    Raises
    ------
    OutputError
        One line, with the first file in the way.
    """
    count = len(scene.beams) + sum(map(bool, (scene.contacts, scene.holding, scene.hinges)))
    names = [
        name
        for k in range(len(scene.times))
        for name in (_set(model, k), *(_file(model, k, number) for number in range(count)))
    ]
    check_free(folder, *names, _list(model))


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
    with alone_in(folder):
        check_series(folder, response.model, scene)
        with staging(folder) as aside:
            entries, files = _write_blocks(aside, response, scene)
            write_list(aside / _list(response.model), entries)
            with interrupts_held():
                move(aside, folder, [*files, _list(response.model)])
                # last, so that no list names a file that is gone
                for name in _earlier(folder, response.model) - set(files):
                    (folder / name).unlink()
    return [folder / name for _, name in entries]


def _set(model: str, k: int) -> str:
    """Name of the file of all blocks at the load parameter numbered k from 0."""
    return f"{model}-{k + 1:04d}.vtm"


def _file(model: str, k: int, number: int) -> str:
    """Name of the file of a block, by its number: names of beams may differ in capitals only, which some systems do not tell apart."""
    return f"{model}-{k + 1:04d}-{number}.vtu"


def _list(model: str) -> str:
    """Name of the list of a series."""
    return f"{model}.pvd"


def _earlier(folder: Path, model: str) -> set[str]:
    """Names of the sets and blocks of a model that this program wrote in `folder`."""
    series = re.compile(re.escape(model) + r"-\d{4,}(\.vtm|-\d+\.vtu)")
    return own(folder, (path.name for path in folder.iterdir() if series.fullmatch(path.name)))


def _write_blocks(
    folder: Path, response: Response, scene: Scene
) -> tuple[list[tuple[float, str]], list[str]]:
    """Write every block; return load parameter and name of every set of blocks, and the names of all files."""
    entries, names = [], []
    units = field_units(scene)
    for k, t in enumerate(response.load_parameter):
        grids = blocks(response, scene, k)
        files = {name: _file(response.model, k, number) for number, name in enumerate(grids)}
        for name, grid in grids.items():
            write_grid(folder / files[name], grid, units)
        fields = {field for grid in grids.values() for field in grid.point_data}
        there = {field: unit for field, unit in units.items() if field in fields}
        write_blocks(folder / _set(response.model, k), files, there)
        entries.append((float(t), _set(response.model, k)))
        names += [*files.values(), _set(response.model, k)]
    return entries, names


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
        The blocks at load parameter k, as `blocks` gives them.
    units : mapping of str
        Units of the fields by name.
    """

    title: str
    load_parameter: Array
    blocks: Callable[[int], Mapping[str, Grid]]
    units: Mapping[str, str]


def solved_series(response: Response, scene: Scene, title: str) -> Series:
    """Return the series of a response."""
    return Series(
        title=title,
        load_parameter=response.load_parameter,
        blocks=lambda k: blocks(response, scene, k),
        units=field_units(scene),
    )


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
    return Series(
        title=path.stem,
        load_parameter=np.array([float(t) for t, _ in entries]),
        blocks=lambda k: {name: read_grid(file) for name, file in read_entries(entries[k][1], "name")},
        units=read_units(entries[0][1]) if entries else {},
    )
