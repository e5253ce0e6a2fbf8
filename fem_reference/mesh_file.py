"""Mesh files of the user, read by meshio and checked."""

from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from stat import S_ISREG
from typing import Any

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, kron
from scipy.sparse.csgraph import connected_components

from fem_reference.arrays import Array, Floats, Ints
from fem_reference.mesh import EDGES, Discretisation, edge_weights, from_basis, scalar_basis
from fem_reference.sampling import sample_basis, section_points
from fem_reference.strip import Strip

_ROUND_OFF = 1e-9
_FACE_TOLERANCE = 1e-6
"""Largest distance of a face from half the height, relative to the height: the file may hold few digits."""
_LARGEST = 16 * 2**20
"""Largest mesh file that is read [bytes]."""


class MeshError(ValueError):
    """A mesh file breaks a rule; the message is one line."""


def read_mesh(strip: Strip) -> Discretisation:
    """Read ``strip.mesh_file``, a mesh of straight-sided quadrilaterals in the strip's frame with four named edges.

    The mesh lies in the plane z = 0 and fills the strip. The edges "start" and "end" lie at x = 0 and at the strip's length,
    "right" and "left" at half the height below and above the axis. An edge is a named set of lines, either a physical
    group of Gmsh or a cell set of meshio.

    Raises ValueError if the file is not a regular file of at most 16 MB or cannot be read; if an edge is
    missing or misplaced; if an element is clockwise, not convex or has no area; if a node belongs to no
    element; if the mesh has several parts or holes.
    """
    from skfem import MeshQuad

    assert strip.mesh_file is not None, "structured strips have no file"
    try:
        points, quads, lines = _contents(Path(strip.mesh_file))
        _check_elements(points, quads)
        quads = _aligned(points, quads)
        basis = scalar_basis(MeshQuad(points.T, quads.T), strip.element)
        edges = {name: _edge(basis, name, lines) for name in EDGES}
        _check_closed(basis, lines)
        _check_position(strip, basis.doflocs.T, edges)
    except MeshError as error:
        raise ValueError(f"Strip({strip.name!r}).mesh_file = {strip.mesh_file!r}: {error}") from None
    nodes = basis.doflocs.T
    stations = nodes[edges["right"], 0]
    return from_basis(strip, basis, edges, stations, _sections(strip, basis, edges, stations))


def _contents(path: Path) -> tuple[Floats, Ints, dict[str, Ints]]:
    """Read corners ``(n, 2)``, quadrilaterals ``(e, 4)`` and the lines ``(l, 2)`` of each named edge."""
    import meshio

    _check_file(path)
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):  # meshio prints what it cannot read
            mesh = meshio.read(path)
    except (meshio.ReadError, *_UNREADABLE) as error:
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise MeshError(f"cannot be read ({reason})") from None
    _check_points(mesh)
    quads, lines = [], dict[str, list[Ints]]()
    named = _names(mesh)
    for number, block in enumerate(mesh.cells):
        if not block.data.size:
            continue
        if block.type.startswith("quad"):
            _check_straight(mesh.points[:, :2], block.data)
            quads.append(block.data[:, :4])
        elif block.type.startswith("line"):
            for name, sets in named.items():
                lines.setdefault(name, []).append(block.data[sets[number], :2])
        elif block.type != "vertex":
            raise MeshError(f'must hold quadrilaterals only, it has cells of type "{block.type}"')
    if not quads:
        raise MeshError("must hold quadrilaterals, it has none")
    corners, local = np.unique(np.concatenate(quads), return_inverse=True)
    number_of = np.full(len(mesh.points), -1)
    number_of[corners] = np.arange(corners.size)
    edges = {name: number_of[np.concatenate(parts)] for name, parts in lines.items()}
    return mesh.points[corners, :2].astype(float), local.reshape(-1, 4), edges


def _check_file(path: Path) -> None:
    """Require a regular file of at most `_LARGEST` bytes."""
    try:
        info = path.stat()
    except (OSError, ValueError) as error:
        raise MeshError(f"cannot be read ({getattr(error, 'strerror', None) or error})") from None
    if not S_ISREG(info.st_mode):
        raise MeshError("must be a regular file")
    if info.st_size > _LARGEST:
        raise MeshError(f"must not be larger than 16 MB, it has {info.st_size / 2**20:.4g}")


_UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    LookupError,
    MemoryError,
    OSError,
    RuntimeError,
    SyntaxError,
    SystemExit,
    TypeError,
    ValueError,
)
"""Exceptions that meshio's readers raise on broken files."""


def _check_points(mesh: Any) -> None:
    """Require finite nodes in the plane z = 0, each in a quadrilateral, and cells without unknown nodes."""
    points = mesh.points
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not len(points):
        raise MeshError("must hold nodes with two or three coordinates")
    if not np.all(np.isfinite(points)):
        raise MeshError(f"node {_first(~np.isfinite(points).all(axis=1))} must have finite coordinates")
    if points.shape[1] > 2:
        off = np.abs(points[:, 2]) > _ROUND_OFF * np.ptp(points[:, :2], axis=0).max(initial=0.0)
        if off.any():
            raise MeshError(f"node {_first(off)} must have z = 0, it has {points[_first(off), 2]:g}")
    used = np.zeros(len(points), dtype=bool)
    for block in mesh.cells:
        nodes = np.asarray(block.data)
        if nodes.size and not 0 <= nodes.min() <= nodes.max() < len(points):
            raise MeshError(f'cells of type "{block.type}" must have nodes below {len(points)}')
        if block.type.startswith("quad"):
            used[nodes] = True
    if used.any() and not used.all():
        raise MeshError(f"node {_first(~used)} must belong to a quadrilateral")


def _first(failed: Array) -> int:
    return int(np.argmax(failed))


def _names(mesh: Any) -> dict[str, list[Ints]]:
    """Cell numbers of each named edge in every block, from meshio's cell sets or Gmsh's physical groups."""
    empty = np.zeros(0, dtype=np.int64)
    named = {
        name: [empty if part is None else np.asarray(part, dtype=np.int64) for part in sets]
        for name, sets in mesh.cell_sets.items()
        if name in EDGES
    }
    tags = mesh.cell_data.get("gmsh:physical")
    for name, (tag, dimension) in mesh.field_data.items():
        if tags is not None and dimension == 1 and name in EDGES:
            named[name] = [np.flatnonzero(part == tag) for part in tags]
    return named


def _check_straight(points: Floats, cells: Ints) -> None:
    """Require midside and centre nodes, if any, at the middle of the sides and of the element."""
    corners = points[cells[:, :4]]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    expected = np.concatenate([middles, corners.mean(axis=1, keepdims=True)], axis=1)[:, : cells.shape[1] - 4]
    off = np.abs(points[cells[:, 4:]] - expected).max(axis=(1, 2), initial=0.0)
    size = np.ptp(corners, axis=1).max(axis=1)
    if np.any(off > _ROUND_OFF * size):
        raise MeshError(f"element {int(np.argmax(off / size))} must have straight sides")


def _check_elements(points: Floats, quads: Ints) -> None:
    """Require convex anticlockwise quadrilaterals in one connected part."""
    x = points[quads]
    sides = np.roll(x, -1, axis=1) - x
    after = np.roll(sides, -1, axis=1)
    turn = sides[..., 0] * after[..., 1] - sides[..., 1] * after[..., 0]
    diagonals = x[:, 2:] - x[:, :2]
    area = (diagonals[:, 0, 0] * diagonals[:, 1, 1] - diagonals[:, 0, 1] * diagonals[:, 1, 0]) / 2
    size = (sides**2).sum(axis=2).max(axis=1)
    for failed, rule in (
        (np.abs(area) <= _ROUND_OFF * size, "has no area"),
        (area < 0, "is clockwise, must be anticlockwise"),
        (turn.min(axis=1) <= _ROUND_OFF * size, "is not convex"),
    ):
        if failed.any():
            raise MeshError(f"element {_first(failed)} {rule}")
    shares = coo_matrix((np.ones(quads.size), (np.repeat(np.arange(len(quads)), 4), quads.ravel())))
    parts, _ = connected_components(shares.T @ shares)
    if parts > 1:
        raise MeshError(f"falls into {parts} parts without a common node")


def _aligned(points: Floats, quads: Ints) -> Ints:
    """Renumber the corners of every element so that the first side has the largest increase of x."""
    x = points[quads, 0]
    first = np.argmax(np.roll(x, -1, axis=1) - x, axis=1)
    turned: Ints = np.take_along_axis(quads, (first[:, None] + np.arange(4)) % 4, axis=1)
    return turned


def _edge(basis: Any, name: str, lines: dict[str, Ints]) -> Ints:
    """Nodes on the lines of a named edge, an end ordered upwards, a face from start to end."""
    if not lines.get(name, np.zeros(0)).size:
        raise MeshError(f'must name the lines of the edge "{name}", it names {sorted(lines) or "none"}')
    named = _node_pairs(lines[name])
    facets = basis.mesh.boundary_facets()
    pairs = map(frozenset, basis.mesh.facets[:, facets].T.tolist())
    chosen = [facet for facet, pair in zip(facets, pairs, strict=True) if pair in named]
    if len(chosen) < len(named):
        raise MeshError(f'the edge "{name}" must lie on the boundary')
    dofs = np.unique(basis.get_dofs(np.array(chosen)).flatten())
    axis = 1 if name in ("start", "end") else 0
    return np.asarray(dofs[np.argsort(basis.doflocs[axis, dofs])], dtype=np.int64)


def _check_closed(basis: Any, lines: dict[str, Ints]) -> None:
    """Require that every boundary line belongs to an edge; otherwise the mesh has a hole or a gap."""
    named = _node_pairs(np.concatenate([lines[name] for name in EDGES]))
    for nodes in basis.mesh.facets[:, basis.mesh.boundary_facets()].T.tolist():
        if frozenset(nodes) not in named:
            (xa, ya), (xb, yb) = basis.mesh.p[:, nodes].T
            raise MeshError(f"the boundary from ({xa:g}, {ya:g}) to ({xb:g}, {yb:g}) must belong to an edge")


def _node_pairs(lines: Ints) -> set[frozenset[int]]:
    """Nodes of the lines ``(l, 2)`` without their order."""
    return set(map(frozenset, lines.tolist()))


def _check_position(strip: Strip, nodes: Floats, edges: dict[str, Ints]) -> None:
    """Require that the edges are the ends and the faces of the strip."""
    L = strip.length
    for name, x in (("start", 0.0), ("end", L)):
        if np.abs(nodes[edges[name], 0] - x).max() > _ROUND_OFF * L:
            raise MeshError(f'the edge "{name}" must lie at x = {x:g}')
    for name in ("right", "left"):
        x = nodes[edges[name], 0]
        if abs(x[0]) + abs(x[-1] - L) > _ROUND_OFF * L or np.any(np.diff(x) <= _ROUND_OFF * L):
            raise MeshError(f'the edge "{name}" must be a curve over x from 0 to {L:g}')
    h = strip.height
    low, high = (nodes[edges[name], 1] for name in ("right", "left"))
    if low.mean() > high.mean():
        raise MeshError('the edge "right" must lie below the edge "left"')
    for name, y, expected in (("right", low, -h / 2), ("left", high, h / 2)):
        furthest = y[np.argmax(np.abs(y - expected))]
        if abs(furthest - expected) > _FACE_TOLERANCE * h:
            raise MeshError(
                f'the edge "{name}" must lie at y = {expected:g} (half the height), it reaches {furthest:g}'
            )
    for name in ("start", "end"):
        y = nodes[edges[name], 1]
        if max(abs(y[0] + h / 2), abs(y[-1] - h / 2)) > _FACE_TOLERANCE * h:
            raise MeshError(f'the edge "{name}" must reach from y = {-h / 2:g} to {h / 2:g}')


def _sections(strip: Strip, basis: Any, edges: dict[str, Ints], stations: Floats) -> csr_matrix:
    """Weights ``(m, n)`` of the nodes in the section means, by Gauss rules over the height; exact ones at the ends."""
    nodes = basis.doflocs.T
    points, shares, _ = section_points(strip, nodes, edges, stations)
    sampled = sample_basis(basis, basis.element_dofs.T, points)
    means = (kron(np.eye(stations.size), shares[None], format="csr") @ sampled.rows(len(nodes))).tolil()
    for row, end in ((0, "start"), (-1, "end")):
        means[row] = 0.0
        means[row, edges[end]] = edge_weights(strip.element, nodes[edges[end], 1])
    return csr_matrix(means)
