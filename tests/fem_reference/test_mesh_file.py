import os
import re

import meshio
import numpy as np
import pytest

import fem_reference as fr
from fem_reference.body import build_body, discretise
from fem_reference.sampling import sample
from tests.fem_reference.conftest import PAIR, loads, rotation, surfaces


def parts(nx=20, ny=2, length=1.0, height=0.02, tilt=0.2):
    """Points and cells of a strip of slanted quadrilaterals, and the lines of its edges by name."""
    x, y = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(-0.5, 0.5, ny + 1), indexing="ij")
    slant = tilt / nx * np.sin(np.pi * x) * y
    points = np.stack([length * (x + slant).ravel(), height * y.ravel(), 0 * x.ravel()], 1)
    number = np.arange(x.size).reshape(x.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)
    sides = {"start": number[0], "end": number[-1], "right": number[:, 0], "left": number[:, -1]}
    return points, quads, {name: np.stack([side[:-1], side[1:]], 1) for name, side in sides.items()}


def write(path, points, quads, lines):
    """Gmsh's text format 2.2."""
    cells = [
        ("quad9" if quads.shape[1] == 9 else "quad", quads),
        *(("line", part) for part in lines.values()),
    ]
    marks = [np.full(len(part), tag or 9) for tag, (_, part) in enumerate(cells)]
    names = {name: np.array([tag, 1]) for tag, name in enumerate(lines, 1)}
    data = {"gmsh:physical": marks, "gmsh:geometrical": marks}
    mesh = meshio.Mesh(points, cells, cell_data=data, field_data=names)
    meshio.write(path, mesh, file_format="gmsh22", binary=False)
    return str(path)


def write_4(path, points, quads, lines):
    """Gmsh's text format 4.1, every edge and the body an entity of its own in a group of its own."""
    names, n = list(lines), len(points)
    text = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", f"{len(names) + 1}", '2 9 "body"']
    text += [f'1 {tag} "{name}"' for tag, name in enumerate(names, 1)]
    text += ["$EndPhysicalNames", "$Entities", f"0 {len(names)} 1 0"]
    text += [f"{tag} 0 0 0 1 1 0 1 {tag} 0" for tag in range(1, len(names) + 1)]
    text += ["1 0 0 0 1 1 0 1 9 0", "$EndEntities", "$Nodes", f"1 {n} 1 {n}", f"2 1 0 {n}"]
    text += [str(number) for number in range(1, n + 1)]
    text += [" ".join(map(repr, map(float, point))) for point in points]
    count = len(quads) + sum(map(len, lines.values()))
    text += ["$EndNodes", "$Elements", f"{len(names) + 1} {count} 1 {count}"]
    number = 0
    blocks = [(1, tag, 1, lines[name]) for tag, name in enumerate(names, 1)]
    for dimension, tag, kind, cells in [*blocks, (2, 1, 3, quads)]:
        text.append(f"{dimension} {tag} {kind} {len(cells)}")
        for cell in cells:
            number += 1
            text.append(" ".join(map(str, [number, *(int(node) + 1 for node in cell)])))
    path.write_text("\n".join([*text, "$EndElements", ""]))


def refused(strip, path):
    """The message of one line with which a mesh file is refused."""
    with pytest.raises(ValueError, match=r"^Strip\('cantilever'\)\.mesh_file = ") as caught:
        discretise(strip(mesh_file=str(path)))
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


@pytest.mark.parametrize("element", fr.ELEMENTS)
def test_mesh_of_the_users_own_has_the_strips_edges_and_sections(strip, tmp_path, element):
    file = write(tmp_path / "a.msh", *parts(height=0.3))
    d = discretise(strip(mesh_file=file, element=element, height=0.3))
    order = 1 if element == "Q1" else 2
    sizes = {name: (nodes.size - 1) // order for name, nodes in d.edges.items()}
    assert sizes == {"start": 2, "end": 2, "right": 20, "left": 20}
    assert d.weights.sum() == pytest.approx(0.3 * 0.02)
    np.testing.assert_allclose(d.sections @ d.nodes, np.stack([d.stations, 0 * d.stations], 1), atol=1e-12)


@surfaces
def test_ks_cantilever_on_a_mesh_of_the_users_own(problem, tmp_path, surface):
    """Slanted elements against straight ones."""
    slanted, straight = (
        fr.solve(problem(contact={"surface": surface}, mesh_file=file), loads(20)[:10]).contacts[PAIR]
        for file in (write(tmp_path / "a.msh", *parts(nx=50)), None)
    )
    np.testing.assert_allclose(slanted.force, straight.force, rtol=1e-3)
    np.testing.assert_allclose(slanted.arc_position, straight.arc_position, rtol=5e-4)


def quad9(nx=4):
    """As `parts`, straight, with midsides and centres."""
    points, quads, lines = parts(nx=nx, tilt=0.0)
    corners = points[quads]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    more = np.concatenate([middles, corners.mean(axis=1, keepdims=True)], axis=1)
    added = len(points) + np.arange(more.shape[0] * 5).reshape(-1, 5)
    return np.concatenate([points, more.reshape(-1, 3)]), np.concatenate([quads, added], axis=1), lines


def test_midsides_are_read_and_must_be_straight(strip, tmp_path):
    points, quads, lines = quad9()
    d = discretise(strip(mesh_file=write(tmp_path / "a.msh", points, quads, lines)))
    assert d.cells.shape == (8, 9)
    assert d.weights.sum() == pytest.approx(0.02 * 0.02)
    points[quads[2, 4], 1] += 1e-3
    assert "element 2 must have straight sides" in refused(
        strip, write(tmp_path / "b.msh", points, quads, lines)
    )


def flipped(points, quads, lines):
    return points, np.where(np.arange(len(quads))[:, None] == 3, quads[:, ::-1], quads), lines


def flat(points, quads, lines):
    moved = points.copy()
    moved[quads[5, 2:]] = moved[quads[5, :2][::-1]]
    return moved, quads, lines


def parted(points, quads, lines):
    split = np.where(quads[:, :1] >= 30, quads + len(points), quads)
    used, local = np.unique(split, return_inverse=True)
    number = {int(node): place for place, node in enumerate(used % len(points))}
    moved = {name: np.vectorize(number.get)(part) for name, part in lines.items()}
    return np.concatenate([points, points])[used], local.reshape(-1, 4), moved


def without(points, quads, lines):
    return points, quads, {name: part for name, part in lines.items() if name != "end"}


def upside_down(points, quads, lines):
    return points, quads, {**lines, "right": lines["left"], "left": lines["right"]}


def moved(change):
    return lambda points, quads, lines: (change(points), quads, lines)


def bow(points):
    """The left face is a bow of a hundredth of the height."""
    return points + (points[:, 1:2] > 0.005) * np.sin(np.pi * points[:, :1]) * 2e-4 * [0, 1, 0]


def short(points, quads, lines):
    """The start names only the lower of its two lines."""
    return points, quads, {**lines, "start": lines["start"][:1]}


def off_boundary(points, quads, lines):
    return points, quads, {**lines, "end": quads[3:4, [0, 2]]}


def with_hole(points, quads, lines):
    return points, np.delete(quads, 7, axis=0), lines


def concave(points, quads, lines):
    """The middle node of a section lies far ahead of its neighbours."""
    return points + (np.arange(len(points)) == 31)[:, None] * [0.07, 0, 0], quads, lines


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        (flipped, "element 3 is clockwise"),
        (flat, "element 5 has no area"),
        (parted, "falls into 2 parts"),
        (without, 'must name the lines of the edge "end", it names'),
        (upside_down, 'the edge "right" must lie below'),
        (moved(lambda p: np.add(p, [0.1, 0, 0])), 'the edge "start" must lie at x = 0'),
        (moved(lambda p: 0.5 * p), 'the edge "end" must lie at x = 1'),
        (moved(lambda p: p * [1, 3, 1]), r'the edge "right" must lie at y = -0\.01'),
        (
            moved(lambda p: np.add(p, [0, 0.006, 0])),
            r'the edge "right" must lie at y = -0\.01 .*reaches -0\.004',
        ),
        (moved(lambda p: p * [1, 0.5, 1]), r'the edge "right" must lie at y = -0\.01'),
        (
            moved(lambda p: np.pad(p[:, :2] @ rotation(0.1), ((0, 0), (0, 1)))),
            'the edge "start" must lie at x = 0',
        ),
        (moved(lambda p: p + 1e-3 * (p[:, :1] > 0.5) * [0, 0, 1]), r"node 32 must have z = 0, it has 0\.001"),
        (moved(lambda p: np.concatenate([p, [[0.3, 0.0, 0.0]]])), "node 63 must belong to a quadrilateral"),
        (off_boundary, 'the edge "end" must lie on the boundary'),
        (with_hole, "the (boundary from|edge)"),
        (concave, "element .* is not convex"),
        (moved(bow), 'the edge "left" must lie at y = 0.01'),
        (short, "the boundary from .* must belong to an edge"),
    ],
)
def test_mesh_that_breaks_a_rule_costs_one_line(strip, tmp_path, change, rule):
    message = refused(strip, write(tmp_path / "bad.msh", *change(*parts())))
    assert re.search(r"bad\.msh.*: " + rule, message)


def test_mesh_of_triangles_and_files_that_are_not_there_are_refused(strip, tmp_path):
    mesh = meshio.Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), [("triangle", np.array([[0, 1, 2]]))])
    meshio.write(tmp_path / "a.vtu", mesh)
    assert 'it has cells of type "triangle"' in refused(strip, tmp_path / "a.vtu")
    assert "cannot be read" in refused(strip, tmp_path / "nothing.msh")


@pytest.mark.parametrize("version", ["2", "4"])
def test_every_broken_line_of_a_mesh_text_is_named(strip, tmp_path, version):
    """Every line of a small mesh spoilt in turn, and the text cut off behind it."""
    path = tmp_path / "a.msh"
    (write if version == "2" else write_4)(path, *parts(nx=2, ny=1))
    discretise(strip(mesh_file=str(path)))
    lines = path.read_text().splitlines()
    sections = [k for k, line in enumerate(lines) if line.startswith("$")]
    begin, end = (lines.index(name) for name in ("$Nodes", "$EndElements"))
    assert {lines[k] for k in sections} >= {"$Nodes", "$EndNodes", "$Elements"}
    for number in range(begin + 1, end):
        for spoilt in ([*lines[:number], lines[number] + " x", *lines[number + 1 :]], lines[:number]):
            path.write_text("\n".join(spoilt) + "\n")
            message = refused(strip, path)
            assert "line " in message or "ends before" in message, (number, message)


@pytest.mark.parametrize("section", ["$Nodes", "$Elements"])
@pytest.mark.parametrize("number", ["9999999999", "-1", "1e3", ""])
def test_counts_without_their_lines_are_refused(strip, tmp_path, section, number):
    path = tmp_path / "a.msh"
    write(path, *parts())
    lines = path.read_text().splitlines()
    lines[lines.index(section) + 1] = number
    path.write_text("\n".join(lines) + "\n")
    assert f"line {lines.index(section) + 2}: " in refused(strip, path)


def test_only_regular_files_of_at_most_16_mb_are_read(strip, tmp_path):
    fifo, large, folder = tmp_path / "fifo.msh", tmp_path / "large.msh", tmp_path / "folder.msh"
    os.mkfifo(fifo)
    folder.mkdir()
    with large.open("wb") as file:
        file.truncate(2**24 + 1)
    for path in (fifo, folder, "/dev/zero"):
        assert "must be a regular file" in refused(strip, path)
    assert "must not be larger than 16 MB" in refused(strip, large)
    binary = tmp_path / "binary.msh"
    binary.write_bytes(b"$MeshFormat\n2.2 1 8\n\x01\x00\x00\x00\n$EndMeshFormat\n")
    assert "line 2: must be Gmsh's text format" in refused(strip, binary)


@pytest.mark.parametrize(
    "content", [b"", b"\xff\x00", b"<VTKFile>", b"# vtk DataFile Version 3.0\nx\nASCII\n"]
)
@pytest.mark.parametrize("kind", ["msh", "vtu", "vtk", "inp", "nothing"])
def test_broken_files_of_any_format_cost_one_line(strip, tmp_path, kind, content):
    path = tmp_path / f"a.{kind}"
    path.write_bytes(content)
    refused(strip, path)


@pytest.mark.parametrize("element", fr.ELEMENTS)
def test_samples_are_exact_for_the_elements_own_fields(strip, element):
    d = discretise(strip(mesh=(5, 3), element=element))
    points = np.array([[0.0, 0.0], [0.4, -0.01], [0.123, 0.004], [1.0, 0.01]])
    found = sample(d, points)
    x, y = d.nodes.T
    field, expected = x * y, points[:, 0] * points[:, 1]
    np.testing.assert_allclose(found.rows(len(d.nodes)) @ field, expected, atol=1e-15)
    np.testing.assert_allclose(
        (found.gradients @ field[found.cells][:, :, None])[:, :, 0], points[:, ::-1], atol=1e-13
    )
    with pytest.raises(ValueError, match="outside"):
        sample(d, np.array([[2.0, 0.0]]))


def test_clamp_without_a_node_at_the_middle_holds_what_its_neighbours_interpolate(strip, tmp_path):
    """A rigid rotation about the middle moves both neighbours by what the clamp leaves them: nothing across."""
    points, quads, lines = parts(ny=3, height=0.3, tilt=0.0)
    y = points[:, 1] / 0.15
    points[:, 1] = 0.15 * (y + 0.4 * (1 - y**2))
    body = build_body(
        strip(mesh_file=write(tmp_path / "a.msh", points, quads, lines), element="Q1", height=0.3)
    )
    edge = body.mesh.edges["start"]
    y = body.mesh.nodes[edge, 1]
    middle = y[[0, -1]].mean()
    assert np.abs(y - middle).min() > 1e-3
    stretched = np.stack([0 * body.mesh.nodes[:, 0], body.mesh.nodes[:, 1] - middle], 1)
    for field, held in ((stretched, False), (stretched * 0 + [0.0, 1.0], True)):
        q = np.linalg.lstsq(body.expansion.toarray(), field.ravel(), rcond=None)[0]
        error = np.abs(body.expansion @ q - field.ravel()).max()
        assert (error > 0.1) if held else (error < 1e-13)
