"""CalculiX is asked what the solid is asked, and answers the same; where it does not, the reason is named."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fem_reference
from comparisons.cli import main
from comparisons.models.outside.adapters.calculix import parse, pressed, run, states, tip_load
from comparisons.models.outside.adapters.exchange import Histories, StoppedError
from comparisons.models.outside.child import ProgramError
from comparisons.models.solid import to_solid
from comparisons.scene import load_scene

# the study whose numbers the pages state, and the input file and the output of CalculiX, which is not everywhere
from comparisons.suites.solid_accuracy import peers
from tests.comparisons.models.outside.test_adapters import TIP, given

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
PROBLEM = to_solid(load_scene("ks-face"))
STRIP = PROBLEM.strips[0]
FORCE = STRIP.bending_stiffness / STRIP.length**2
DAT = """
 displacements (vx,vy,vz) for set TIP and time  0.5000000E+00

         7  1.000000E-01 -2.000000-101  0.000000E+00

 forces (fx,fy,fz) for set CLAMP and time  0.5000000E+00

         1 -1.000000E+00  2.000000E+00  0.000000E+00
         2 -1.000000E+00  2.0000"""


def fake(folder: Path, monkeypatch: pytest.MonkeyPatch, script: str) -> None:
    """Put a ``ccx`` of our own first on the path."""
    program = folder / "ccx"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")


def test_without_calculix_or_where_it_stops_the_study_says_so(tmp_path, monkeypatch, capsys):
    study = ["run", "peers", "--out", str(tmp_path / "out")]
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(study) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "crossval: CalculiX is needed: there is no program ccx on the path (Debian: calculix-ccx)\n"
    fake(tmp_path, monkeypatch, "echo ' increment 1'; echo ' *ERROR: no'; echo '        luck'; exit 201")
    assert main(study) == 3
    assert capsys.readouterr().err == "crossval: CalculiX stopped: *ERROR: no luck\n"
    fake(tmp_path, monkeypatch, "exec sleep 20")
    assert run("", seconds=0.1) == ([], {}, "did not finish within 0.1 s")
    fake(tmp_path, monkeypatch, "echo Job finished")
    with pytest.raises(ProgramError, match="printed no result"):
        tip_load(STRIP, FORCE)


def test_what_is_printed_is_read_and_what_is_cut_off_is_not():
    times, tables = parse(DAT)
    assert times == [0.5]
    assert tables == {
        ("displacements", "TIP"): [[[0.1, -2e-101, 0.0]]],
        ("forces", "CLAMP"): [[[-1.0, 2.0, 0.0]]],
    }


def test_the_adapter_states_the_strip_of_the_solid(tmp_path, monkeypatch):
    """What CalculiX reads before its first step: nodes, bricks, material and clamp."""
    fake(tmp_path, monkeypatch, f"cp job.inp {tmp_path}/deck")
    scene, decks = given(TIP) | {"load_parameters": [1.0]}, []
    strip = replace(to_solid(TIP).strips[0], mesh=(scene["beams"][0]["elements"], 2))
    for asked in (lambda: tip_load(strip, FORCE), lambda: next(states(scene, Histories(scene)))):
        with pytest.raises((ProgramError, StoppedError)):
            asked()
        decks.append((tmp_path / "deck").read_text().partition("*STEP")[0])
    assert "*ELASTIC" in decks[0]
    assert decks[0] == decks[1]


@needs_ccx
@pytest.mark.slow
def test_pin_on_the_face_up_to_a_tenth(stated):
    """5e-5 of the force, whatever the step; 1e-5 with the same contact stiffness."""
    start, end = PROBLEM.pins[0].path
    way = tuple(a + 0.1 * (b - a) for a, b in zip(start, end, strict=True))
    problem = replace(PROBLEM, pins=(replace(PROBLEM.pins[0], path=(start, way)),))
    coarse, fine = (np.hypot(*pressed(STRIP, (start, way), steps, 20.0).force.T) for steps in (10, 20))
    assert (coarse.size, fine.size) == (10, 20)
    np.testing.assert_allclose(coarse, fine[1::2], rtol=1e-6)
    stated("calculix.two-steps", np.abs(coarse / fine[1::2] - 1.0).max(), bound=True)
    t, contact = np.arange(1, 11) / 10, problem.contacts[0]
    own = ({"penetration": 1e-10}, {"penalty": 20.0})
    solids = [fem_reference.solve(replace(problem, contacts=(replace(contact, **how),)), t) for how in own]
    hard, soft = (solid.contacts["pin->cantilever"].force for solid in solids)
    np.testing.assert_allclose(coarse, hard, rtol=1e-4)
    error = np.abs(coarse / soft - 1.0).max()
    assert error <= 1e-5
    stated("calculix.same-stiffness", error, bound=True)


@needs_ccx
@pytest.mark.slow
@pytest.mark.long
def test_study_is_within_its_bars(stated):
    rows = list(peers())
    tips = [row for row in rows if row["case"].startswith("tip load")]
    assert len(tips) == 8
    assert all(row["difference"] <= 1e-3 for row in tips)
    pins = [row for row in rows if row not in tips]
    reached = {row["step"]: row["reached"] for row in pins}
    assert list(reached) == [0.02, 0.01, 0.005, 0.0025]
    assert min(reached.values()) >= 0.02
    assert max(reached.values()) >= 0.5
    for row in pins:
        assert row["message"] or row.get("calculix")
        assert row["largest"] <= 1e-3
    for clamp in ("rod", "full"):
        for mesh in ("50x2", "100x4"):
            found = [row["difference"] for row in tips if (row["clamp"], row["mesh"]) == (clamp, mesh)]
            stated(f"calculix.{clamp}-{mesh}", *found)
    for step in reached:
        of_step = [row for row in pins if row["step"] == step]
        there = [row["difference"] for row in of_step if "difference" in row]
        stated(f"calculix.pin-{step:g}", of_step[0]["reached"], *there)
        stated(f"calculix.largest-{step:g}", of_step[0]["largest"])
