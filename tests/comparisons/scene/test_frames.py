"""Frames in scene files: supports, joints, loads, contacts that persist; what is read and what is refused."""

from dataclasses import replace

import pytest

from comparisons.scene import LoadSpec, SceneError, SupportSpec, load_scene, read_scene, to_toml
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


def refused(text: str) -> str:
    with pytest.raises(SceneError) as caught:
        read_scene(text, "my.toml")
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    return line.removeprefix("my.toml: ")


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


BAD = {
    "support of no beam": (FEET, support("clumn.start", PINNED), 'support[0].beam = "clumn": must name a beam: "column", "girder"'),
    "load of no beam": (PUSH, load("girdr.start", "moment = 1.0"), 'load[0].beam = "girdr": must name a beam: "column", "girder"'),
    "unknown end": ('end = "end"', 'end = "middle"', 'support[1].end = "middle": must be one of "start", "end"'),
    "unknown kind": ('"pinned"', '"pined"', 'support[0].kind = "pined": must be one of "clamped", "pinned", "roller"'),
    "neither kind nor fixed": (PINNED, "", "support[0].kind = (missing): give kind or fixed"),
    "kind and fixed": (PINNED, PINNED + '\nfixed = ["x"]', 'support[0].fixed = ["x"]: give either kind or fixed, not both'),
    "fixed twice": (PINNED, 'fixed = ["x", "x"]', 'support[0].fixed = ["x", "x"]: must be a list of some of "x", "y", "rotation", each once'),
    "fixed nothing": (PINNED, "fixed = []", "support[0].fixed = []: must be a list of some of"),
    "fixed list in list": (PINNED, 'fixed = [["x"]]', 'support[0].fixed = [["x"]]: must be a list of some of'),
    "roller without direction": (PINNED, 'kind = "roller"', 'support[0].free = (missing): must be given, a roller is free in "x" or in "y"'),
    "direction without roller": (PINNED, PINNED + '\nfree = "x"', 'support[0].free = "x": belongs to kind = "roller"'),
    "moved freely": (PINNED, 'kind = "roller"\nfree = "x"\ndisplacement = [0.1, 0.0]', "support[0].displacement = [0.1, 0.0]: must be zero in x, which is free"),
    "turned freely": (PINNED, PINNED + "\nrotation = 0.0", "support[0].rotation = 0.0: must not be given, the rotation is free"),
    "nan displacement": (PINNED, PINNED + "\ndisplacement = [nan, 0.0]", "support[0].displacement = [nan, 0.0]: must be a finite number"),
    "unknown key": (PINNED, PINNED + "\nstiffness = 1.0", "support[0].stiffness = 1.0: unknown key"),
    "zero load": ("force = [0.0, -1.0]", "force = [0.0, 0.0]", "load[0].force = [0.0, 0.0]: force or moment must not be zero"),
    "infinite moment": ("force = [0.0, -1.0]", "moment = inf", "load[0].moment = inf: must be a finite number"),
    "load twice": (PUSH, PUSH + PUSH, 'load[1].end = "girder.start": must not appear twice'),
    "support twice": (FEET, FEET + support("girder.end", CLAMPED), 'support[2].end = "girder.end": must not be supported twice, "girder.end" is there'),
    "joint supported by both": (FEET, FEET + support("column.end", CLAMPED) + support("girder.start", CLAMPED), 'support[3].end = "girder.start": must not be supported twice, "column.end" is there'),
    "clamp and support": (FEET, FEET.replace("girder.end", "girder.end") + support("column.start", CLAMPED), 'support[2].end = "column.start": must not be supported twice'),
    "nothing held": (FEET, "", 'beam[0].clamped = []: beam "column" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'),
    "one hinge": (support("girder.end", PINNED), "", 'beam[0].clamped = []: beam "column" can move without strain'),
    "only x held": (FEET, support("column.start", 'kind = "roller"', 'free = "y"'), 'beam "column" can move without strain'),
    "two rollers and no x": (PINNED, 'kind = "roller"\nfree = "x"', 'beam "column" can move without strain'),
    "a second beam free": (PUSH, PUSH + beam("lost", "[9, 9]", "[10, 9]"), 'beam[2].clamped = []: beam "lost" is free'),
    "nearly joined": ("start = [0, 2]", "start = [0, 2.0000001]", 'beam[1].start = [0.0, 2.0000001]: must be "column.end" exactly, or stay clear of it'),
    "beam on beam": (PUSH, PUSH + beam("twin", "[0, 2]", "[0, 0]"), 'beam[2].end = [0.0, 0.0]: must not lie on beam[0], "column", end to end'),
    "nothing happens": (PUSH, "", "pin = (missing): give a load, or a pin or a support that moves: nothing happens"),
    "idle pin": (PUSH, PUSH + '[[pin]]\nname = "p"\npath = [[9, 9], [9, 8]]\n', 'pin[0].name = "p": must be the node of a contact'),
    "touching what it is joined to": (PUSH, PUSH + '[[contact]]\nnode = "column.end"\nbeam = "girder"\nside = "left"\n', 'contact[0].node = "column.end": must not be joined to beam "girder"'),
    "keep as text": (PUSH, PUSH + '[[contact]]\nnode = "column.start"\nbeam = "girder"\nside = "right"\nkeep = "yes"\n', 'contact[0].keep = "yes": must be true or false'),
    "loads as a table": ("[[load]]", "[load]", "must be a list of tables, [[load]]"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_a_bad_frame_is_refused_in_one_line(case: str) -> None:
    old, new, sentence = BAD[case]
    assert old in FRAME
    count = -1 if case == "two rollers and no x" else 1
    assert sentence in refused(FRAME.replace(old, new, count))


def test_a_beam_that_only_a_contact_stops_needs_a_support_all_the_same() -> None:
    ks = load_scene("ks-cantilever")
    hinged = replace(
        ks,
        beams=(replace(ks.beams[0], clamped=()),),
        supports=(SupportSpec(beam="cantilever", end="start", kind="pinned"),),
    )
    assert hinged.all_supports[0].held == ("x", "y")
    with pytest.raises(ValueError, match='beam "cantilever" is free'):
        replace(hinged, supports=())


def test_three_beams_meeting_one_after_the_other_are_one_structure() -> None:
    beams = beam("a", "[0, 0]", "[1, 0]") + beam("c", "[2, 0]", "[3, 0]") + beam("b", "[1, 0]", "[2, 0]")
    held = support("c.end", CLAMPED) + load("a.start", "moment = 1.0")
    scene = read_scene(HEAD + beams + held, "my.toml")
    assert [sorted(item.name for item in group) for group in structures(scene)] == [["a", "b", "c"]]
