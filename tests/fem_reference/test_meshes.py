"""Meshes of strips: sections, size, and files of the user's own."""

import os
import re
import tracemalloc

import meshio
import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.strips import (
    CLAMP,
    EA,
    NU,
    STRIP,
    B,
    E,
    H,
    elements,
    held,
    load,
    loads,
    make_problem,
    make_strip,
)


def parts(nx=20, ny=2, height=H, tilt=0.2, shift=0.0):
    """Points and cells of a strip of slanted quadrilaterals, and the lines of its edges by name; `shift` moves the rows to one side."""
    x, y = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(-0.5, 0.5, ny + 1), indexing="ij")
    slant = tilt / nx * np.sin(np.pi * x) * y
    y = y + shift * (1 - 4 * y**2)
    points = np.stack([(x + slant).ravel(), height * y.ravel(), 0 * x.ravel()], 1)
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)
    sides = {"start": number[0], "end": number[-1], "right": number[:, 0], "left": number[:, -1]}
    return points, quads, {name: np.stack([side[:-1], side[1:]], 1) for name, side in sides.items()}


def quad9(nx=4):
    """As `parts`, straight, with midsides and centres."""
    points, quads, lines = parts(nx=nx, tilt=0.0)
    corners = points[quads]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    more = np.concatenate([middles, corners.mean(axis=1, keepdims=True)], axis=1)
    added = len(points) + np.arange(more.shape[0] * 5).reshape(-1, 5)
    return np.concatenate([points, more.reshape(-1, 3)]), np.concatenate([quads, added], axis=1), lines


def write(path, points, quads, lines, version="gmsh22"):
    """Gmsh's text format 2.2 or, as ``gmsh``, 4.1, in which every edge and the body is an entity of its own with nodes of its own."""
    body = ("quad9" if quads.shape[1] == 9 else "quad", quads)
    cells = [*(("line", part) for part in lines.values()), body]
    marks = [
        np.full(len(part), tag) for tag, (_, part) in zip([*range(1, len(cells)), 9], cells, strict=True)
    ]
    names, entities = {"body": np.array([9, 2])}, np.full((len(points), 2), [2, 9])
    for tag, name in reversed([*enumerate(lines, 1)]):
        names[name], entities[lines[name]] = np.array([tag, 1]), [1, tag]
    data = {"gmsh:physical": marks, "gmsh:geometrical": marks}
    more = {"point_data": {"gmsh:dim_tags": entities}} if version == "gmsh" else {}
    mesh = meshio.Mesh(points, cells, cell_data=data, field_data=names, **more)
    meshio.write(path, mesh, file_format=version, binary=False)
    return str(path)


def pulled(force=1e-6 * EA, **changes):
    problem = held(load(force=(force, 0.0)), **({"clamped": ("start",), "material": "biot-linear"} | changes))
    return fr.solve(problem, loads(1))


def refused(path):
    with pytest.raises(ValueError, match=r"^Strip\('cantilever'\)\.mesh_file = ") as caught:
        pulled(mesh_file=str(path))
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


@pytest.mark.parametrize("element", ["Q1", "Q2"])
def test_axis_is_the_mean_of_the_sections(element):
    """By the rule of Simpson, or of trapezoids with bilinear elements."""
    rows = 3
    result = fr.solve(make_problem(path=((1.0, 0.0), (0.9, 0.1)), mesh=(4, rows), element=element), loads(1))
    places = result.mesh_points + result.displacement[-1]
    order, shares = (1, [0.5, 0.5]) if element == "Q1" else (2, [1 / 6, 2 / 3, 1 / 6])
    weights = np.zeros(order * rows + 1)
    for row in range(rows):
        weights[order * row : order * (row + 1) + 1] += np.array(shares) / rows
    stations = fr.axis_stations(result, STRIP)
    np.testing.assert_allclose(stations, np.linspace(0, 1, 4 * order + 1), rtol=0, atol=1e-15)
    for station, mean in zip(stations, fr.axis_line(result, STRIP, -1), strict=True):
        section = np.flatnonzero(np.abs(result.mesh_points[:, 0] - station) < 1e-9)
        section = section[np.argsort(result.mesh_points[section, 1])]
        np.testing.assert_allclose(weights @ places[section], mean, rtol=0, atol=1e-15)


def test_memory_is_what_a_refusal_says():
    """3.4 GiB for 100,000 elements in a row, so .034 for 1000. In a wide mesh the bands are most: 402,402 rows of 810 numbers, twice."""
    for mesh, needed in (((100_000, 1), r"3\.[3-6]"), ((500, 100), r"6\.53")):
        with pytest.raises(ValueError, match=f"must need at most 2 GiB, needs about {needed}"):
            make_strip(mesh=mesh)
    pulled(mesh=(2, 1))
    tracemalloc.start()
    pulled(mesh=(1000, 1))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.3 < peak / (0.0344 * 2**30) < 1.1


@elements
def test_a_bar_is_stretched_evenly(tmp_path, element):
    """By .05 of E, on distorted elements without a middle node: a rod's clamp lets the section contract, and holds its middle."""
    mesh = write(tmp_path / "a.msh", *parts(nx=4, height=0.3, ny=3, tilt=0.6, shift=0.1))
    F = 0.05 * E * B * 0.3
    result = pulled(F, element=element, height=0.3, mesh_file=mesh)
    expected = result.mesh_points * [0.05, -0.05 * NU]
    np.testing.assert_allclose(result.displacement[0], expected, rtol=0, atol=1e-11)
    np.testing.assert_allclose(result.supports[CLAMP].force[0], [-F, 0], rtol=0, atol=1e-8 * F)
    strains = fr.face_strains(result, STRIP, 0)[1]
    np.testing.assert_allclose([strains["left"], strains["right"]], 0.05, rtol=0, atol=1e-11)


def test_midsides_are_read_and_must_be_straight(tmp_path):
    points, quads, lines = quad9()
    read = pulled(mesh_file=write(tmp_path / "a.msh", points, quads, lines))
    assert read.mesh_cells["quad9"].shape == (8, 9)
    assert read.tips[STRIP][-1] == pytest.approx([1 + 1e-6, 0.0], abs=1e-12)
    points[quads[2, 4], 1] += 1e-3
    assert "element 2 must have straight sides" in refused(write(tmp_path / "b.msh", points, quads, lines))


def moved(change):
    return lambda points, quads, lines: (change(points), quads, lines)


def flipped(points, quads, lines):
    return points, np.where(np.arange(len(quads))[:, None] == 3, quads[:, ::-1], quads), lines


def flat(points, quads, lines):
    points = points.copy()
    points[quads[5, 2:]] = points[quads[5, :2][::-1]]
    return points, quads, lines


def without_one(points, quads, lines):
    return points, np.delete(quads, 34, axis=0), lines


def parted(points, quads, lines):
    split = np.where(quads[:, :1] >= 30, quads + len(points), quads)
    used, local = np.unique(split, return_inverse=True)
    number = {int(node): place for place, node in enumerate(used % len(points))}
    renamed = {name: np.vectorize(number.get)(part) for name, part in lines.items()}
    return np.concatenate([points, points])[used], local.reshape(-1, 4), renamed


BROKEN = {
    "element 3 is clockwise": flipped,
    "element 5 has no area": flat,
    "element .* is not convex": moved(lambda p: p + (np.arange(len(p)) == 31)[:, None] * [0.07, 0, 0]),
    r"the boundary from \(0\.495, .* must lie at x = 0": parted,
    "covers the strip 2 times": lambda p, quads, lines: (
        np.tile(p, (2, 1)),
        np.r_[quads, quads + len(p)],
        lines,
    ),
    r"the boundary from \(0\.8.*, .* must lie at x = 0 or 1, or at y = -0\.01 or 0\.01": without_one,
    r"the boundary from \(0\.1, .* must lie": moved(lambda p: np.add(p, [0.1, 0, 0])),
    r"the boundary from \(0\.5, .* must lie": moved(lambda p: 0.5 * p * [1, 2, 1]),
    r"the boundary from \(0, -0\.03\) .* must lie": moved(lambda p: p * [1, 3, 1]),
    r"the boundary from .*, 0\.0100.* must lie": moved(
        lambda p: p + (p[:, 1:2] > 0.005) * np.sin(np.pi * p[:, :1]) * 2e-4 * [0, 1, 0]
    ),
    r"node 32 must have z = 0, it has 0\.001": moved(lambda p: p + 1e-3 * (p[:, :1] > 0.5) * [0, 0, 1]),
    "node 63 must belong to a quadrilateral": moved(lambda p: np.concatenate([p, [[0.3, 0.0, 0.0]]])),
}


@pytest.mark.parametrize("rule", BROKEN)
def test_mesh_that_breaks_a_rule_costs_one_line(tmp_path, rule):
    points, quads, lines = parts()
    message = refused(write(tmp_path / "bad.msh", *BROKEN[rule](points, quads, lines)))
    assert re.search(r"bad\.msh.*: " + rule.rstrip("$"), message), message


@pytest.mark.parametrize("version", ["gmsh22", "gmsh"])
def test_a_text_that_is_cut_off_or_counts_wrongly_is_refused_and_nothing_is_printed(tmp_path, version, capfd):
    path = tmp_path / "a.msh"
    write(path, *parts(nx=2), version)
    pulled(mesh_file=str(path))
    lines = path.read_text().splitlines()
    for number in range(lines.index("$Nodes") + 1, lines.index("$EndElements")):
        count = lines[number - 1] in ("$Nodes", "$Elements")
        spoilt = [
            [*lines[:number], other, *lines[number + 1 :]]
            for other in ("9999999999", "-1", "1e3", "")
            if count
        ]
        for text in (*spoilt, lines[:number]):
            path.write_text("\n".join(text) + "\n")
            refused(path)
    assert capfd.readouterr() == ("", "")


def test_only_regular_files_of_at_most_16_mb_are_read(tmp_path):
    fifo, large = tmp_path / "fifo.msh", tmp_path / "large.msh"
    os.mkfifo(fifo)
    with large.open("wb") as file:
        file.truncate(2**24 + 1)
    triangle = meshio.Mesh(np.eye(3) * [1, 1, 0], [("triangle", np.array([[0, 1, 2]]))])
    meshio.write(tmp_path / "a.vtu", triangle)
    for path, rule in {
        fifo: "must be a regular file",
        "/dev/zero": "must be a regular file",
        large: "must not be larger than 16 MB",
        tmp_path / "a.vtu": 'it has cells of type "triangle"',
        tmp_path / "nothing.msh": "cannot be read",
    }.items():
        assert rule in refused(path)
    for content in (b"\xff\x00", b"<VTKFile>"):
        for kind in ("msh", "vtu", "nothing"):
            path = tmp_path / f"broken.{kind}"
            path.write_bytes(content)
            refused(path)
