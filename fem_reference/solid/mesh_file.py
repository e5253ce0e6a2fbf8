"""Mesh files of the user, read by meshio and checked."""

from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from stat import S_ISREG
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix, kron

from fem_reference.solid.mesh import (
    EDGES,
    Discretisation,
    edge_weights,
    from_basis,
    scalar_basis,
    section_points,
)
from fem_reference.statement.arrays import Floats, Ints
from fem_reference.statement.strip import Strip

_ROUND_OFF = 1e-9
_FACE_TOLERANCE = 1e-6
"""Largest distance of a face from half the height, relative to the height: the file may hold few digits."""
_LARGEST = 16 * 2**20
"""Largest mesh file that is read [bytes]."""


def read_mesh(strip: Strip) -> Discretisation:
    """Read ``strip.mesh_file``, a mesh of straight-sided quadrilaterals in the strip's frame.

    The mesh lies in the plane z = 0 and fills the strip: its boundary lies at x = 0 and at the strip's length, and at half the
    height below and above the axis.

    Raises ValueError if the file is not a regular file of at most 16 MB or cannot be read; if the boundary lies
    elsewhere, as it does at holes and cracks; if an element is clockwise, not convex or has no area; if a node belongs
    to no element; if elements cover the strip more than once.
    """
    from skfem import MeshQuad

    assert strip.mesh_file is not None, "structured strips have no file"
    try:
        points, quads = _contents(_read(Path(strip.mesh_file)))
        covered = _checked_area(points, quads) / (strip.length * strip.height)
        # the first side of every element has the largest increase of x
        x = points[quads, 0]
        first = np.argmax(np.roll(x, -1, axis=1) - x, axis=1)
        quads = np.take_along_axis(quads, (first[:, None] + np.arange(4)) % 4, axis=1)
        basis = scalar_basis(MeshQuad(points.T, quads.T), strip.element)
        edges = _edges(strip, basis)
        _require(covered > 1.5, f"covers the strip {covered:.3g} times")
    except ValueError as error:
        raise ValueError(f"Strip({strip.name!r}).mesh_file = {strip.mesh_file!r}: {error}") from None
    stations = basis.doflocs[0, edges["right"]]
    return from_basis(strip, basis, edges, stations, _sections(strip, basis, edges, stations))


def _require(failed: Any, rule: str) -> None:
    """Raise an error where something failed; the first number of what failed replaces ``#`` in the rule."""
    if np.any(failed):
        raise ValueError(rule.replace("#", str(int(np.argmax(failed)))))


def _read(path: Path) -> Any:
    """Read a regular file of at most `_LARGEST` bytes by meshio."""
    import meshio

    try:
        info = path.stat()
        fits = S_ISREG(info.st_mode) and info.st_size <= _LARGEST
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):  # meshio prints what it cannot read
            mesh = meshio.read(path) if fits else None
    except (Exception, SystemExit) as error:  # noqa: BLE001 - meshio's readers raise anything on a broken file
        reason = " ".join(str(getattr(error, "strerror", None) or error).split())[:80] or type(error).__name__
        raise ValueError(f"cannot be read ({reason})") from None
    _require(not S_ISREG(info.st_mode), "must be a regular file")
    _require(not fits, f"must not be larger than 16 MB, it has {info.st_size / 2**20:.4g}")
    return mesh


def _contents(mesh: Any) -> tuple[Floats, Ints]:
    """Corners ``(n, 2)`` and quadrilaterals ``(e, 4)``."""
    points, used = mesh.points, np.zeros(len(mesh.points), dtype=bool)
    flat = points.ndim == 2 and points.shape[-1] in (2, 3)
    _require(not flat, "must hold nodes with two or three coordinates")
    _require(~np.isfinite(points).all(axis=1), "node # must have finite coordinates")
    off = np.abs(points[:, 2:]).sum(axis=1) > _ROUND_OFF * np.ptp(points[:, :2], axis=0).max(initial=0.0)
    _require(off, f"node # must have z = 0, it has {points[np.argmax(off), -1]:g}" if off.any() else "")
    quads = list[Ints]()
    for kind, nodes in mesh.cells_dict.items():
        if not nodes.size:
            continue
        rule = f'cells of type "{kind}" must have nodes below {len(points)}'
        _require(nodes.min() < 0 or nodes.max() >= len(points), rule)
        if kind.startswith("quad"):
            used[nodes] = True
            _check_straight(points[:, :2], nodes)
            quads.append(nodes[:, :4])
        else:
            rule = f'must hold quadrilaterals only, it has cells of type "{kind}"'
            _require(kind != "vertex" and not kind.startswith("line"), rule)
    _require(not quads, "must hold quadrilaterals, it has none")
    _require(~used, "node # must belong to a quadrilateral")
    corners, local = np.unique(np.concatenate(quads), return_inverse=True)
    return points[corners, :2].astype(float), local.reshape(-1, 4)


def _check_straight(points: Floats, cells: Ints) -> None:
    """Require midside nodes of quadrilaterals at the middle of their sides, and a centre node at the centre."""
    corners = points[cells[:, :4]]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    expected = np.concatenate([corners, middles, corners.mean(axis=1, keepdims=True)], axis=1)
    off = np.abs(points[cells] - expected[:, : cells.shape[1]]).max(axis=(1, 2))
    _require(off > _ROUND_OFF * np.ptp(corners, axis=1).max(axis=1), "element # must have straight sides")


def _checked_area(points: Floats, quads: Ints) -> float:
    """Area of quadrilaterals, which must be convex and anticlockwise."""
    corners = points[quads] @ (1, 1j)
    sides = np.roll(corners, -1, axis=1) - corners
    turn = (sides.conj() * np.roll(sides, -1, axis=1)).imag
    areas, least = turn.sum(axis=1) / 4, _ROUND_OFF * (np.abs(sides) ** 2).max(axis=1)
    _require(np.abs(areas) <= least, "element # has no area")
    _require(areas < 0, "element # is clockwise, must be anticlockwise")
    _require(turn.min(axis=1) <= least, "element # is not convex")
    return float(areas.sum())


def _edges(strip: Strip, basis: Any) -> dict[str, Ints]:
    """Nodes on the edges, an end ordered upwards, a face from start to end; each line of the boundary must lie on one."""
    mesh, L, half = basis.mesh, strip.length, strip.height / 2
    facets = mesh.boundary_facets()
    x, y = lines = mesh.p[:, mesh.facets[:, facets]]
    distances = np.abs([x, x - L, y + half, y - half])
    slack = np.array([_ROUND_OFF * L] * 2 + [2 * _FACE_TOLERANCE * half] * 2)
    on = np.all(distances <= slack[:, None, None], axis=1)
    for (xa, ya), (xb, yb) in lines.T[~on.any(axis=0)]:
        rule = f"must lie at x = 0 or {L:g}, or at y = {-half:g} or {half:g} (half the height)"
        raise ValueError(f"the boundary from ({xa:g}, {ya:g}) to ({xb:g}, {yb:g}) {rule}")
    edges = dict[str, Ints]()
    for name, along, here in zip(EDGES, (1, 1, 0, 0), on, strict=True):
        dofs = np.unique(basis.get_dofs(facets[here]).flatten())
        edges[name] = dofs[np.argsort(basis.doflocs[along, dofs])].astype(np.int64)
    return edges


def _sections(strip: Strip, basis: Any, edges: dict[str, Ints], stations: Floats) -> csr_matrix:
    """Weights ``(m, n)`` of the nodes in the section means, by Gauss rules over the height; exact ones at the ends."""
    nodes = basis.doflocs.T
    points, shares, _ = section_points(strip, nodes, edges, stations)
    means = (kron(np.eye(stations.size), shares[None], format="csr") @ basis.probes(points.T)).tolil()
    for row, end in ((0, "start"), (-1, "end")):
        means[row] = 0.0
        means[row, edges[end]] = edge_weights(strip.element, nodes[edges[end], 1])
    return csr_matrix(means)
