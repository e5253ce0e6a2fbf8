"""Frames in scene files: supports, joints, loads, contacts that persist; what is read and what is refused."""

import pytest

from comparisons.scene import LoadSpec, SupportSpec, read_scene, to_toml
from comparisons.scene.joints import structures

SECTION = "area = 1.0\nsecond_moment = 1.0\nyoungs_modulus = 1.0\nshear_modulus = 1.0"


def beam(name: str, start: str, end: str, clamped: str = "[]") -> str:
    return f'[[beam]]\nname = "{name}"\nstart = {start}\nend = {end}\nclamped = {clamped}\n{SECTION}\n'


def support(node: str, *lines: str) -> str:
    name, end = node.split(".")
    return "\n".join(["[[support]]", f'beam = "{name}"', f'end = "{end}"', *lines, ""])


def load(node: str, *lines: str) -> str:
    return support(node, *lines).replace("support", "load")


HEAD = '[scene]\nname = "frame"\nload_parameters = 4\n'
COLUMN, GIRDER = beam("column", "[0, 0]", "[0, 2]"), beam("girder", "[0, 2]", "[3, 2]")
PINNED, CLAMPED = 'kind = "pinned"', 'kind = "clamped"'
FEET = support("column.start", PINNED) + support("girder.end", PINNED)
PUSH = load("girder.start", "force = [0.0, -1.0]")
FRAME = HEAD + COLUMN + GIRDER + FEET + PUSH


def test_a_frame_without_contact_is_a_scene_and_round_trips() -> None:
    scene = read_scene(FRAME, "my.toml")
    assert (scene.pins, scene.contacts) == ((), ())
    assert [spec.held for spec in scene.all_supports] == [("x", "y"), ("x", "y")]
    assert scene.loads == (LoadSpec(beam="girder", end="start", force=(0.0, -1.0)),)
    assert [[item.name for item in group] for group in structures(scene)] == [["column", "girder"]]
    copy = read_scene(to_toml(scene), "copy")
    assert copy == scene
    assert hash(copy) == hash(scene)


def test_every_key_of_support_load_and_contact_round_trips() -> None:
    scene = read_scene(
        HEAD
        + beam("a", "[0, 0]", "[1, 0]", '["start"]')
        + beam("b", "[0, -1]", "[1, -1]")
        + support("b.start", "fixed = ['rotation', 'x', 'y']", "displacement = [0.1, 0.2]", "rotation = -0.3")
        + support("b.end", 'kind = "roller"', 'free = "x"', "displacement = [0.0, 0.25]")
        + load("a.end", "force = [1.0, 2.0]", "moment = 3.0")
        + '[[contact]]\nnode = "a.end"\nbeam = "b"\nside = "left"\nkeep = true\n',
        "my.toml",
    )
    assert read_scene(to_toml(scene), "copy") == scene
    assert scene.contacts[0].keep
    assert [spec.motion for spec in scene.all_supports] == [
        (0.0, 0.0, 0.0), (0.1, 0.2, -0.3), (None, 0.25, None),
    ]  # fmt: skip
    assert [spec.node for spec in scene.supports_of("b")] == ["b.start", "b.end"]


@pytest.mark.parametrize(
    ("given", "motion"),
    [
        ({"kind": "clamped"}, (0.0, 0.0, 0.0)),
        ({"kind": "clamped", "rotation": 0.5}, (0.0, 0.0, 0.5)),
        ({"kind": "pinned", "displacement": (1, 2)}, (1.0, 2.0, None)),
        ({"kind": "roller", "free": "x"}, (None, 0.0, None)),
        ({"kind": "roller", "free": "y", "displacement": (1, 0)}, (1.0, None, None)),
        ({"fixed": ("rotation",)}, (None, None, 0.0)),
        ({"fixed": ("y", "rotation"), "displacement": (0, -1), "rotation": 2}, (None, -1.0, 2.0)),
    ],
)
def test_what_a_support_holds_and_moves(given: dict[str, object], motion: tuple[float | None, ...]) -> None:
    spec = SupportSpec(beam="b", end="end", **given)  # type: ignore[arg-type]
    assert spec.motion == motion
    assert spec.moves == any(motion)


@pytest.mark.parametrize(
    ("clamped", "extra", "tip"),
    [
        ('["start"]', "", "end"),
        ('["end"]', "", "start"),
        ('["start", "end"]', load("b.end", "moment = 1.0"), "end"),
        ('["end"]', support("b.start", PINNED, "displacement = [0.1, 0.0]"), "start"),
        ('["start"]', support("b.end", PINNED, "displacement = [0.1, 0.0]"), "end"),
    ],
)
def test_the_tip_is_the_less_held_end(clamped: str, extra: str, tip: str) -> None:
    text = HEAD + beam("b", "[0, 0]", "[1, 0]", clamped) + extra
    scene = read_scene(text if extra else text + load("b.start", "moment = 1.0"), "my.toml")
    assert scene.tip("b") == tip


def test_three_beams_meeting_one_after_the_other_are_one_structure() -> None:
    beams = beam("a", "[0, 0]", "[1, 0]") + beam("c", "[2, 0]", "[3, 0]") + beam("b", "[1, 0]", "[2, 0]")
    held = support("c.end", CLAMPED) + load("a.start", "moment = 1.0")
    scene = read_scene(HEAD + beams + held, "my.toml")
    assert [sorted(item.name for item in group) for group in structures(scene)] == [["a", "b", "c"]]
