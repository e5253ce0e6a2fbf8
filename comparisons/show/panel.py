"""What a picture of a stressed body shows: quadrilaterals with a stress, contacts with their forces, supports; and the scale of it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.response import CONTACT_STATES, OPEN, SLIPS, Array, Grid
from comparisons.scene.conditions import COMPONENTS
from comparisons.show.export import CONTACTS, HINGES, SUPPORTS
from comparisons.show.palette import PIN
from comparisons.show.symbols import Segments, hinge_symbol, placed, spring_symbol, support_symbol

Body = tuple[Array, NDArray[np.int64], Array]
"""Deformed positions (n, 2), quadrilaterals (m, 4) and stress (n,) of a body."""
ARROW = 0.2
"""Length of the longest arrow over the size of the picture."""
SYMBOL = 0.03
"""Size of a support's symbol over the size of the undeformed structure."""
COLOURS = {OPEN: CONTACT_STATES[OPEN], "contact": PIN, **CONTACT_STATES}
"""Colours of contacts by their state, the open ones first, below the others; a closed one without friction is a ``contact``."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Panel:
    """Deformed bodies as quadrilaterals with a stress at their points, the nodes that touch them, and the supports.

    Attributes
    ----------
    title : str
        What it shows.
    points : ndarray, shape (n, 2)
        Deformed positions.
    quads : ndarray of int, shape (m, 4)
        Points of the quadrilaterals.
    stress : ndarray, shape (n,)
        Stress, signed or not.
    pins : ndarray, shape (p, 2)
        Positions of pins, and of the ends of beams that touch other beams.
    radii : ndarray, shape (p,)
        Radii of the pins, zero for a point.
    forces : ndarray, shape (p, 2)
        What they exert on the beams, drawn as arrows; zero where none are to be drawn.
    states : ndarray of str, shape (p,)
        Keys of `COLOURS`.
    supports : ndarray, shape (l, 2, 2)
        Line segments of the symbols of supports, springs and hinges.
    """

    title: str
    points: Array
    quads: NDArray[np.int64]
    stress: Array
    pins: Array
    radii: Array
    forces: Array
    states: NDArray[np.str_]
    supports: Segments

    def pins_by_state(self) -> dict[str, NDArray[np.int64]]:
        """Return the numbers of the pins by their states, in the order of drawing."""
        found = {state: np.flatnonzero(self.states == state) for state in COLOURS}
        return {state: numbers for state, numbers in found.items() if len(numbers)}

    def outline(self) -> list[Array]:
        """Return points (..., 2) within which all is drawn but the arrows."""
        reach = self.radii[:, None]
        return [self.points, self.pins + reach, self.pins - reach, self.supports.reshape(-1, 2)]


def joined(title: str, bodies: Sequence[Body], drawn: Sequence[Mapping[str, NDArray[Any]]]) -> Panel:
    """Return a panel of bodies with their contacts and supports, `drawn`, as `marks` gives them: once, or for every one of several states."""
    starts = np.cumsum([0, *(len(points) for points, _, _ in bodies[:-1])])
    return Panel(
        title=title,
        points=np.concatenate([points for points, _, _ in bodies]),
        quads=np.concatenate([quads + start for (_, quads, _), start in zip(bodies, starts, strict=True)]),
        stress=np.concatenate([stress for _, _, stress in bodies]),
        **{name: np.concatenate([one[name] for one in drawn]) for name in drawn[0]},
    )


def marks(blocks: Mapping[str, Grid], size: float, factor: float = 1.0) -> dict[str, NDArray[Any]]:
    """Return the contacts and the supports among the blocks of `comparisons.show.export`: the fields of `Panel` but the body.

    Parameters
    ----------
    blocks : mapping of Grid
        The blocks by name.
    size : float
        Size of the undeformed structure [length].
    factor : float
        Enlargement of the deformation. A closed contact stays on its beam: it moves as the touched point does.
    """
    none = np.zeros((0, 2))
    data = blocks[CONTACTS].point_data if CONTACTS in blocks else {}
    forces = data.get("contact_force", none)
    slip = data.get("slip", np.full(len(forces), np.nan))
    found = {
        "pins": data.get("deformed", none) + (factor - 1.0) * data.get("beam_displacement", none),
        "radii": data.get("radius", np.zeros(0)),
        "forces": forces,
        "states": np.array([_state(*one) for one in zip(forces, slip, strict=True)], dtype=str),
    }
    segments = [np.zeros((0, 2, 2))]
    for place, symbols in _symbols(blocks, factor):
        segments += [placed(symbol, place, SYMBOL * size) for symbol in symbols]
    return {**found, "supports": np.concatenate(segments)}


def _symbols(blocks: Mapping[str, Grid], factor: float) -> Iterator[tuple[Array, list[Segments]]]:
    """Yield the places of supports, springs and hinges, and their symbols."""
    for name in (SUPPORTS, HINGES):
        if name not in blocks:
            continue
        data = blocks[name].point_data
        places = data["deformed"] + (factor - 1.0) * data["displacement"]
        if name == HINGES:
            yield from ((place, [hinge_symbol()]) for place in places)
            continue
        for held, away, place in zip(data["held"], data["inward"], places, strict=True):
            names, sprung = (
                tuple(name for name, one in zip(COMPONENTS, held, strict=True) if one == kind)
                for kind in (1, 2)
            )
            symbols = [support_symbol(names, away)] if names else []
            yield place, [*symbols, *(spring_symbol(name, away) for name in sprung)]


def _state(force: Array, slip: float) -> str:
    if not force.any():
        return OPEN
    return "contact" if np.isnan(slip) else str(SLIPS[int(slip)])


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What pictures of panels share.

    Attributes
    ----------
    centre : tuple of float
        Middle of the view.
    extent : tuple of float
        Half the width and half the height of what is shown.
    stress : tuple of float
        Lowest and highest stress of the colours.
    force : float
        Length of an arrow per force.
    label : str
        Label of the stress.
    arrow : str
        What the longest arrow is; empty without forces.
    """

    centre: tuple[float, float]
    extent: tuple[float, float]
    stress: tuple[float, float]
    force: float
    label: str
    arrow: str = ""

    @classmethod
    def of(cls, panels: Sequence[Panel], label: str, unit: str = "") -> "Scale":
        """Return the scale that shows all of `panels`, with forces in `unit`; the colours of a stress with both signs are symmetric."""
        points = [part for panel in panels for part in panel.outline()]
        largest = max(float(np.hypot(*panel.forces.T).max(initial=0.0)) for panel in panels)
        force = ARROW * float(np.ptp(np.concatenate(points), axis=0).max()) / (largest or 1.0)
        points += [panel.pins - force * panel.forces for panel in panels]
        low, high = (
            np.min([part.min(axis=0) for part in points if len(part)], axis=0),
            np.max([part.max(axis=0) for part in points if len(part)], axis=0),
        )
        extent = float(high[0] - low[0]) / 2.0, float(high[1] - low[1]) / 2.0
        top = max(float(np.abs(panel.stress).max()) for panel in panels)
        signed = any(float(panel.stress.min()) < 0.0 for panel in panels)
        return cls(
            centre=(float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0),
            extent=extent,
            stress=(-top if signed else 0.0, top),
            force=force if largest else 0.0,
            label=label,
            arrow=f"longest arrow {largest:.4g} {unit}".strip() if largest else "",
        )

    @property
    def half(self) -> float:
        """Half the size of what is shown."""
        return max(self.extent)

    @property
    def colours(self) -> str:
        """Name of the colour map: from blue over grey to yellow where the stress has both signs. Its brightness grows with the stress."""
        return "cividis" if self.stress[0] < 0.0 else "viridis"
