"""What `crossval run QUESTION` finds about the solid, against its bars."""

import csv

import numpy as np
import pytest

import fem_reference
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.solid import to_solid
from comparisons.scene import load_scene
from comparisons.suite import changed

SCENES = ("ks-cantilever", "ks-face")


def asked(question, folder):
    """Return the table that the command writes, its numbers as numbers, without those that are not known."""
    assert main(["run", question, "--out", str(folder)]) == 0
    with (folder / f"{question}.csv").open() as file:
        rows = list(csv.DictReader(file))
    words = {"scene", "meshes", "message"}
    return [{key: cell if key in words else float(cell) for key, cell in row.items() if cell} for row in rows]


@pytest.mark.slow
def test_solid_becomes_the_rod_as_its_height_squared(tmp_path, capsys, stated):
    """Within .1 % of the force and .05 % of the arc position at h/L = .02; the table is printed, too."""
    rows = asked("thin-beams", tmp_path)
    printed = capsys.readouterr().out
    assert printed.startswith("h_over_L")
    assert str(tmp_path / "thin-beams.csv") in printed
    assert [row["h_over_L"] for row in rows] == [0.02, 0.01, 0.005]
    assert rows[0]["contact_force"] < 1e-3
    assert rows[0]["arc_position"] < 5e-4
    assert "contact_force_order" not in rows[0]
    for row in rows[1:]:
        for name in ("contact_force_order", "arc_position_order"):
            assert row[name] == pytest.approx(2, abs=0.15)
    for row in rows:
        stated(f"solid.thin-{row['h_over_L']:g}", row["contact_force"], row["arc_position"])
    stated("solid.thin-orders", *(row["contact_force_order"] for row in rows[1:]))


@pytest.mark.slow
def test_q2_does_not_lock(tmp_path, stated):
    for row in asked("locking", tmp_path):
        assert abs(row["Q2"]) < (5e-3 if row["poissons_ratio"] > 0.49 and row["h_over_L"] > 0.01 else 3e-4)
        assert abs(row["Q1"]) > 0.05
        if row["h_over_L"] < 0.01:
            assert abs(row["Q2-full"]) > 20 * abs(row["Q2"])
        case = f"{row['h_over_L']:g}-{row['poissons_ratio']:g}"
        stated(f"solid.locking-{case}", row["Q1"], row["Q2-full"], row["Q2"])


@pytest.mark.slow
def test_scatter_is_within_its_bar(tmp_path, stated):
    rows = asked("scatter", tmp_path)
    assert len(rows) == 8
    for name in SCENES:
        meshes, *finer = (
            max(row["contact_force"], row["arc_position"]) for row in rows if row["scene"] == name
        )
        assert meshes <= 2e-4
        assert max(finer) <= 3e-4
        stated(f"solid.scatter-{name}", meshes)
        stated(f"solid.finer-{name}", max(finer))
        stated(f"solid.last-{name}", finer[-1])


@pytest.mark.slow
def test_penalty_is_valid_over_many_decades_and_named_below(tmp_path, stated):
    """From 10 to 1e13 N/m the force is right; over the eleven decades to 1e12 the penetration falls as 1 / eps."""
    found = asked("penalty", tmp_path)
    for scene in SCENES:
        rows = [row for row in found if row["scene"] == scene]
        soft, valid = ([row for row in rows if ("penetration" not in row) is part] for part in (True, False))
        assert all("penalty leaves a penetration above its limit" in str(row["message"]) for row in soft)
        assert [row["penalty"] for row in soft] == pytest.approx([1e-3, 1e-2, 0.1, 1.0])
        assert [row["penalty"] for row in valid] == pytest.approx(10.0 ** np.arange(1, 14))
        window = valid[:-1]
        penetration = np.array([row["penetration"] for row in window])
        # of two places about 1 m from the origin; 1e-15 m is penetrated at 1e12 N/m
        round_off = 2 * np.finfo(float).eps
        np.testing.assert_allclose(penetration[1:], penetration[:-1] / 10, rtol=0.01, atol=round_off)
        assert all(row["force_error"] < 1e-3 for row in valid)
        stated("solid.penalty", window[0]["penalty"], window[-1]["penalty"])


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_solid_of_the_rods_law_is_the_rod_at_every_load_parameter(name, stated):
    """After extrapolation of the mesh, without penetration, past t = .1."""
    scene = load_scene(name)
    (rod,) = solve(scene, "rod").contacts.values()
    ideal = changed(scene, {"beam.material": "biot-linear", "contact.penetration": 1e-10})
    coarse, fine = (
        next(iter(fem_reference.solve(to_solid(ideal, mesh=mesh), np.array(scene.times)).contacts.values()))
        for mesh in ((50, 2), (100, 4))
    )
    found = []
    for quantity, allowed in (("force", 1e-3), ("arc_position", 5e-4)):
        coarser, finer, exact = (getattr(one, quantity) for one in (coarse, fine, rod))
        limit = finer + (finer - coarser) / 3
        found.append(np.abs(limit / exact - 1)[np.array(scene.times) > 0.1].max())
        assert found[-1] <= allowed
    stated(f"solid.rods-law-{name}", *found)
