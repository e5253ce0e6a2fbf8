"""Keys that not every model knows: what they state, and that a model refuses in one line what it does not state."""

import math

import numpy as np
import pytest

from comparisons.models import MODELS, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.request import request
from comparisons.scene import SPECIAL, Scene, read_scene, to_toml
from comparisons.scene.consistency import signed_gap
from comparisons.scene.keys import PROGRAMS, special_keys

HEAD = '[scene]\nname = "s"\nload_parameters = 4\n'
BEAM = """[[beam]]
name = "a"
start = [0.0, 0.0]
end = [1.0, 0.0]
clamped = ["start"]
width = 0.02
height = 0.01
youngs_modulus = 7e10
poissons_ratio = 0.3
"""
PIN = '[[pin]]\nname = "p"\nstart = [0.7, -0.1]\ndisplacement = [0.0, 0.3]\n[[contact]]\nnode = "p"\nbeam = "a"\nside = "right"\n'
ROLLER = '[[support]]\nbeam = "a"\nend = "end"\nkind = "roller"\nfree = "x"\n'
USES = {
    "turn": HEAD + BEAM + "turn = -1.0\n" + PIN,
    "taper": HEAD + BEAM.replace("0.01", "[0.01, 0.005]") + PIN,
    "density": HEAD + "gravity = [0.0, -9.81]\n" + BEAM + "density = 2700.0\n" + PIN,
    "force_per_length": HEAD + BEAM + PIN + '[[load]]\nbeam = "a"\nforce_per_length = [0.0, 1.0]\n',
    "at": HEAD + BEAM + PIN + '[[load]]\nbeam = "a"\nat = 0.5\nforce = [0.0, 1.0]\n',
    "hinge": HEAD + BEAM + ROLLER + PIN + '[[hinge]]\nbeam = "a"\nend = "start"\nstiffness = 2.0\n',
    "spring": HEAD + BEAM + PIN + '[[spring]]\nbeam = "a"\nend = "end"\nstiffness = [0.0, 3.0]\n',
    "stage": HEAD
    + BEAM
    + PIN
    + '[[stage]]\nload_parameters = 3\npin = [{ name = "p", displacement = [0.0, -0.3] }]\n',
}


@pytest.mark.parametrize("key", SPECIAL)
def test_every_model_states_a_key_or_refuses_it_in_one_line(key: str) -> None:
    scene = read_scene(USES[key], "s")
    assert list(special_keys(scene)) == [key]
    for model in MODELS.values():
        if key in model.keys:
            continue
        reason = model.refusal(scene)
        assert reason is not None
        assert SPECIAL[key] in reason
        with pytest.raises(ModelError, match="does not state"):
            solve(scene, model.name)
    if key not in PROGRAMS:
        with pytest.raises(ModelError, match="does not state"):
            request(scene, Options(), scene.times)


@pytest.mark.parametrize("key", SPECIAL)
def test_a_scene_with_a_special_key_is_written_and_read(key: str) -> None:
    scene = read_scene(USES[key], "s")
    again = read_scene(to_toml(scene), "copy")
    assert again == scene
    assert again.pins[0].points == scene.pins[0].points


@pytest.mark.parametrize("turn", [1e-9, -0.3, 2.0, -5.0])
def test_an_arc_has_its_length_and_its_distance(turn: float) -> None:
    beam = read_scene(
        USES["turn"].replace("turn = -1.0", f"turn = {turn}").replace("-0.1]", "-9.0]"), "s"
    ).beams[0]
    parts = np.linspace(0.0, 1.0, 20001)
    points = np.array([beam.place(part) for part in parts])
    ways = np.diff(points, axis=0)
    assert np.hypot(*ways.T).sum() == pytest.approx(beam.length, rel=1e-8)
    tangents = np.array([beam.tangent(part) for part in (parts[1:] + parts[:-1]) / 2.0])
    assert ways / np.hypot(*ways.T)[:, None] == pytest.approx(tangents, abs=1e-9)
    assert points[[0, -1]] == pytest.approx(np.array([beam.start, beam.end]), abs=1e-15)
    (x, y), (tx, ty) = beam.place(0.3), beam.tangent(0.3)
    gap, fraction = signed_gap(beam, "left", 0.01, (x - 0.03 * ty, y + 0.03 * tx))
    assert (gap, fraction) == pytest.approx((0.02, 0.3), abs=1e-12)


def test_a_taper_has_the_stiffness_of_its_section() -> None:
    beam = read_scene(USES["taper"], "s").beams[0]
    heights = [0.01, 0.00875, 0.005]
    for part, height in zip((0.0, 0.25, 1.0), heights, strict=True):
        assert beam.height_at(part) == pytest.approx(height, rel=1e-15)
        assert beam.stiffness(part)[2] == pytest.approx(7e10 * 0.02 * height**3 / 12.0, rel=1e-14)
    assert beam.rectangle_height == 0.01


STAGED = USES["stage"].replace("4\n[[", '4\n[[').replace(
    'pin = [{ name = "p", displacement = [0.0, -0.3] }]',
    'pin = [{ name = "p", path = [[0.5, 0.2], [0.5, -0.2]] }]\nload = [{ beam = "a", end = "end", force = [0.0, 2.0] }]\n'
    'support = [{ beam = "a", end = "start", rotation = 0.1 }]\n'
    '[[stage]]\nname = "third"\nload_parameters = 1\nload = [{ beam = "a", end = "end", force = [1.0, -3.0] }]',
)  # fmt: skip


def test_stages_go_on_from_where_the_last_one_ended() -> None:
    scene = read_scene(STAGED, "s")
    assert scene.times == pytest.approx([0.25, 0.5, 0.75, 1.0, 4 / 3, 5 / 3, 2.0, 3.0])
    (pin,) = scene.pins
    assert pin.corners == pytest.approx((1.0, 1.0 + 0.2 / 0.6, 2.0))
    places = [pin.position(t) for t in (0.0, 0.5, 1.0, 1.0 + 0.2 / 0.6, 1.5, 2.0, 2.7, 3.0)]
    expected = [
        (0.7, -0.1),
        (0.7, 0.05),
        (0.7, 0.2),
        (0.5, 0.2),
        (0.5, 0.1),
        (0.5, -0.2),
        (0.5, -0.2),
        (0.5, -0.2),
    ]
    assert np.array(places) == pytest.approx(np.array(expected))
    assert pin.points == ((0.7, -0.1), (0.7, pytest.approx(0.2)), (0.5, 0.2), (0.5, -0.2))
    (motion,) = scene.prescribed_motions.values()
    assert motion.moves
    assert [motion.at(t)[2] for t in (0.5, 1.0, 1.5, 2.0, 2.5)] == pytest.approx([0.0, 0.0, 0.05, 0.1, 0.1])
    (history,) = scene.load_histories
    assert [history.at(t)[:2] for t in (1.0, 1.5, 2.0, 2.5, 3.0)] == [
        pytest.approx(force) for force in ((0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (0.5, 0.5), (1.0, -1.0))
    ]


FRAME = (
    HEAD
    + """
[[beam]]
name = "a"
start = [0.0, 0.0]
end = [0.0, 1.0]
area = 1.0
second_moment = 1.0
youngs_modulus = 1.0
poissons_ratio = 0.3
[[beam]]
name = "b"
start = [0.0, 1.0]
end = [1.0, 1.0]
area = 1.0
second_moment = 1.0
youngs_modulus = 1.0
poissons_ratio = 0.3
[[beam]]
name = "c"
start = [1.0, 1.0]
end = [1.0, 0.0]
area = 1.0
second_moment = 1.0
youngs_modulus = 1.0
poissons_ratio = 0.3
[[support]]
beam = "a"
end = "start"
kind = "pinned"
[[support]]
beam = "c"
end = "end"
kind = "pinned"
[[load]]
beam = "a"
end = "end"
force = [1.0, 0.0]
"""
)


def hinged(*ends: str) -> str:
    return FRAME + "".join(f'[[hinge]]\nbeam = "{end[0]}"\nend = "{end[2:]}"\n' for end in ends)


@pytest.mark.parametrize("ends", [(), ("a.end",), ("b.end",)])
def test_a_frame_of_three_hinges_stands(ends: tuple[str, ...]) -> None:
    assert read_scene(hinged(*ends), "s").hinges == () or ends


def test_a_spring_holds_a_mechanism() -> None:
    spring = '[[spring]]\nbeam = "b"\nend = "end"\nstiffness = [1.0, 0.0]\n'
    scene = read_scene(hinged("a.end", "b.end") + spring, "s")
    assert isinstance(scene, Scene)
    assert math.isclose(scene.springs[0].stiffness[0], 1.0)
