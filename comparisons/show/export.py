"""The answers of a model as files for ParaView.

A load parameter has one VTU file for each beam, one for the contacts, one for the supports, and a VTM file that names these blocks.
The PVD file lists the load parameters.
"""

import re
from pathlib import Path

import numpy as np

from comparisons.files import alone_in, check_free, interrupts_held, move, own, staging, write_text
from comparisons.response import Array, Grid, Response
from comparisons.scene import ContactSpec, Scene
from comparisons.scene.conditions import COMPONENTS
from comparisons.show.symbols import inward
from comparisons.show.vtu import blocks_text, grid_text, series_text

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
    grid = response.grid(k)
    found = {beam.name: _part(grid, number) for number, beam in enumerate(scene.beams)}
    if response.index is not None:
        for part in found.values():
            part.point_data["index"] = np.full(len(part.points), int(response.index[k]))
    return {**found, **nodes(response, scene, k)}


def nodes(response: Response, scene: Scene, k: int) -> dict[str, Grid]:
    """Return the contacts, supports and hinges of a load parameter, as far as the scene has them."""
    found = {}
    if scene.contacts:
        found[CONTACTS] = contact_points(response, scene, k)
    if scene.holding:
        found[SUPPORTS] = support_points(response, scene, k)
    if scene.hinges:
        found[HINGES] = hinge_points(response, scene, k)
    return found


def _part(grid: Grid, beam: int) -> Grid:
    """Return the part of a grid that belongs to one beam."""
    own = grid.point_data["beam"] == beam
    number = np.cumsum(own) - 1
    cells = {kind: number[table[own[table[:, 0]]]] for kind, table in grid.cells.items()}
    return Grid(
        points=grid.points[own],
        cells=cells,
        point_data={name: values[own] for name, values in grid.point_data.items() if name != "beam"},
    )


def contact_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the nodes of the contacts, in the order of the scene: pins, and ends that touch another beam.

    The fields are the displacement, the radius of a pin, the displacement of the beam where it is touched (of the node where the pair
    is open), the contact force on the beam, and the gap (nan without contact). With friction there are `tangential`, `normal`,
    `slip` and `dissipated` of `FrictionHistory` too, nan at a contact without. A model that states no force vectors has one pair,
    whose force is the one that the supports balance.
    """
    start = np.array([_undeformed(scene, contact) for contact in scene.contacts]).reshape(-1, 2)
    deformed = np.array([_deformed(response, scene, contact, k) for contact in scene.contacts]).reshape(-1, 2)
    histories = [response.contacts[contact.pair] for contact in scene.contacts]
    force = np.zeros_like(start)
    beside = deformed - start
    for i, (contact, history) in enumerate(zip(scene.contacts, histories, strict=True)):
        held = sum(support.force[k] for support in response.supports.values())
        force[i] = -held if history.vector is None else history.vector[k]
        arc = float(history.arc_position[k])
        if np.isfinite(arc):
            beside[i] = _moved(response, scene, contact.beam, k, arc)
    data = {
        "displacement": deformed - start,
        "deformed": deformed,
        "beam_displacement": beside,
        "radius": np.array([scene.radius(contact) for contact in scene.contacts]),
        "contact_force": force,
        "gap": np.array([history.gap[k] for history in histories]),
    }
    rubbed = [history.friction for history in histories]
    if any(rubbed):
        for name in ("tangential", "normal", "slip", "dissipated"):
            data[name] = np.array([np.nan if one is None else getattr(one, name)[k] for one in rubbed])
    return _points(start, data)


def support_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the ends on supports and springs: displacement, force and moment on the beam, and what a picture of them needs.

    `held` has 1 for each component x, y and rotation that a support holds, 2 for one that a spring resists; `inward` is the unit vector
    into the beam. What a model does not state is nan.
    """
    start = np.array([scene.place(one.node) for one in scene.holding])
    displacement = np.array([_end(response, one.beam, one.end, k) for one in scene.holding]) - start
    reactions = [response.supports.get(one.node) for one in scene.all_supports]
    reactions += [response.springs.get(one.node) for one in scene.springs]
    force = [np.full(2, np.nan) if one is None else one.force[k] for one in reactions]
    moment = [np.nan if one is None else one.moment[k] for one in reactions]
    kinds = [1] * len(scene.all_supports) + [2] * len(scene.springs)
    data = {
        "displacement": displacement,
        "deformed": start + displacement,
        "reaction_force": np.array(force),
        "reaction_moment": np.array(moment),
        "held": np.array(
            [
                [kind * (name in one.held) for name in COMPONENTS]
                for kind, one in zip(kinds, scene.holding, strict=True)
            ]
        ),
        "inward": np.array([inward(scene, one) for one in scene.holding]),
    }
    return _points(start, data)


def hinge_points(response: Response, scene: Scene, k: int) -> Grid:
    """Return the hinges: displacement."""
    start = np.array([scene.place(one.node) for one in scene.hinges])
    deformed = np.array([_end(response, one.beam, one.end, k) for one in scene.hinges])
    return _points(start, {"displacement": deformed - start, "deformed": deformed})


def _points(points: Array, data: dict[str, Array]) -> Grid:
    return Grid(points=points, cells={"vertex": np.arange(len(points)).reshape(-1, 1)}, point_data=data)


def _undeformed(scene: Scene, contact: ContactSpec) -> tuple[float, float]:
    return scene.place(contact.node) if "." in contact.node else scene.pin(contact.node).points[0]


def _deformed(response: Response, scene: Scene, contact: ContactSpec, k: int) -> Array:
    name, _, end = contact.node.partition(".")
    if end:
        return _end(response, name, end, k)
    return np.array(scene.pin(name).position(float(response.load_parameter[k])))


def _end(response: Response, beam: str, end: str, k: int) -> Array:
    """Return the deformed position of a beam's end."""
    return np.asarray(response.axis_line(beam, k)[1][0 if end == "start" else -1])


def _moved(response: Response, scene: Scene, beam: str, k: int, arc: float) -> Array:
    """Return the displacement of a beam's axis at an arc position."""
    stations, line = response.axis_line(beam, k)
    place = np.array([np.interp(arc, stations, line[:, i]) for i in (0, 1)])
    spec = scene.beam(beam)
    return np.asarray(place - np.array(spec.place(arc / spec.length)))


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
            write_text(aside / _list(response.model), series_text(entries))
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
            write_text(folder / files[name], grid_text(grid, units))
        there = {
            field: unit for field, unit in units.items() if any(field in g.point_data for g in grids.values())
        }
        write_text(folder / _set(response.model, k), blocks_text(files, there))
        entries.append((float(t), _set(response.model, k)))
        names += [*files.values(), _set(response.model, k)]
    return entries, names
