"""A picture of stressed bodies: quadrilaterals with a stress, contacts with forces, supports; its scale.

Beams are ribbons of their height, so that beams and solids are shown on one footing.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import CONTACT_STATES, OPEN, SLIPS, Array, Grid, Response
from comparisons.report.export import CONTACTS, HINGES, POINTS, SUPPORTS, blocks
from comparisons.report.palette import PIN
from comparisons.report.symbols import HINGE, LEFT, SYMBOL, Segments, at_arcs, fixings
from comparisons.scene import Scene

Body = tuple[Array, Array]
"""Quadrilaterals (m, 4, 2) of a deformed body, and the stress (m, 4) at their corners."""
QUARTERS = {
    "quad9": np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]),
    "quad": np.array([[0, 1, 2, 3]]),
}
"""The quadrilaterals in the cells of a solid, in VTK's order of points."""
PARTS, LAYERS = 8, (4, 8)
"""Quadrilaterals along an element of a beam, and over its height for a stress linear in it or not."""
VISIBLE = 0.06
"""Least height of the tallest beam in a picture of stress, over the size of the undeformed beams; its heights are enlarged to it."""
THIN = 2e-3
"""Height of a beam whose section has none, over the size of the picture."""
ARROW = 0.2
"""Length of the longest arrow over the size of the picture."""
COLOURS = {OPEN: CONTACT_STATES[OPEN], "contact": PIN, **CONTACT_STATES}
"""Colours of contacts by their state, the open ones first, below the others; a closed one without friction is a ``contact``."""


class Panel(NamedTuple):
    """Deformed bodies as m quadrilaterals, the p nodes that touch them, pins and ends of other beams, and the supports."""

    title: str
    quads: Array  #: Shape (m, 4, 2).
    stress: Array  #: At the corners (m, 4).
    pins: Array  #: Places of the nodes (p, 2).
    radii: Array  #: Zero for a point (p,).
    #: What the nodes exert on the beams, drawn as arrows; zero where none are to be drawn (p, 2).
    forces: Array
    states: NDArray[np.str_]  #: Keys of `COLOURS` (p,).
    supports: Segments  #: The symbols of supports, springs and hinges (l, 2, 2).

    def outline(self) -> list[Array]:
        """Return points (..., 2) within which all is drawn but the arrows."""
        reach = self.radii[:, None]
        parts = (self.quads, self.pins + reach, self.pins - reach, self.supports)
        return [part.reshape(-1, 2) for part in parts]


def mises_panels(beams: Response, solid: Response, scene: Scene, t: float) -> tuple[list[Panel], float]:
    """Return the von Mises stress of beams, of the solid, and of beams less solid on the body of the solid, at the nearest load parameter.

    In a beam it is that of the rectangle with its area and second moment: ``sigma^2 = sigma_x^2 + 3 tau^2``
    with ``sigma_x = N/A - M y/I`` and ``tau = 3/2 V/A (1 - (2 y/h)^2)``. Distances from the axes are enlarged by the factor that is
    returned, so that the bodies are `VISIBLE`. There are no arrows, which would hide the bodies.
    """
    steps = [int(np.argmin(np.abs(one.load_parameter - t))) for one in (beams, solid)]
    ribbons, bodies = (blocks(one, scene, k) for one, k in zip((beams, solid), steps, strict=True))
    less = dict(bodies)
    reach = np.ptp(np.concatenate([ribbons[beam.name].points for beam in scene.beams]), axis=0).max()
    wide = max(1.0, round(VISIBLE * reach / max(beam.rectangle_height for beam in scene.beams)))
    for beam in scene.beams:
        data, body = ribbons[beam.name].point_data, bodies[beam.name]
        area, inertia, _ = np.array([beam.section(part) for part in data["arc"] / beam.length]).T
        height = np.sqrt(12.0 * inertia / area)
        direct, bent = data["N"] / area, data["M"] * height / (2.0 * inertia)
        data["axial_stress_right"], data["axial_stress_left"] = direct + bent, direct - bent
        data["shear_stress"], data["height"] = 1.5 * data["V"] / area, wide * height
        y, fraction = np.array([beam.projected(point) for point in body.points.tolist()]).T
        arc = fraction * beam.length
        middle = at_arcs(arc, *solid.axis_line(beam.name, steps[1]))
        body.point_data["deformed"] = middle + wide * (body.point_data["deformed"] - middle)
        stress = _stress(data, data["arc"], arc, 2.0 * y / np.interp(arc, data["arc"], height))
        apart = {"von_mises": stress - body.point_data["von_mises"]}
        less[beam.name] = replace(body, point_data=body.point_data | apart)
    named = {"beams": ribbons, "the solid": bodies, "beams less solid": less}
    found = [panel(grids, title, stress="von_mises") for title, grids in named.items()]
    return [one._replace(forces=0.0 * one.forces) for one in found], wide


def panel(
    grids: Mapping[str, Grid], title: str, factor: float = 1.0, *, stress: str = "axial_stress"
) -> Panel:
    """Return a state, given as its `blocks`, with displacements enlarged by `factor`."""
    structure = [grid for name, grid in grids.items() if name not in POINTS]
    size = float(np.ptp(np.concatenate([grid.points for grid in structure]), axis=0).max())
    bodies = [_body(grid, stress, size, factor) for grid in structure]
    quads, stresses = map(np.concatenate, zip(*bodies, strict=True))
    none = dict.fromkeys(("contact_force", "beam_displacement", "deformed"), np.zeros((0, 2)))
    contacts = grids[CONTACTS].point_data if CONTACTS in grids else {**none, "radius": np.zeros(0)}
    forces = contacts["contact_force"]
    slips = contacts.get("slip", np.full(len(forces), np.nan))
    symbols = [place + SYMBOL * size * symbol for place, symbol in _symbols(grids, factor)]
    return Panel(
        title=title if factor == 1.0 else f"{title}, deformation x {factor:g}",
        quads=quads,
        stress=stresses,
        pins=contacts["deformed"] + (factor - 1.0) * contacts["beam_displacement"],
        radii=contacts["radius"],
        forces=forces,
        states=np.array([_state(*one) for one in zip(forces, slips, strict=True)], dtype=str),
        supports=np.concatenate([np.zeros((0, 2, 2)), *symbols]),
    )


def _body(grid: Grid, stress: str, size: float, factor: float) -> Body:
    """Return a deformed body with one of its stresses: a solid, or the ribbon of a beam."""
    found = [grid.cells[kind][:, own].reshape(-1, 4) for kind, own in QUARTERS.items() if kind in grid.cells]
    if not found:
        return _ribbon(grid, size, factor)
    quads = np.concatenate(found)
    return _enlarged(grid, factor)[quads], grid.point_data[stress][quads]


def _enlarged(grid: Grid, factor: float) -> Array:
    return np.asarray(grid.point_data["deformed"] + (factor - 1.0) * grid.point_data["displacement"])


def _ribbon(grid: Grid, size: float, factor: float) -> Body:
    """Return the ribbon of a beam's height about the cubics through its points, with their rotations if it has some."""
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    steps = np.hypot(*np.diff(grid.points, axis=0).T)
    arc, own = np.unique(np.append(0.0, np.cumsum(steps)), return_index=True)  # a jump has two points
    data = {name: values[own] for name, values in grid.point_data.items()}
    start = CubicSpline(arc, grid.points[own])(arc, 1)
    tangent = CubicSpline(arc, data["deformed"])(arc, 1)
    if "rotation" in data:
        turn = data["rotation"][:, None]
        tangent = np.cos(turn) * start + np.sin(turn) * start @ LEFT
    curve = CubicHermiteSpline(arc, _enlarged(grid, factor)[own], start + factor * (tangent - start))
    count = len(arc) - 1
    at = np.interp(np.linspace(0.0, count, PARTS * count + 1), np.arange(count + 1), arc)
    along = curve(at, 1)
    normal = along @ LEFT / np.hypot(*along.T)[:, None]

    height = np.interp(at, arc, data.get("height", 0.0 * arc))[:, None]
    half = np.where(height > 0.0, height, THIN * size) / 2.0
    across = np.linspace(-1.0, 1.0, LAYERS["shear_stress" in data] + 1)
    stress = _stress(data, arc, at[:, None], across)
    points = curve(at)[:, None] + (half * across)[..., None] * normal[:, None]

    def corners(values: Array) -> Array:
        found = (values[:-1, :-1], values[1:, :-1], values[1:, 1:], values[:-1, 1:])
        return np.stack(found, axis=2).reshape(-1, 4, *values.shape[2:])

    return corners(points), corners(stress)


def _stress(data: Mapping[str, Array], arc: Array, at: Array, across: Array) -> Array:
    """Return the stress of a beam at arc lengths and at parts of half its height, from what it has at the arc lengths `arc`."""

    def read(name: str) -> Array:
        return np.asarray(np.interp(at, arc, data.get(name, 0.0 * arc)))

    direct = read("axial_stress_right") * (1 - across) / 2 + read("axial_stress_left") * (1 + across) / 2
    if "shear_stress" not in data:
        return direct
    return np.asarray(np.sqrt(direct**2 + 3.0 * (read("shear_stress") * (1.0 - across**2)) ** 2))


def _symbols(grids: Mapping[str, Grid], factor: float) -> Iterator[tuple[Array, Segments]]:
    """Yield the symbols of supports, springs and hinges with their places."""
    for place in _enlarged(grids[HINGES], factor) if HINGES in grids else ():
        yield place, HINGE
    if SUPPORTS in grids:
        data, places = grids[SUPPORTS].point_data, _enlarged(grids[SUPPORTS], factor)
        for place, kinds, away in zip(places, data["held"], data["inward"], strict=True):
            yield from ((place, symbol) for _, symbol in fixings(kinds, away))


def _state(force: Array, slip: float) -> str:
    if not force.any():
        return OPEN
    return "contact" if np.isnan(slip) else str(SLIPS[int(slip)])


class Scale(NamedTuple):
    """What pictures of panels share."""

    centre: Array  #: Of the view.
    extent: Array  #: Half the width and half the height of the view.
    stress: tuple[float, float]  #: The lowest and the highest one of the colours.
    force: float  #: Length of an arrow per force.
    label: str  #: Of the colours.
    arrow: str = ""  #: What the longest arrow is, nothing without forces.

    @classmethod
    def of(cls, panels: Sequence[Panel], label: str, unit: str = "") -> "Scale":
        """Return the scale that shows all of `panels`, with forces in `unit`; the colours of a stress with both signs are symmetric."""
        points = np.concatenate([part for one in panels for part in one.outline()])
        largest = max(float(np.hypot(*one.forces.T).max(initial=0.0)) for one in panels)
        force = ARROW * float(np.ptp(points, axis=0).max()) / (largest or 1.0)
        points = np.concatenate([points, *(one.pins - force * one.forces for one in panels)])
        low, high = points.min(axis=0), points.max(axis=0)
        top = max(float(np.abs(one.stress).max()) for one in panels)
        signed = any(float(one.stress.min()) < 0.0 for one in panels)
        return cls(
            centre=(low + high) / 2.0,
            extent=(high - low) / 2.0,
            stress=(-top if signed else 0.0, top),
            force=force if largest else 0.0,
            label=label,
            arrow=f"longest arrow {largest:.4g} {unit}".strip() if largest else "",
        )

    @property
    def half(self) -> float:
        """Half the size of what is shown."""
        return float(self.extent.max())

    @property
    def colours(self) -> str:
        """Name of the colour map: from blue over grey to yellow where the stress has both signs. Its brightness grows with the stress."""
        return "cividis" if self.stress[0] < 0.0 else "viridis"
