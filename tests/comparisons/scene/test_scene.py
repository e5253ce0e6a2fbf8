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


BAD = {
    "negative height": (("height = 0.02", "height = -0.02"), "beam[0].height = -0.02: must be positive"),
    "zero width": (("width = 0.02", "width = 0"), "beam[0].width = 0: must be positive"),
    "negative stiffness": (("2.1e4", "-2.1e4"), "beam[0].youngs_modulus = -21000.0: must be positive"),
    "nan": (("2.1e4", "nan"), "beam[0].youngs_modulus = nan: must be a finite number"),
    "inf": (("2.1e4", "-inf"), "beam[0].youngs_modulus = -inf: must be a finite number"),
    "huge integer": (("2.1e4", "1" + 400 * "0"), "must be a finite number"),
    "nan in a point": (("end = [1.0, 0.0]", "end = [1.0, nan]"), "beam[0].end = [1.0, nan]: must be a finite number"),
    "bool as number": (("height = 0.02", "height = true"), "beam[0].height = true: must be a number"),
    "bool as count": (("load_parameters = 50", "load_parameters = true"), "scene.load_parameters = true: must be a whole number"),
    "text as number": (("height = 0.02", 'height = "0.02"'), 'beam[0].height = "0.02": must be a number'),
    "float as count": (("elements = 20", "elements = 20.0"), "beam[0].elements = 20.0: must be a whole number"),
    "no elements": (("elements = 20", "elements = 0"), "beam[0].elements = 0: must lie between 1 and 100000"),
    "no load parameters": (("load_parameters = 50", "load_parameters = 0"), "scene.load_parameters = 0: must lie between"),
    "nodes that fall": (("elements = 20", "nodes = [0.5, 0.2]"), "beam[0].nodes = [0.5, 0.2]: must rise between 0 and 1"),
    "three coordinates": (("end = [1.0, 0.0]", "end = [1.0, 0.0, 0.0]"), "beam[0].end = [1.0, 0.0, 0.0]: must be two numbers"),
    "zero length": (("end = [1.0, 0.0]", "end = [0.0, 0.0]"), "beam[0].end = [0.0, 0.0]: must differ from start"),
    "nu": (("poissons_ratio = 0.3", "poissons_ratio = 0.5"), "beam[0].poissons_ratio = 0.5: must lie between -1 and 0.5"),
    "nu and G": (("poissons_ratio = 0.3", "poissons_ratio = 0.3\nshear_modulus = 1.0"), "beam[0].shear_modulus = 1.0: give either poissons_ratio or shear_modulus, not both"),
    "neither nu nor G": (("poissons_ratio = 0.3", ""), "beam[0].poissons_ratio = (missing): give poissons_ratio or shear_modulus"),
    "two sections": (("height = 0.02", "height = 0.02\narea = 1.0"), "beam[0].area = 1.0: give either width and height or area and second_moment, not both"),
    "half a section": (("height = 0.02", ""), "beam[0].height = (missing): must be given"),
    "no section": (("width = 0.02\nheight = 0.02", ""), "beam[0].width = (missing): give width and height or area and second_moment"),
    "unknown key": (("height = 0.02", "hieght = 0.02"), "beam[0].hieght = 0.02: unknown key, did you mean height?"),
    "unknown table": (("[[contact]]", "[[contcat]]"), "unknown key, did you mean contact?"),
    "missing key": (('side = "right"', ""), "contact[0].side = (missing): must be given"),
    "missing scene key": (('name = "ks-cantilever"', ""), "scene.name = (missing): must be given"),
    "pin as a table": (("[[pin]]", "[pin]"), "must be a list of tables, [[pin]]"),
    "side": (('side = "right"', 'side = "below"'), 'contact[0].side = "below": must be one of "right", "left"'),
    "unhashable choice": (('side = "right"', "side = []"), 'contact[0].side = []: must be one of "right", "left"'),
    "clamp twice": (('clamped = ["start"]', 'clamped = ["start", "start"]'), "beam[0].clamped = "),
    "no clamp": (('clamped = ["start"]', "clamped = []"), 'beam[0].clamped = []: beam "cantilever" is free: clamp it'),
    "unknown beam": (('beam = "cantilever"', 'beam = "lower"'), 'contact[0].beam = "lower": must name a beam: "cantilever"'),
    "unknown pin": (('node = "pin"', 'node = "nip"'), 'contact[0].node = "nip": must name a pin or a beam\'s end: "pin", "cantilever.start"'),
    "own end": (('node = "pin"', 'node = "cantilever.end"'), "must not be an end of the beam itself"),
    "still pin": (("displacement = [-1.0, 0.6366197723675814]", "displacement = [0.0, 0.0]"), "pin[0].displacement = [0.0, 0.0]: give a load, or a pin or a support that moves: nothing happens"),
    "pin without way": (("displacement = [-1.0, 0.6366197723675814]", ""), "pin[0].displacement = (missing)"),
    "pin with two ways": ((START, "path = [[1.0, 0.0], [1.0, 1.0]]\n" + START), "pin[0].path = [[1.0, 0.0], [1.0, 1.0]]: give either start and displacement or path"),
    "wrong side": ((START, "start = [0.9, 0.01]\ndisplacement"), 'pin[0].start = [0.9, 0.01]: must lie on the right of beam "cantilever" (axis), gap -0.01'),
    "inside the face": (('surface = "axis"', 'surface = "face"'), 'pin[0].start = [1.0, 0.0]: must lie on the right of beam "cantilever" (face), gap -0.01'),
    "bad name": (('name = "pin"', 'name = "../pin"'), 'pin[0].name = "../pin": must consist of letters'),
    "new line in a name": (('name = "pin"', 'name = "a\\nb"'), "pin[0].name = "),
    "syntax": (("height = 0.02", "height = = 0.02"), "must be valid TOML"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_scene_is_refused_in_one_line(case: str) -> None:
    (old, new), sentence = BAD[case]
    assert sentence in refused(edited(old, new))


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


def test_face_needs_a_height() -> None:
    text = edited("width = 0.02\nheight = 0.02", "area = 5e-3\nsecond_moment = 1e-3").replace(
        '"axis"', '"face"'
    )
    assert refused(text) == 'contact[0].surface = "face": needs the height of beam "cantilever"'


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


def test_a_height_whose_third_power_overflows_is_refused() -> None:
    text = built_in_scenes()["ks-cantilever"].replace("height = 0.02", "height = 1e60")
    with pytest.raises(SceneError, match=re.escape("EI = 3.5e+181 must lie between 1e-100 and 1e+100")):
        read_scene(text, "high.toml")
