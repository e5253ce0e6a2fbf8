"""The scene whose point is tied to the tip, by the rod and by beams, in every position of the plane."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.exact.tied import rod_with_tied_tip
from comparisons.models import solve
from comparisons.models.options import ModelError
from comparisons.response import Response
from comparisons.scene import LoadSpec, Scene, SupportSpec, load_scene

TIED = load_scene("ks-tied-tip")
BEAM, CLAMPED = "cantilever", "cantilever.start"
TURN = np.array([[0.6, -0.8], [0.8, 0.6]])


def moved(*, mirrored: bool, from_end: bool) -> Scene:
    """The same physics turned, shifted, perhaps mirrored, with the beam perhaps running towards its clamp."""
    turn = TURN @ np.diag([1.0, -1.0 if mirrored else 1.0])
    places = [(3.0, -2.0), tuple(float(x) for x in turn[:, 0] + np.array([3.0, -2.0]))]
    start, end = places[::-1] if from_end else places
    clamp, tip = ("end", "start") if from_end else ("start", "end")
    beam = replace(TIED.beams[0], start=start, end=end, clamped=(clamp,))
    displacement = tuple(float(x) for x in turn @ np.array(TIED.supports[0].displacement))
    return replace(
        TIED, beams=(beam,), supports=(replace(TIED.supports[0], end=tip, displacement=displacement),)
    )  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def rod() -> Response:
    return solve(TIED, "rod")


def at_tip(response: Response, scene: Scene = TIED) -> np.ndarray:
    (tip,) = (response.supports[item.node] for item in scene.supports)
    assert np.all(tip.moment == 0.0)
    return tip.force


def test_the_rod_states_clamp_and_tip(rod: Response) -> None:
    beam = TIED.beams[0]
    path = rod_with_tied_tip(
        [(1.0, 0.0), *((1.0 - t, 2.0 / np.pi * t) for t in TIED.times)],
        EA=beam.EA,
        GA=beam.GA,
        EI=beam.EI,
        length=1.0,
    )
    assert rod.completed, rod.message
    assert rod.contacts == {}
    np.testing.assert_allclose(at_tip(rod), path.force[1:], rtol=1e-12)
    np.testing.assert_allclose(rod.supports[CLAMPED].force, -path.force[1:], rtol=1e-12)
    np.testing.assert_allclose(rod.supports[CLAMPED].moment, path.clamp_moment[1:], rtol=1e-12)
    np.testing.assert_allclose(rod.tips[BEAM][-1], [0.0, 2.0 / np.pi], atol=1e-15)
    np.testing.assert_allclose(rod.axis_line(BEAM, 24)[1][-1], rod.tips[BEAM][24], atol=1e-13)


@pytest.mark.parametrize("from_end", [False, True])
@pytest.mark.parametrize("mirrored", [False, True])
def test_the_rod_moves_with_the_scene(rod: Response, mirrored: bool, from_end: bool) -> None:
    scene = moved(mirrored=mirrored, from_end=from_end)
    there = solve(scene, "rod")
    sign = -1.0 if mirrored else 1.0
    turn = TURN @ np.diag([1.0, sign])
    assert there.completed, there.message
    np.testing.assert_allclose(at_tip(there, scene), at_tip(rod) @ turn.T, atol=1e-9 * 2.8e-4)
    np.testing.assert_allclose(
        there.supports[scene.all_supports[0].node].moment,
        sign * rod.supports[CLAMPED].moment,
        atol=1e-9 * 2.8e-4,
    )
    np.testing.assert_allclose(there.tips[BEAM], rod.tips[BEAM] @ turn.T + [3.0, -2.0], atol=1e-14)


def test_beams_follow_the_rod(rod: Response) -> None:
    beams = solve(TIED, "tsm")
    assert beams.completed, beams.message
    scale = np.abs(at_tip(rod)).max()
    assert np.abs(at_tip(beams) - at_tip(rod)).max() < 5e-6 * scale
    assert np.abs(beams.supports[CLAMPED].moment - rod.supports[CLAMPED].moment).max() < 5e-6 * scale
    np.testing.assert_array_equal(beams.tips[BEAM], rod.tips[BEAM])


def test_json_names_the_clamp_and_the_tip(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "ks-tied-tip", "--model", "rod", "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["contacts"] == {}
    assert data["events"] is None
    assert list(data["supports"]) == [CLAMPED, f"{BEAM}.end"]
    assert np.array(data["supports"][f"{BEAM}.end"]["force"])[-1] / 2.8e-4 == pytest.approx(
        [-2.78166798, -8.54820614], rel=1e-8
    )


@pytest.mark.slow
def test_compare_measures_the_force_on_the_tip_and_leaves_out_who_cannot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["compare", "ks-tied-tip", "--out", str(tmp_path)])
    err = capsys.readouterr().err
    assert (
        "elastica: left out, elastica: the elastica is pushed by a pin, the scene moves the beam's end" in err
    )
    runs = {
        run["label"]: run["errors"] for run in json.loads((tmp_path / "summary.json").read_text())["runs"]
    }
    assert runs["TSM mixed, 20 elements"]["path"]["force"] < 5e-6
    assert runs["TSM mixed, 20 elements"]["path"]["arc"] is None
    assert runs["solid"]["path"]["force"] < 2e-2
    assert "contact points" not in (tmp_path / "tsm" / "tsm-0001.vtm").read_text()


CLAMP = SupportSpec(beam=BEAM, end="start", kind="clamped")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (
            replace(TIED, supports=(replace(TIED.supports[0], kind="clamped"),)),
            'a pinned support at the free end of beam "cantilever"',
        ),
        (
            replace(TIED, supports=(), loads=(LoadSpec(beam=BEAM, end="end", moment=1.0),)),
            'no dead loads, the scene loads "cantilever.end"',
        ),
        (
            replace(
                TIED, beams=(replace(TIED.beams[0], clamped=()),), supports=(replace(CLAMP, rotation=0.1),)
            ),
            'the clamp at rest, "cantilever.start" moves',
        ),
        (
            replace(
                TIED,
                beams=(replace(TIED.beams[0], clamped=()),),
                supports=(replace(CLAMP, kind="pinned"), TIED.supports[0]),
            ),
            'one end clamped, none of beam "cantilever" is',
        ),
        (
            replace(
                load_scene("ks-cantilever"),
                loads=(LoadSpec(beam=BEAM, end="end", moment=1.0),),
            ),
            'no dead loads, the scene loads "cantilever.end"',
        ),
        (
            replace(load_scene("ks-cantilever"), supports=TIED.supports),
            'one support, beam "cantilever" has two',
        ),
    ],
)
def test_scenes_that_the_elastica_cannot_state(scene: Scene, reason: str) -> None:
    with pytest.raises(ModelError) as caught:
        solve(scene, "elastica")
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    assert reason in line
