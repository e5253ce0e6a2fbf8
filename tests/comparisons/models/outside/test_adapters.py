"""The adapters of programs of others: their scenes, their known errors, and their reasons."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.models import certified, find, solve
from comparisons.models.model import ModelError, Options
from comparisons.models.outside import Functions
from comparisons.scene import LoadSpec, Scene, load_scene

ROOT = Path(__file__).parents[4]
FINDINGS = Path(__file__).parents[2] / "findings"
KS, FACE = load_scene("ks-cantilever"), load_scene("ks-face")
PAIR = "pin->cantilever"
BEAM = KS.beams[0]
UNIT = BEAM.EI / BEAM.length**2


def loaded(load_parameters: int, **load: Any) -> Scene:
    """The beam of KS under a load at its end."""
    loads = (LoadSpec(beam=BEAM.name, end="end", **load),)
    return replace(KS, pins=(), contacts=(), loads=loads, load_parameters=load_parameters)


TIP, ROLL = loaded(5, force=(0.0, 5.0 * UNIT)), loaded(10, moment=np.pi * UNIT * BEAM.length)
PORTAL, TIED = load_scene(str(FINDINGS / "portal.toml")), load_scene("ks-tied-tip")
DOUBLE = load_scene("double-beam")
(X, Y), (U, V) = FACE.pins[0].points
A_TENTH = replace(
    FACE,
    pins=(replace(FACE.pins[0], path=((X, Y), (X + 0.1 * (U - X), Y + 0.1 * (V - Y))), start=None, displacement=None),),
    load_parameters=5,
)  # fmt: skip


def needs(name: str) -> Any:
    """Mark of a test that needs a program; without it, the test is skipped with a line."""
    missing = find(name).missing()  # type: ignore[attr-defined]
    return pytest.mark.skipif(missing is not None, reason=str(missing))


def row(name: str, case: str) -> Any:
    return pytest.param(case, marks=needs(name))


def in_steps(name: str, steps: int, folder: Path) -> str:
    """Return a program file of an adapter with another number of load steps."""
    words = [sys.executable, "-m", f"comparisons.models.outside.adapters.{name}", str(steps)]
    file = folder / "steps.toml"
    file.write_text(f'[program]\nname = "{name}-steps"\ncommand = {json.dumps(words)}\nelements = [20]\n')
    return str(file)


def answered(name: str, scene: Scene, elements: int) -> Response:
    return certified(solve(scene, name, Options(elements=elements)), scene)


@pytest.mark.slow
@needs("opensees")
def test_opensees_loses_the_contact_in_long_steps_and_reports_success(tmp_path):
    response = certified(solve(KS, in_steps("opensees", 50, tmp_path), Options(elements=20)), KS)
    assert (response.reported_success, response.false_success) == (True, True)
    assert response.contacts[PAIR].force[-1] == 0.0


KNOWN = {
    "opensees-pin": (KS, 20, 9.9e-3), "exudyn-pin": (KS, 10, 1.4e-2), "felupe-pin": (KS, 20, 1.02e-2),
    "calculix-face": (A_TENTH, 50, 2e-3), "opensees-tip": (TIP, 10, 5e-3), "exudyn-tip": (TIP, 10, 1e-3),
    "felupe-tip": (TIP, 10, 2e-2), "calculix-tip": (TIP, 10, 5e-3), "opensees-roll": (ROLL, 10, 5e-3),
    "exudyn-roll": (ROLL, 10, 1e-3), "opensees-portal": (PORTAL, 10, 3e-2),
}  # fmt: skip
"""Scene of a program, elements, and distance from the exact equilibrium: under a pin the error of the contact force as a vector, to a
tenth; else a bound. In the portal it is the displacement, by .022, from the shear that OpenSees's elements leave out."""


@pytest.mark.slow_at(*(KNOWN.keys() - {"opensees-tip", "opensees-roll", "exudyn-tip"}))
@pytest.mark.parametrize("case", [row(case.partition("-")[0], case) for case in KNOWN])
def test_a_program_has_its_known_error(case, tmp_path):
    (given, elements, error), (name, _, what) = KNOWN[case], case.partition("-")
    response = answered(in_steps(name, 10, tmp_path) if what == "face" else name, given, elements)
    assert response.completed, response.message
    assert response.certificate is not None
    assert response.certificate.certified, response.certificate.reason
    distance = response.certificate.judged[-1].distance
    assert distance is not None
    if what == "pin":
        assert distance.sizes["force"] == pytest.approx(error, rel=0.1)
    else:
        assert (distance.sizes["force"] if what == "face" else distance.largest[1]) < error
    if case == "opensees-pin":
        along = response.material_force["cantilever"][-1] / response.contacts[PAIR].force[-1]
        assert abs(along) == pytest.approx(3.8e-3, rel=0.1)


@needs("exudyn")
@pytest.mark.slow
def test_exudyn_is_off_in_the_middle_of_a_path_and_reports_success():
    """Ten elements: right at the end to 5e-3, and off by more than 5 % of the largest reaction after the strip has buckled."""
    response = answered("exudyn", TIED, 10)
    assert (response.status, response.false_success) == ("NOT_AN_EQUILIBRIUM", True)
    assert response.certificate is not None
    apart = [one.distance.largest[1] for one in response.certificate.judged if one.distance is not None]
    assert apart[-1] < 5e-3
    assert max(apart) > 0.05


def rough(scene: Scene) -> Scene:
    """Return a scene with friction at its contacts."""
    return replace(scene, contacts=tuple(replace(item, friction=0.3) for item in scene.contacts))


ONE_STRIP = "the adapter has one strip of rectangular section with one support"
FRICTIONLESS = "the adapter has frictionless contacts, the scene has friction at pin->"
REASONS = [
    ("opensees", DOUBLE, "BeamContact2D touches beams with pins only, the scene with upper.end"),
    ("exudyn", PORTAL, "ANCF cables have no rigid joint"),
    ("exudyn", FACE, "a sliding joint holds a pin on the axis from the start on, pin is not there"),
    ("exudyn", rough(KS), FRICTIONLESS),
    ("felupe", PORTAL, ONE_STRIP),
    ("felupe", ROLL, "the adapter has dead forces at the free end, no moments"),
    ("calculix", KS, "the adapter has a sharp pin on the right face, on a straight path"),
    ("calculix", ROLL, "the adapter has a transverse force at the free end"),
]


@pytest.mark.parametrize(("name", "scene", "reason"), REASONS)
def test_a_scene_that_cannot_be_stated_has_its_reason(name, scene, reason, monkeypatch):
    """Without a process."""
    monkeypatch.setattr("subprocess.Popen", None)
    said = find(name).refusal(scene)
    assert said is not None
    assert said.startswith(reason)
    assert "\n" not in said
    assert " is needed" in (find(name).refusal(TIP) or " is needed"), "a tip load is stated by all"


def test_a_program_that_is_not_installed_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ModelError, match=r"^calculix: Debian's calculix-ccx is needed: there is no program"):
        solve(TIP, "calculix")
    assert find("calculix").refusal(TIP) is not None


def given(scene: Scene) -> dict[str, Any]:
    """Return what a program gets of a scene when it is asked whether it states it."""
    seen: list[dict[str, Any]] = []
    Functions(name="spy", refuses=seen.append, states=lambda *_: iter(())).refusal(scene)  # type: ignore[arg-type, func-returns-value]
    return seen[0]


def test_a_pin_at_rest_has_a_path_of_two_points():
    """Programs pair the points of a path with load parameters: 0, the corners, and 1."""
    pin = replace(KS.pins[0], start=(0.7, 0.0), displacement=(0.0, 0.0))
    (stated,) = given(replace(KS, pins=(pin,), loads=TIP.loads))["pins"]
    assert (stated["path"], stated["corners"]) == ([[0.7, 0.0]] * 2, [])


def test_what_a_program_prints_does_not_reach_the_answer():
    code = """
import sys
from comparisons.models.outside import StoppedError, serve
def states(scene, histories):
    print("chatter", flush=True)
    raise StoppedError("no luck")
    yield
serve(lambda scene: None, states)
print("more chatter", flush=True)
"""
    run = subprocess.run(
        [sys.executable, "-c", code], input=json.dumps(given(TIP) | {"load_parameters": [1.0]}),
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert run.stderr.split() == ["chatter", "more", "chatter"]
    found = json.loads(run.stdout)
    assert (found["status"], found["message"], found["load_parameter"]) == ("STOPPED", "no luck", [])
