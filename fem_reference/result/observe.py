"""Post-processing of a solution: axis lines, stresses, energies, section forces, material forces, and strains of the faces."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_reference.result.result import Result
from fem_reference.solid.assembly import deformation_gradient
from fem_reference.solid.mesh import Interpolation, interpolation, section_points
from fem_reference.statement.arrays import Floats, Ints, determinant
from fem_reference.system.body import Body
from fem_reference.system.state import State, stored_energy


def section_means(state: State, strip: str) -> Floats:
    """Section-mean positions ``(m, 2)`` of a strip in the global frame [m]."""
    body = state.model.body(strip)
    return body.mesh.sections @ (body.mesh.nodes + state.u[body.part]) + body.strip.start


def axis_line(result: Result, strip: str, k: int) -> Floats:
    """Section means ``(m, 2)`` from start to end at the accepted load parameter ``k``, in the global frame [m]."""
    state = result.states[k]
    before, bent = _bent_sections(result, strip)
    origin = np.array(result.model.problem.strips[0].start)
    means = np.reshape([origin + state.poses[number].position for _, number in bent], (-1, 2))
    return np.insert(section_means(state, strip), before, means, axis=0)


def axis_stations(result: Result, strip: str) -> Floats:
    """Undeformed axial coordinates ``(m,)`` of the points in `axis_line` [m]: the mesh's sections, and those inside that bear a moment."""
    before, bent = _bent_sections(result, strip)
    return np.insert(result.model.body(strip).mesh.stations, before, [arc for arc, _ in bent])


def _bent_sections(result: Result, strip: str) -> tuple[Ints, list[tuple[float, int]]]:
    """Places among the mesh's sections, coordinates and numbers of the sections that bear a moment between two of them."""
    body = result.model.body(strip)
    stations, apart = body.mesh.stations, 1e-9 * body.strip.length
    bent = sorted(
        (section.arc, number)
        for number, section in enumerate(result.model.sections)
        if section.strip == strip and np.abs(stations - section.arc).min() > apart
    )
    return np.searchsorted(stations, [arc for arc, _ in bent]), bent


def nodal_stress(result: Result, k: int) -> Floats:
    """Cauchy stresses ``xx, yy, xy`` at the nodes, ``(n, 3)``, in the global frame [Pa].

    ``sigma = P F^T / det F`` is the force per current length in the plane and per reference thickness. It is evaluated at
    the nodes of every element and averaged over the elements with a common node.
    """
    return _at_nodes(result, k, lambda _, __, sigma: sigma[[0, 1, 0], [0, 1, 1]])


def fibre_stress(result: Result, k: int) -> Floats:
    """Cauchy stress ``t . sigma t`` ``(n,)`` at the nodes, with the unit vector t along the deformed fibre along the axis [Pa]."""

    def along(body: Body, F: Floats, sigma: Floats) -> Floats:
        T, _ = body.strip.directions(body.mesh.places[body.mesh.cells, 0])
        t = np.einsum("ijek,jek->iek", F, T)
        return np.einsum("iek,ijek,jek->ek", t, sigma, t)[None] / (t**2).sum(axis=0)

    return _at_nodes(result, k, along)[:, 0]


def _at_nodes(result: Result, k: int, values: Callable[[Body, Floats, Floats], Floats]) -> Floats:
    """Means ``(n, c)`` over the elements with a common node of ``values`` ``(c, e, k)`` of gradients and Cauchy stresses."""
    found = []
    for body in result.model.bodies:
        F = deformation_gradient(body.mesh, result.states[k].u[body.part], body.mesh.at_nodes)
        area, cells = determinant(F), body.mesh.cells.ravel()
        own = values(body, F, np.einsum("ikeq,jkeq->ijeq", body.law.stress(F), F) / area)
        found.append(body.mesh.gather @ own.reshape(len(own), -1).T / np.bincount(cells)[:, None])
    return np.concatenate(found)


def energy(result: Result, k: int) -> tuple[float, float]:
    """Strain energy and contact energy ``eps g^2 / 2`` at the accepted load parameter ``k`` [J]."""
    return stored_energy(result.states[k])


@dataclass(frozen=True, kw_only=True, eq=False)
class SectionForces:
    """Stress resultants of undeformed sections: the action of the part towards the end on the part towards the start.

    All arrays have the shape ``(m,)`` unless stated.

    Parameters
    ----------
    stations
        Undeformed axial coordinates [m].
    N, V
        Normal force, positive in tension, and shear force, positive to the left of the axis [N].
    M
        Moment about the section mean, anticlockwise positive [N m].
    rotation
        Rotation of the section from the global x axis [rad].
    force
        Resultant of N and V in the global frame, ``(m, 2)`` [N].
    material_force
        J-integral ``integral (P N . F N - W) dA`` [N]. In a straight strip of one section without loads inside, it is constant between contacts and differs on the two sides of a contact by
        the tangential force. It vanishes beyond the last contact of a free end.
    """

    stations: Floats
    N: Floats
    V: Floats
    M: Floats
    rotation: Floats
    force: Floats
    material_force: Floats


def section_forces(result: Result, strip: str, k: int, stations: Floats | None = None) -> SectionForces:
    """Integrate the stress over sections of a strip at the accepted load parameter ``k``.

    The first Piola-Kirchhoff stress P gives the traction ``p = P N`` of an undeformed section with the normal N with mean position ``x_m``.
    Force and moment are ``f = integral p dA`` and ``M = integral (x - x_m) x p dA``. N and V are the components of f on
    the axes of the rotated section. The rotation is the least-squares fit of ``x - x_m`` to the undeformed section.

    Parameters
    ----------
    result, strip, k
        Solution, name of the strip and number of the load parameter.
    stations
        Undeformed axial coordinates [m]; None for the two Gauss points of each element along the strip, at which the
        stress of biquadratic elements is most accurate.
    """
    body = result.model.body(strip)
    own = body.strip
    X, points, shares, heights, at = _sections(body, None if stations is None else tuple(stations))
    # of the points ``(m, q)`` in integrals over the sections
    weights = (own.width_at(X) * heights)[:, None] * shares
    u, F = at.of(result.states[k].u[body.part])
    W, P = body.law.energy(F), body.law.stress(F)
    N, _ = own.directions(points[:, 0])
    places = (own.placed(points) + u) @ (1, 1j)
    # positions and vectors in the complex plane
    p, along = ((np.array([1, 1j]) @ np.einsum("ijp,jp->ip", A, N)).reshape(weights.shape) for A in (P, F))
    x, y = (
        part - (part @ shares)[:, None] for part in np.reshape([places, points[:, 1]], (2, *weights.shape))
    )
    rotation = np.angle(-1j * (weights * y * x).sum(axis=1) * own.direction.conjugate())
    rotation += np.angle(own.direction)
    f = (weights * p).sum(axis=1)
    turned = f * np.exp(-1j * rotation)
    return SectionForces(
        stations=X,
        N=turned.real,
        V=turned.imag,
        M=(weights * (x.conj() * p).imag).sum(axis=1),
        rotation=rotation,
        force=np.stack([f.real, f.imag], axis=1),
        material_force=(weights * ((p.conj() * along).real - W.reshape(weights.shape))).sum(axis=1),
    )


@lru_cache(maxsize=1)  # one body, which is asked for one load parameter after another
def _sections(
    body: Body, stations: tuple[float, ...] | None
) -> tuple[Floats, Floats, Floats, Floats, Interpolation]:
    """Stations, Gauss points, shares and heights of sections, see `section_points`, and the interpolation at the points."""
    X = gauss_stations(body) if stations is None else np.array(stations)
    points, shares, heights = section_points(body.strip, body.mesh.places, body.mesh.edges, X)
    return X, points, shares, heights, interpolation(body.mesh, points)


def gauss_stations(body: Body) -> Floats:
    """Axial coordinates ``(2 n,)`` of two-point Gauss rules between the element corners on the right face [m]."""
    corners = np.unique(body.mesh.cells[:, :4])
    face = body.mesh.edges["right"]
    x = body.mesh.places[face[np.isin(face, corners)], 0]
    offsets = (1 + np.array([-1.0, 1.0]) / np.sqrt(3)) / 2
    return (x[:-1, None] + offsets * np.diff(x)[:, None]).ravel()


def face_strains(result: Result, strip: str, k: int) -> tuple[Floats, dict[str, Floats]]:
    """Engineering strains along the two faces at the accepted load parameter ``k``.

    Returns
    -------
    stations : (m,)
        Axial coordinates from `gauss_stations` [m].
    strains : dict
        ``|F T| - 1`` ``(m,)`` by face, ``"right"`` and ``"left"``, with the unit tangent T of the undeformed face.
    """
    body = result.model.body(strip)
    X = gauss_stations(body)
    strains = {}
    for name in ("right", "left"):
        face = body.mesh.places[body.mesh.edges[name]]
        y = np.interp(X, *face.T)
        piece = np.searchsorted(face[:, 0], X)
        along, across = (face[piece] - face[piece - 1]).T
        tangent, normal = body.strip.directions(X)
        T = ((1 - body.strip.curvature * y) * along * tangent + across * normal).T
        T = T / np.hypot(*T.T)[:, None]
        _, F = interpolation(body.mesh, np.stack([X, y], axis=1)).of(result.states[k].u[body.part])
        strains[name] = np.hypot(*np.einsum("ijp,pj->ip", F, T)) - 1
    return X, strains
