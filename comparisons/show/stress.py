"""The stress of beams and solids on one footing: von Mises stress on quadrilaterals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.response import CONTACT_STATES, SLIPS, Array, Response
from comparisons.scene import BeamSpec, Scene
from comparisons.show.palette import PIN

LAYERS = 8
"""Layers over the height of a beam's picture."""
QUAD9_QUARTERS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
"""The four quarters of a biquadratic quadrilateral in VTK's order of points."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Panel:
    """A deformed body as quadrilaterals with a stress at its points, and the pins.

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
        Positions of the pins.
    forces : ndarray, shape (p, 2)
        What they exert on the beams, drawn as arrows; zero where none are to be drawn.
    slip : ndarray, shape (p,)
        Sign of the slip of a pin with friction, 0 in stick; nan without friction or contact.
    """

    title: str
    points: Array
    quads: NDArray[np.int64]
    stress: Array
    pins: Array
    forces: Array
    slip: Array

    def pin_colours(self) -> dict[str, NDArray[np.int64]]:
        """Return the numbers of the pins by the colour in which they are drawn: of stick and slip with friction."""
        colours = [PIN if np.isnan(slip) else CONTACT_STATES[SLIPS[int(slip)]] for slip in self.slip]
        return {
            colour: np.flatnonzero(np.array(colours) == colour) for colour in (PIN, *CONTACT_STATES.values())
        }


@dataclass(frozen=True, kw_only=True)
class Scale:
    """What pictures of panels share.

    Attributes
    ----------
    centre : tuple of float
        Middle of the view.
    half : float
        Half the size of the view.
    stress : tuple of float
        Lowest and highest stress of the colours.
    force : float
        Length of an arrow per force.
    label : str
        Label of the stress.
    """

    centre: tuple[float, float]
    half: float
    stress: tuple[float, float]
    force: float
    label: str

    @classmethod
    def of(cls, panels: Sequence[Panel], label: str) -> "Scale":
        """Return the scale that shows all of `panels`; the colours of a stress with both signs are symmetric."""
        points = np.concatenate([part for panel in panels for part in (panel.points, panel.pins)])
        low, high = points.min(axis=0), points.max(axis=0)
        half = float((high - low).max()) / 2.0
        top = max(float(np.abs(panel.stress).max()) for panel in panels)
        signed = any(float(panel.stress.min()) < 0.0 for panel in panels)
        largest = max(float(np.hypot(*panel.forces.T).max(initial=0.0)) for panel in panels)
        return cls(
            centre=(float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0),
            half=half,
            stress=(-top if signed else 0.0, top),
            force=0.4 * half / largest if largest else 0.0,
            label=label,
        )

    @property
    def colours(self) -> str:
        """Name of the colour map: from blue over grey to red where the stress has both signs."""
        return "coolwarm" if self.stress[0] < 0.0 else "viridis"


def solid_panel(response: Response, scene: Scene, ks: list[int], title: str) -> Panel:
    """Return the solid's deformed shapes at the load parameters numbered `ks`.

    ``sigma^2 = sxx^2 - sxx syy + syy^2 + 3 sxy^2``, plane stress.
    """
    bodies = []
    for k in ks:
        grid = response.grid(k)
        xx, yy, xy = grid.point_data["cauchy_stress"].T
        quads = grid.cells["quad9"][:, QUAD9_QUARTERS].reshape(-1, 4)
        bodies.append((grid.point_data["deformed"], quads, np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2)))
    return _panel(bodies, response, scene, ks, title)


def beam_panel(response: Response, scene: Scene, ks: list[int], title: str) -> Panel:
    """Return the beams' deformed shapes at the load parameters numbered `ks`, as ribbons of the beams' heights (`BeamSpec.rectangle_height`).

    ``sigma_x = N/A - M y/I``, ``tau = V/(2 I) (h^2/4 - y^2)``, ``sigma^2 = sigma_x^2 + 3 tau^2``.
    """
    bodies = [_ribbon(response, scene, beam, k) for k in ks for beam in scene.beams]
    return _panel(bodies, response, scene, ks, title)


def _ribbon(
    response: Response, scene: Scene, beam: BeamSpec, k: int
) -> tuple[Array, NDArray[np.int64], Array]:
    height = beam.rectangle_height
    area, inertia, _ = beam.cross_section
    arc, line = response.axis_line(beam.name, k)
    tangent = np.gradient(line, axis=0)
    tangent /= np.hypot(*tangent.T)[:, None]
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    N, V, M = _section_forces(response, scene, beam, k, arc)
    y = np.linspace(-height / 2.0, height / 2.0, LAYERS + 1)
    points = line[:, None, :] + y[None, :, None] * normal[:, None, :]
    sigma = N[:, None] / area - M[:, None] * y / inertia
    tau = V[:, None] * (height**2 / 4.0 - y**2) / (2.0 * inertia)
    first = (np.arange(len(arc) - 1)[:, None] * len(y) + np.arange(LAYERS)).ravel()
    quads = np.stack([first, first + len(y), first + len(y) + 1, first + 1], axis=1)
    return points.reshape(-1, 2), quads, np.sqrt(sigma**2 + 3.0 * tau**2).ravel()


def _section_forces(
    response: Response, scene: Scene, beam: BeamSpec, k: int, arc: Array
) -> tuple[Array, ...]:
    """N, V, M at arc positions of one beam, linear inside its elements."""
    data = response.grid(k).point_data
    mine = data["beam"] == scene.beams.index(beam)
    return tuple(np.interp(arc, data["arc"][mine], data[name][mine]) for name in ("N", "V", "M"))


def _panel(
    bodies: list[tuple[Array, NDArray[np.int64], Array]],
    response: Response,
    scene: Scene,
    ks: list[int],
    title: str,
) -> Panel:
    starts = np.cumsum([0, *(len(points) for points, _, _ in bodies[:-1])])
    pins = [pin.position(float(response.load_parameter[k])) for k in ks for pin in scene.pins]
    return Panel(
        title=title,
        points=np.concatenate([points for points, _, _ in bodies]),
        quads=np.concatenate([quads + start for (_, quads, _), start in zip(bodies, starts, strict=True)]),
        stress=np.concatenate([stress for _, _, stress in bodies]),
        pins=np.array(pins).reshape(-1, 2),
        forces=np.zeros((len(pins), 2)),
        slip=np.full(len(pins), np.nan),
    )
