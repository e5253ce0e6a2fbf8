"""The stress of beams and solids on one footing: von Mises stress on quadrilaterals."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.response import Array, Response
from comparisons.scene import BeamSpec, Scene

LAYERS = 8
"""Layers over the height of a beam's picture."""
QUAD9_QUARTERS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
"""The four quarters of a biquadratic quadrilateral in VTK's order of points."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Panel:
    """A deformed body as quadrilaterals with a stress at its points.

    Attributes
    ----------
    title : str
        What it shows.
    points : ndarray, shape (n, 2)
        Deformed positions.
    quads : ndarray of int, shape (m, 4)
        Points of the quadrilaterals.
    stress : ndarray, shape (n,)
        Von Mises stress.
    pins : ndarray, shape (p, 2)
        Positions of the pins.
    """

    title: str
    points: Array
    quads: NDArray[np.int64]
    stress: Array
    pins: Array


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
    """Return the beams' deformed shapes at the load parameters numbered `ks`, as ribbons of the beams' heights.

    ``sigma_x = N/A - M y/I``, ``tau = V/(2 I) (h^2/4 - y^2)``, ``sigma^2 = sigma_x^2 + 3 tau^2``.
    """
    bodies = [_ribbon(response, scene, beam, k) for k in ks for beam in scene.beams]
    return _panel(bodies, response, scene, ks, title)


def _ribbon(
    response: Response, scene: Scene, beam: BeamSpec, k: int
) -> tuple[Array, NDArray[np.int64], Array]:
    height = beam.height or 0.0
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
        pins=np.array(pins),
    )
