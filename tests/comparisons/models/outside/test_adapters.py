"""The adapters of programs of others: their scenes, their known errors, and their reasons."""

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.models import certified, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.adapters import calculix, exudyn, felupe, opensees
from comparisons.models.outside.adapters.exchange import Histories
from comparisons.models.outside.adapters.frame import frame
from comparisons.models.outside.program import Program
from comparisons.models.outside.programs import ADAPTERS, ROOT
from comparisons.models.outside.request import request
from comparisons.response import Response
from comparisons.response.material import frictions
from comparisons.scene import LoadSpec, Scene, load_scene

FINDINGS = Path(__file__).parents[2] / "findings"
KS = load_scene("ks-cantilever")
FACE = load_scene("ks-face")
BEAM = KS.beams[0]
UNIT = BEAM.EI / BEAM.length**2
TIP = replace(
    KS,
    pins=(),
    contacts=(),
    loads=(LoadSpec(beam=BEAM.name, end="end", force=(0.0, 5.0 * UNIT)),),
    load_parameters=5,
)
ROLL = replace(
    TIP,
    loads=(LoadSpec(beam=BEAM.name, end="end", moment=np.pi * BEAM.EI / BEAM.length),),
    load_parameters=10,
)


def needs(name: str) -> Any:
    """Mark of a test that needs a program; without it, the test is skipped with a line."""
    missing = ADAPTERS[name].missing()
    return pytest.mark.skipif(missing is not None, reason=str(missing))


def data(scene: Scene, elements: int = 10) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(request(scene, Options(elements=elements), scene.times))
    return found


def in_steps(name: str, steps: int, folder: Path) -> str:
    """Return a program file of an adapter with another number of load steps."""
    words = [sys.executable, "-m", f"comparisons.models.outside.adapters.{name}", str(steps)]
    file = folder / "steps.toml"
    file.write_text(f'[program]\nname = "{name}-steps"\ncommand = {json.dumps(words)}\nelements = [20]\n')
    return str(file)


def answered(name: str, scene: Scene, elements: int = 10) -> Response:
    return certified(solve(scene, name, Options(elements=elements)), scene)


def certified_error(response: Response) -> float:
    """Error of the contact force at the last load parameter, as a vector, by the certificate."""
    assert response.certificate is not None
    assert response.certificate.judged[-1].distance is not None
    return response.certificate.judged[-1].distance.force


@needs("opensees")
@pytest.mark.slow
def test_opensees_has_its_known_error_under_the_pin() -> None:
    """9.9e-3 at 20 elements and 1,000 steps; the tangential force is 3.8e-3 of the contact force."""
    response = answered("opensees", KS, 20)
    assert response.completed, response.message
    assert certified_error(response) == pytest.approx(9.9e-3, rel=0.1)
    assert abs(frictions(response, KS)["cantilever"][-1]) == pytest.approx(3.8e-3, rel=0.1)


@needs("opensees")
def test_opensees_loses_the_contact_in_long_steps_and_reports_success(tmp_path: Path) -> None:
    response = certified(solve(KS, in_steps("opensees", 50, tmp_path), Options(elements=20)), KS)
    assert response.reported_success
    assert response.false_success
    assert response.contacts["pin->cantilever"].force[-1] == 0.0


@needs("exudyn")
@pytest.mark.slow
def test_exudyn_has_its_known_error_under_the_pin() -> None:
    """1.4e-2 at 10 elements."""
    response = answered("exudyn", KS, 10)
    assert response.completed, response.message
    assert certified_error(response) == pytest.approx(1.4e-2, rel=0.1)


@needs("felupe")
@pytest.mark.slow
def test_felupe_under_the_pin_with_twenty_elements() -> None:
    """1.0e-2 with 20 elements, 3e-4 with 50."""
    response = answered("felupe", KS, 20)
    assert response.completed, response.message
    assert certified_error(response) == pytest.approx(1.02e-2, rel=0.1)


@needs("calculix")
@pytest.mark.slow
def test_calculix_under_a_pin_on_the_face_up_to_a_tenth(tmp_path: Path) -> None:
    pin = FACE.pins[0]
    (x, y), (u, v) = pin.points
    short = replace(pin, path=((x, y), (x + 0.1 * (u - x), y + 0.1 * (v - y))), start=None, displacement=None)
    scene = replace(FACE, pins=(short,), load_parameters=5)
    response = certified(solve(scene, in_steps("calculix", 10, tmp_path), Options(elements=50)), scene)
    assert response.completed, response.message
    assert certified_error(response) < 2e-3


SCENES = {
    "opensees": {"tip": 5e-3, "roll": 5e-3, "portal": 3e-2},
    "exudyn": {"tip": 1e-3, "roll": 1e-3},
    "felupe": {"tip": 2e-2},
    "calculix": {"tip": 5e-3},
}
"""Largest distance from the exact equilibrium with 10 elements, by program and scene. In the portal it is the displacement, by .022, from the shear
that OpenSees's elements leave out, with any number of them."""
STATED = {
    "tip": TIP,
    "roll": ROLL,
    "portal": load_scene(str(FINDINGS / "portal.toml")),
    "tied": load_scene("ks-tied-tip"),
}


@pytest.mark.slow_at("calculix-tip", "exudyn-roll", "exudyn-tip", "felupe-tip", "opensees-portal")
@pytest.mark.parametrize(
    ("name", "scene"),
    [pytest.param(name, scene, marks=needs(name)) for name, scenes in SCENES.items() for scene in scenes],
)
def test_scenes_without_contact(name: str, scene: str) -> None:
    response = answered(name, STATED[scene], 10)
    assert response.completed, response.message
    assert response.certificate is not None
    assert response.certificate.certified, response.certificate.reason
    assert response.certificate.judged[-1].distance is not None
    assert response.certificate.judged[-1].distance.largest[1] < SCENES[name][scene]


@needs("exudyn")
@pytest.mark.slow
def test_exudyn_is_off_in_the_middle_of_a_path_and_reports_success() -> None:
    """Ten elements: right at the end to 5e-3, and off by more than 5 % of the largest reaction after the strip has buckled, which is why every load parameter is judged."""
    response = answered("exudyn", STATED["tied"], 10)
    assert (response.status, response.false_success) == ("NOT_AN_EQUILIBRIUM", True)
    assert response.certificate is not None
    judged = response.certificate.judged
    assert judged[-1].distance is not None
    assert judged[-1].distance.largest[1] < 5e-3
    assert max(one.distance.largest[1] for one in judged if one.distance is not None) > 0.05


def rough(scene: Scene) -> Scene:
    """Return a scene with friction at its contacts."""
    return replace(scene, contacts=tuple(replace(item, friction=0.3) for item in scene.contacts))


@needs("opensees")
@pytest.mark.slow
def test_opensees_with_friction_has_a_known_error_under_the_pin() -> None:
    """6.1e-3 of the force at the end with 20 elements and 1,000 steps, and 1.3e-3 L of the arc position."""
    response = answered("opensees", load_scene("ks-friction"), 20)
    contact = response.contacts["pin->cantilever"]
    assert response.completed, response.message
    assert contact.force[-1] == pytest.approx(2.110304862086e-3 * (1.0 + 6.1e-3), rel=1e-3)
    assert contact.arc_position[-1] == pytest.approx(0.847142560461 - 1.3e-3, abs=2e-4)


@needs("opensees")
@pytest.mark.slow_at("20", "200")
@pytest.mark.parametrize("steps", [20, 60, 200])
def test_opensees_with_friction_loses_the_contact_in_long_steps_and_reports_success(
    steps: int, tmp_path: Path
) -> None:
    scene = load_scene("ks-friction")
    response = certified(solve(scene, in_steps("opensees", steps, tmp_path), Options(elements=20)), scene)
    assert response.reported_success
    assert response.false_success
    assert response.contacts["pin->cantilever"].force[-1] == 0.0


PORTAL, DOUBLE = STATED["portal"], load_scene("double-beam")
REASONS: list[tuple[Callable[[dict[str, Any]], str | None], Scene, str]] = [
    (opensees.refusal, DOUBLE, "BeamContact2D touches beams with pins only, the scene with upper.end"),
    (exudyn.refusal, PORTAL, "ANCF cables have no rigid joint"),
    (exudyn.refusal, FACE, "a sliding joint holds a pin on the axis from the start on, pin is not there"),
    (exudyn.refusal, DOUBLE, "a sliding joint holds a pin on the axis from the start on, "),
    (felupe.refusal, PORTAL, "the adapter has one strip of rectangular section with one support"),
    (felupe.refusal, ROLL, "the adapter has dead forces at the free end, no moments"),
    (calculix.refusal, KS, "the adapter has a sharp pin on the right face, on a straight path"),
    (calculix.refusal, ROLL, "the adapter has a transverse force at the free end"),
    (calculix.refusal, DOUBLE, "the adapter has one strip of rectangular section with one support"),
    *(
        (
            adapter.refusal,
            rough(scene),
            "the adapter has frictionless contacts, the scene has friction at pin->",
        )
        for adapter, scene in ((exudyn, KS), (felupe, FACE), (calculix, FACE))
    ),
]


@pytest.mark.parametrize(("refusal", "scene", "reason"), REASONS)
def test_a_scene_that_cannot_be_stated_has_its_reason(
    refusal: Callable[[dict[str, Any]], str | None], scene: Scene, reason: str
) -> None:
    said = refusal(data(scene))
    assert said is not None
    assert said.startswith(reason)
    assert "\n" not in said


@pytest.mark.parametrize("name", ADAPTERS)
def test_an_adapter_is_asked_without_a_process(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("comparisons.models.outside.source.run", None)
    said = ADAPTERS[name].refusal(DOUBLE)
    assert said is not None
    assert said.startswith(tuple(reason for _, scene, reason in REASONS if scene is DOUBLE))


@pytest.mark.parametrize("refusal", [opensees.refusal, exudyn.refusal, felupe.refusal, calculix.refusal])
def test_a_tip_load_is_stated_by_all(refusal: Callable[[dict[str, Any]], str | None]) -> None:
    assert refusal(data(TIP)) is None


def test_a_program_that_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(
        ADAPTERS, "opensees", Program(replace(ADAPTERS["opensees"].source, requires="no_such_module"))
    )
    with pytest.raises(ModelError, match=r"^opensees: openseespy is needed: install tsm-crossval"):
        solve(TIP, "opensees")
    assert ADAPTERS["opensees"].refusal(TIP) is not None


def test_joined_beams_share_a_node() -> None:
    scene = data(PORTAL, 4)
    mesh = frame(scene)
    beams = len(scene["beams"])
    assert len(mesh.points) == 5 * beams - sum(len(ends) - 1 for ends in scene["joints"])
    assert len(mesh.elements) == 4 * beams
    for ends in scene["joints"]:
        nodes = {mesh.node(dict(zip(("beam", "end"), end.split("."), strict=True))) for end in ends}
        assert len(nodes) == 1
    for item in mesh.elements:
        a, b = (np.array(mesh.points[node]) for node in item.nodes)
        assert np.hypot(*(b - a)) == pytest.approx(item.length)


def test_supports_are_stated_by_their_ends() -> None:
    tied = STATED["tied"]
    histories = Histories(data(tied))
    for number, item in enumerate(tied.all_supports):
        histories.support(item.node, (float(number), 0.0), 0.0)
    supports = histories.tables()["supports"]
    assert {node: one["force"] for node, one in supports.items()} == {
        item.node: [[float(number), 0.0]] for number, item in enumerate(tied.all_supports)
    }


def test_what_a_program_prints_does_not_reach_the_answer() -> None:
    code = """
import sys
from comparisons.models.outside.adapters.exchange import StoppedError, serve
def states(scene, histories):
    print("chatter", flush=True)
    raise StoppedError("no luck")
    yield
serve(lambda scene: None, states)
print("more chatter", flush=True)
"""
    run = subprocess.run(
        [sys.executable, "-c", code],
        input=request(TIP, Options(), TIP.times),
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stderr.split() == ["chatter", "more", "chatter"]
    found = json.loads(run.stdout)
    assert (found["status"], found["message"], found["load_parameter"]) == ("STOPPED", "no luck", [])
