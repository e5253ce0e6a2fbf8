"""Scene files: what is read, what is refused, and in which words."""

import math
import re
from pathlib import Path

import pytest

from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    FieldError,
    PinSpec,
    Scene,
    SceneError,
    built_in_scenes,
    load_scene,
    read_scene,
    to_toml,
)

KS = built_in_scenes()["ks-cantilever"]
START = "start = [1.0, 0.0]\ndisplacement"


def without_comments(text: str) -> str:
    return re.sub(r" *#.*", "", text)


PLAIN = without_comments(KS)


def edited(old: str, new: str) -> str:
    assert PLAIN.count(old) == 1, old
    return PLAIN.replace(old, new)


def refused(text: str) -> str:
    with pytest.raises(SceneError) as caught:
        read_scene(text, "my.toml")
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    assert line.startswith("my.toml: ")
    return line.removeprefix("my.toml: ")


@pytest.mark.parametrize("name", sorted(built_in_scenes()))
def test_built_in_scene_is_hashable_and_round_trips(name: str) -> None:
    scene = load_scene(name)
    copy = read_scene(to_toml(scene), "copy")
    assert scene.name == name
    assert copy == scene
    assert hash(copy) == hash(scene)


def test_ks_stiffnesses_and_load_parameters() -> None:
    scene = load_scene("ks-cantilever")
    beam = scene.beams[0]
    stiffness = (beam.EA, beam.GA, beam.EI)
    assert stiffness == pytest.approx((8.4, 5 / 6 * 2.1e4 / 2.6 * 4e-4, 2.8e-4), rel=1e-15)
    assert len(scene.times) == 50
    assert scene.times[-1] == 1.0
    assert scene.times[24] == 0.5


def test_path_and_straight_pin_agree() -> None:
    scene = read_scene(
        edited(
            "start = [1.0, 0.0]\ndisplacement = [-1.0, 0.6366197723675814]",
            "path = [[1.0, 0.0], [0.0, 0.6366197723675814]]",
        ),
        "my.toml",
    )
    assert scene.pins[0].points == load_scene("ks-cantilever").pins[0].points
    assert read_scene(to_toml(scene), "copy") == scene


def test_position_runs_at_constant_speed_over_corners() -> None:
    pin = PinSpec(name="pin", path=((0.0, 0.0), (1.0, 0.0), (1.0, 3.0)))
    assert pin.position(0.125) == (0.5, 0.0)
    assert pin.position(0.25) == (1.0, 0.0)
    assert pin.position(0.5) == (1.0, 1.0)
    assert pin.position(1.0) == (1.0, 3.0)


def test_area_and_second_moment_have_shear_factor_one() -> None:
    area = edited("width = 0.02\nheight = 0.02", "area = 5e-3\nsecond_moment = 1e-3")
    plain = area.replace("poissons_ratio = 0.3", "shear_modulus = 7.5e10")
    given = plain.replace("area = 5e-3", "area = 5e-3\nshear_area = 1e-3")
    stiffness = [read_scene(text, "my.toml").beams[0].GA for text in (plain, given)]
    assert stiffness == pytest.approx([7.5e10 * 5e-3, 7.5e7])


def test_syntax_error_keeps_its_line() -> None:
    text = edited("height = 0.02", "height = = 0.02")
    line = next(i for i, content in enumerate(text.splitlines(), 1) if "= =" in content)
    assert f"line {line}" in refused(text)


def test_duplicate_names_and_pairs() -> None:
    assert (
        refused(edited('name = "pin"', 'name = "cantilever"'))
        == 'pin[0].name = "cantilever": must not appear twice'
    )
    pin = '[[pin]]\nname = "pin"\npath = [[1, 0], [1, 1]]\n'
    assert refused(PLAIN + pin) == 'pin[1].name = "pin": must not appear twice'
    contact = '[[contact]]\nnode = "pin"\nbeam = "cantilever"\nside = "right"\n'
    assert refused(PLAIN + contact) == 'contact[1].node = "pin->cantilever": must not appear twice'


@pytest.mark.parametrize("y", [math.nextafter(0.0, 1.0), -math.ulp(1.0), math.ulp(1.0), 0.0])
@pytest.mark.parametrize("x", [math.nextafter(1.0, 0.0), 1.0, math.nextafter(1.0, 2.0)])
def test_a_pin_on_the_axis_may_be_off_by_round_off(x: float, y: float) -> None:
    scene = read_scene(edited(START, f"start = [{x!r}, {y!r}]\ndisplacement"), "my.toml")
    assert scene.pins[0].points[0] == (x, y)


def test_a_pin_beyond_the_tip_has_no_side() -> None:
    assert read_scene(edited(START, "start = [1.1, 0.1]\ndisplacement"), "my.toml").pins[0].start == (
        1.1,
        0.1,
    )


@pytest.mark.parametrize("case", ["missing", "directory", "latin-1", "null", "empty"])
def test_unreadable_file(case: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    if case == "directory":
        path.mkdir()
    elif case == "latin-1":
        path.write_bytes(KS.encode() + b"# \xe9\n")
    elif case == "empty":
        path.write_text("")
    name = "no\0file" if case == "null" else str(path)
    with pytest.raises(SceneError) as caught:
        load_scene(name)
    lines = str(caught.value).splitlines()
    assert len(lines) == (2 if case == "empty" else 1)
    assert all(line.startswith(f"{name}: ") for line in lines)


def test_records_check_themselves() -> None:
    with pytest.raises(FieldError, match="must be positive"):
        BeamSpec(name="b", start=(0, 0), end=(1, 0), youngs_modulus=1, poissons_ratio=0, width=1, height=-1)
    beam = BeamSpec(name="b", start=(0, 0), end=(1, 0), youngs_modulus=1, poissons_ratio=0, width=1, height=1)
    pin = PinSpec(name="p", start=(1, 1), displacement=(0, -1))
    contact = ContactSpec(node="p", beam="b", side="right")
    with pytest.raises(ValueError, match=re.escape("pin[0].start = [1.0, 1.0]: must lie on the right")):
        Scene(name="s", load_parameters=1, beams=(beam,), pins=(pin,), contacts=(contact,))
