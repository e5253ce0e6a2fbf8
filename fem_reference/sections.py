"""Section forces and the strains at the faces, from the stress inside."""

from dataclasses import dataclass

import numpy as np

from fem_reference.arrays import Floats
from fem_reference.body import Body
from fem_reference.result import Result
from fem_reference.sampling import sample

_POINTS = 3


@dataclass(frozen=True, kw_only=True, eq=False)
class SectionForces:
    """Stress resultants over undeformed sections, what the part beyond exerts, ``(m,)`` each.

    Parameters
    ----------
    stations
        Undeformed axial coordinates [m].
    N, V
        Force along the section's normal, in tension, and along its height, upwards [N].
    M
        Moment about the section mean, anticlockwise positive on the part beyond's side [N m].
    rotation
        Rotation of the section [rad].
    force
        The same force in the global frame, ``(m, 2)`` [N].
    """

    stations: Floats
    N: Floats
    V: Floats
    M: Floats
    rotation: Floats
    force: Floats


def section_forces(result: Result, strip: str, k: int, stations: Floats | None = None) -> SectionForces:
    """Integrate the stress over sections of a strip at the accepted load parameter ``k``.

    With ``P`` the first Piola-Kirchhoff stress, ``p = P e_1`` the traction of an undeformed section and ``x_m`` its mean
    position, ``f = integral p dA`` and ``M = integral (x - x_m) x p dA``. N and V are the components of f on the section's
    axes, turned by the rotation that fits ``x - x_m`` to the undeformed section best.

    Parameters
    ----------
    result, strip, k
        Solution, name of the strip and number of the load parameter.
    stations
        Undeformed axial coordinates; by default the points of two-point Gauss rules in the elements along the strip, where
        the stress of biquadratic elements is best.
    """
    body, part = result.model.body(strip)
    X = gauss_stations(body) if stations is None else np.asarray(stations, dtype=float)
    points, weights = _section_points(body, X)
    u = result.states[k].u[part]
    found = sample(body.mesh, points)
    P = body.law.stress(found.deformation_gradient(u))
    x = points + found.rows(len(u)) @ u
    shape = (X.size, -1)
    p = P[:, 0].T.reshape(*shape, 2)
    mean = (weights[:, :, None] * x.reshape(*shape, 2)).sum(axis=1) / weights.sum(axis=1)[:, None]
    arm = x.reshape(*shape, 2) - mean[:, None]
    height = points[:, 1].reshape(shape)
    height = height - (weights * height).sum(axis=1, keepdims=True) / weights.sum(axis=1, keepdims=True)
    up = ((weights * height)[:, :, None] * arm).sum(axis=1)
    rotation = np.arctan2(-up[:, 0], up[:, 1])
    f = (weights[:, :, None] * p).sum(axis=1)
    c, s = np.cos(rotation), np.sin(rotation)
    return SectionForces(
        stations=X,
        N=c * f[:, 0] + s * f[:, 1],
        V=-s * f[:, 0] + c * f[:, 1],
        M=(weights * (arm[:, :, 0] * p[:, :, 1] - arm[:, :, 1] * p[:, :, 0])).sum(axis=1),
        rotation=rotation + np.arctan2(*body.strip.frame[::-1, 0]),
        force=f @ body.strip.frame.T,
    )


def gauss_stations(body: Body) -> Floats:
    """Points of two-point Gauss rules between the corners of the elements on the right face, ``(2 n,)`` [m]."""
    corners = np.unique(body.mesh.cells[:, :4])
    face = body.mesh.edges["right"]
    x = body.mesh.nodes[face[np.isin(face, corners)], 0]
    offsets = (1 + np.array([-1.0, 1.0]) / np.sqrt(3)) / 2
    stations: Floats = (x[:-1, None] + offsets * np.diff(x)[:, None]).ravel()
    return stations


def _section_points(body: Body, X: Floats) -> tuple[Floats, Floats]:
    """Points ``(m q, 2)`` of three-point Gauss rules, one to a row of elements, and weights ``(m, q)`` [m^2]."""
    mesh = body.mesh
    low, high = (np.interp(X, *mesh.nodes[mesh.edges[name]].T) for name in ("right", "left"))
    layers = body.strip.mesh[1] if body.strip.mesh_file is None else 8
    gauss, weights = np.polynomial.legendre.leggauss(_POINTS)
    fractions = (np.arange(layers)[:, None] + (1 + gauss) / 2).ravel() / layers
    y = low[:, None] + fractions * (high - low)[:, None]
    areas = body.strip.width * (high - low)[:, None] * np.tile(weights / 2, layers) / layers
    return np.stack([np.broadcast_to(X[:, None], y.shape).ravel(), y.ravel()], axis=1), areas


def face_strains(result: Result, strip: str, k: int) -> tuple[Floats, dict[str, Floats]]:
    """Stretches less one along the two faces at the accepted load parameter ``k``.

    Returns
    -------
    stations : (m,)
        The points of `gauss_stations` [m].
    strains : dict
        By face, ``"right"`` and ``"left"``: ``|F T| - 1`` with the face's unit tangent T in the undeformed strip, ``(m,)``.
    """
    body, part = result.model.body(strip)
    X = gauss_stations(body)
    strains = {}
    for name in ("right", "left"):
        face = body.mesh.nodes[body.mesh.edges[name]]
        y = np.interp(X, *face.T)
        piece = np.searchsorted(face[:, 0], X)
        T = face[piece] - face[piece - 1]
        T = T / np.hypot(*T.T)[:, None]
        F = sample(body.mesh, np.stack([X, y], axis=1)).deformation_gradient(result.states[k].u[part])
        strains[name] = np.hypot(*np.einsum("ijp,pj->ip", F, T)) - 1
    return X, strains
