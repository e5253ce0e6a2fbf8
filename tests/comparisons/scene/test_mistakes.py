"""All mistakes of a file at once: each in one line, in the order of the file, and none that follows from another."""

import re
from itertools import combinations
from pathlib import Path
from time import monotonic

import pytest

from comparisons.cli import main
from comparisons.scene import BeamSpec, FieldError, SceneError, read_scene
from comparisons.scene.tables import LARGEST_FILE
from docs.extensions.messages import SCENES, Message, messages

TWELVE = """
[[contact]]
node = "pin"
beam = "strp"                 # 1: no such beam
side = "below"                # 2: no such side

[[pin]]
name = "pin"
start = [0.4, -0.1]
displacement = [0.0, 0.1, 0.0]   # 3: three numbers
radius = -0.05                # 4: negative

[[beam]]
name = "strip"
start = [0.0, 0.0]
end = [0.5, 0.0, 0.0]         # 5: three numbers
clamped = "start"             # 6: no list
width = 0.02                  # 12: no height
youngs_modulus = "7e10"       # 7: a text
poisons_ratio = 0.3           # 8: misspelt

[scene]
name = "all wrong"            # 9: a space
load_parameters = 20.0        # 10: no whole number

[[support]]
beam = "strip"
end = "end"
kind = "roller"               # 11: no direction
"""
LINES = [
    'contact[0].beam = "strp": must name a beam: "strip"',
    'contact[0].side = "below": must be one of "right", "left"',
    "pin[0].displacement = [0.0, 0.1, 0.0]: must be two numbers [x, y], a third dimension is not modelled",
    "pin[0].radius = -0.05: must be positive",
    "beam[0].end = [0.5, 0.0, 0.0]: must be two numbers [x, y], a third dimension is not modelled",
    'beam[0].clamped = "start": must be a list',
    'beam[0].youngs_modulus = "7e10": must be a number',
    "beam[0].poisons_ratio = 0.3: unknown key, did you mean poissons_ratio?",
    "beam[0].height = (missing): must be given, width and height belong together",
    "scene.name = \"all wrong\": must consist of letters, digits, '-' and '_'",
    "scene.load_parameters = 20.0: must be a whole number",
    'support[0].free = (missing): must be given, a roller is free in "x" or in "y"',
]


def lines(text: str) -> list[str]:
    try:
        read_scene(text, "my.toml")
    except SceneError as error:
        return [line.removeprefix("my.toml: ") for line in str(error).splitlines()]
    return []


def test_twelve_mistakes_are_twelve_lines_of_one_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "my.toml"
    path.write_text(TWELVE)
    assert main(["check", str(path)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == [f"crossval: {path}: {line}" for line in LINES]
    assert list(tmp_path.iterdir()) == [path]


def test_the_order_is_that_of_the_file() -> None:
    """Tables of one kind may stand apart, and texts and comments may look like headers."""
    beam, pin, rest = re.split(r"(?=\[\[pin\]\]|\[\[contact\]\])", SCENES["strip"])
    wrong = beam.replace(
        "height = 0.01", 'height = -1 # "[[beam]]\nname = """[[pin]]"""'.replace("\nname", "\n# name")
    )
    second = (
        wrong.partition("[[beam]]")[2]
        .replace('"strip"', '"second"')
        .replace("0.02", "-2")
        .replace("-1", "0.01")
        .replace("0.0]", "0.9]")
    )
    text = (
        wrong
        + pin.replace("[0.0, 0.1]", "'''\n[[beam]]\n'''")
        + f"[[beam]]{second}"
        + rest.replace('"right"', "0")
    )
    assert [line.partition(" = ")[0] for line in lines(text)] == [
        "beam[0].height", "pin[0].displacement", "beam[1].width", "contact[0].side"
    ]  # fmt: skip


def test_inline_tables_stand_in_the_order_of_the_file() -> None:
    text = "pin = [{ name = 1 }]\nscene = { load_parameters = 0 }\nbeam = [{}]"
    assert [line.partition(" = ")[0] for line in lines(text)] == [
        *("pin[0].name", "pin[0].start", "scene.load_parameters", "scene.name"),
        *("beam[0].name", "beam[0].start", "beam[0].end", "beam[0].youngs_modulus"),
        *("beam[0].poissons_ratio", "beam[0].width"),
    ]  # fmt: skip


def both(one: Message, other: Message) -> str | None:
    """Return the scene with both changes, None where they change the same text or add tables of one kind."""
    added = [set(re.findall(r"^\[\[\w+", message.append, re.MULTILINE)) for message in (one, other)]
    if added[0] & added[1]:
        return None
    text = good = SCENES[one.base]
    places = sorted((good.index(old), len(old)) for old, _ in (one.change, other.change) if old)
    if len(places) == 2 and sum(places[0]) > places[1][0]:
        return None
    for old, new in (one.change, other.change):
        if text.count(old) != 1 and old:
            return None
        text = text.replace(old, new) if old else text
    return text + one.append + other.append


def test_of_two_mistakes_each_gives_its_line_and_nothing_follows() -> None:
    """All pairs of messages. A mistake in a value hides only rules that read the value."""
    found = [
        message
        for message in messages()
        if message.python is None and message.arguments is None and message.encoding == "utf-8"
        if "TOML" not in message.sentence and "must be a table" not in message.sentence
        if "list of tables" not in message.sentence
    ]
    pairs = whole = 0
    for one, other in combinations(found, 2):
        text = both(one, other) if one.base == other.base else None
        if text is None:
            continue
        pairs += 1
        given = {f"my.toml: {line}" for line in lines(text)}
        expected = {one.example, other.example}
        whole += given == expected
        if given - expected:
            assert {one.sentence, other.sentence} in FOLLOWING, given - expected
    assert pairs > 600
    assert whole > 0.9 * pairs


FREE = 'beam "{}" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'
FOLLOWING = (
    {"must not be given where the section tapers", "must lie {} ({}), gap {}"},
    {"must name a beam: {}", "must not be an end of the beam itself"},
    {"must name a pin or a beam's end: {}", "must be the node of a contact"},
    {"must name a pin: {}", "must be the node of a contact"},
    {'must not be joined to beam "{}"', 'must be "{}" exactly, or stay clear of it'},
    {
        'must not be supported twice, "{}" is there',
        "must not make a mechanism: the beams can move without strain",
    },
    {"needs gravity in [scene]", "must not be zero in every stage"},
    {FREE, "displacement or rotation must not be zero"},
    {FREE, "must name an end with a support: {}"},
)
"""Pairs whose changes make another mistake together: another gap, another name in a list, a support less."""


def test_a_record_states_all_its_mistakes() -> None:
    with pytest.raises(FieldError) as caught:
        BeamSpec(name="b c", start=(0, 0), end=(0, 0), youngs_modulus=-1, width=1)
    assert [mistake.key for mistake in caught.value.mistakes] == [
        "name", "youngs_modulus", "poissons_ratio", "height", "end"
    ]  # fmt: skip
    assert str(caught.value).splitlines() == [str(mistake) for mistake in caught.value.mistakes]


@pytest.mark.parametrize(
    "text",
    [
        "".join(f"a{i} = 1\n" for i in range(10**5)),
        "[[beam]]\nx = 1\n" * 10**4,
        "[[beam]]\nname = 'a'\nstart = [0, 0]\nend = [1, 0]\nx = 1\n" * 10**4,
    ],
    ids=["keys", "tables", "names"],
)
def test_many_mistakes_take_no_time(text: str) -> None:
    assert len(text) < LARGEST_FILE
    began = monotonic()
    assert lines(text)
    assert monotonic() - began < 5
