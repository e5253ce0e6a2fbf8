"""All mistakes of a file at once: each in one line, in the order of the file, and none that follows from another."""

import re
from itertools import combinations
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.scene import BeamSpec, FieldError, InputError, built_in_scenes, read_scene

# the registry of words that are no keys: that each leads to a key is the contract
from comparisons.scene.words import CONVERTED, ELSEWHERE, NOT_MODELLED, OTHER_NAMES, hint
from docs.extensions.messages import SCENES, Message, messages
from tests.comparisons.scene.test_special_keys import KEYS

TWELVE = Path(__file__).with_name("twelve.toml").read_text(encoding="utf-8")


def lines(text: str) -> list[str]:
    try:
        read_scene(text, "my.toml")
    except InputError as error:
        return [line.removeprefix("my.toml: ") for line in str(error).splitlines()]
    return []


def keys(text: str) -> list[str]:
    return [line.partition(" = ")[0] for line in lines(text)]


def test_twelve_mistakes_are_twelve_lines_of_one_run(tmp_path, capsys):
    path = tmp_path / "my.toml"
    path.write_text(TWELVE)
    assert main(["check", str(path)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == [
        f"crossval: {path}: {line}" for line in re.findall("^#> (.*)$", TWELVE, re.MULTILINE)
    ]
    assert list(tmp_path.iterdir()) == [path]


def test_the_order_is_that_of_the_file():
    """Tables of one kind may stand apart or inline, and texts may look like headers."""
    beam, pin, rest = re.split(r"(?=\[\[pin\]\]|\[\[contact\]\])", SCENES["strip"])
    wrong = beam.replace("height = 0.01", 'height = -1 # "[[beam]]\n# name = """[[pin]]"""')
    second = beam.partition("[[beam]]")[2].replace('"strip"', '"second"').replace("0.02", "-2")
    text = (
        wrong
        + pin.replace("[0.0, 0.1]", "'''\n[[beam]]\n'''")
        + f"[[beam]]{second.replace('0.0]', '0.9]')}"
        + rest.replace('"right"', "0")
    )
    assert keys(text) == ["beam[0].height", "beam[1].width", "pin[0].displacement", "contact[0].side"]
    assert keys("") == ["scene", "beam"]
    assert keys("pin = [{ name = 1 }]\nscene = { load_parameters = 0 }\nbeam = [{}]") == [
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


@pytest.mark.slow_at("1")
@pytest.mark.parametrize("every", [5, 1])
def test_of_two_mistakes_each_gives_its_line_and_nothing_follows(every):
    """All pairs of messages, or each fifth. A mistake in a value hides only rules that read the value."""
    found = [
        message
        for message in messages()
        if message.python is None and message.arguments is None and message.encoding == "utf-8"
        if "TOML" not in message.sentence and "must be a table" not in message.sentence
        if "list of tables" not in message.sentence
    ]
    pairs = whole = 0
    for one, other in list(combinations(found, 2))[::every]:
        text = both(one, other) if one.base == other.base else None
        if text is None:
            continue
        pairs += 1
        given = {f"my.toml: {line}" for line in lines(text)}
        expected = {one.example, other.example}
        whole += given == expected
        if given - expected:
            assert {one.sentence, other.sentence} in FOLLOWING, given - expected
    assert pairs > 600 / every
    assert whole > 0.9 * pairs


FREE = 'beam "{}" is free: clamp it, give it a [[support]] or a [[spring]] or join it to a beam that has one'
TWICE = 'must not be supported twice, "{}" is there'
FOLLOWING = (
    {"must not be given where the section tapers", "must lie {} ({}), gap {}"},
    {"must name a {}: {}", "must not be an end of the beam itself"},
    {"must name a pin or a beam's end: {}", "must be the node of a contact"},
    {"must name a {}: {}", "must be the node of a contact"},
    {'must not be joined to beam "{}"', 'must be "{}" exactly, or stay clear of it'},
    {TWICE, "must not make a mechanism: the beams can move without strain"},
    {"needs gravity in [scene]", "must not be zero in every stage"},
    {FREE, "displacement or rotation must not be zero"},
    {FREE, "must name an end with a support: {}"},
)
"""Pairs whose changes make another mistake together: another gap, another name in a list, a support less."""


def test_a_record_states_all_its_mistakes():
    with pytest.raises(FieldError) as caught:
        BeamSpec(name="b c", start=(0, 0), end=(0, 0), youngs_modulus=-1, width=1)
    assert [mistake.key for mistake in caught.value.mistakes] == [
        "name", "youngs_modulus", "poissons_ratio", "height", "end"
    ]  # fmt: skip
    assert str(caught.value).splitlines() == [str(mistake) for mistake in caught.value.mistakes]


KS = built_in_scenes()["ks-cantilever"]
DEEP = "must be valid TOML: a key has more than 50 parts"
EXTREME = {
    "a." * 20_000 + "a = 1": DEEP,
    "[" + "'b' . " * 20_000 + "a]": DEEP,
    "x = " + "[" * 20_000 + "]" * 20_000: "must be valid TOML: ",
    "a." * 49 + "a = 1": "beam[0].a = {a = ",
    "# " + "." * 100_000: "",
    "a" * 300_000: "must be valid TOML: ",
    '"a"' * 50_000: "must be valid TOML: ",
}
"""Lines in a table that nothing may read for long."""


@pytest.mark.parametrize("line", EXTREME, ids=range(len(EXTREME)))
def test_an_extreme_line_is_refused(line):
    found, said = lines(KS.replace("[[pin]]", f"{line}\n[[pin]]")), EXTREME[line]
    assert len(found) == bool(said)
    assert all(said in one for one in found)


TABLES = {table: {key for there, key in KEYS if there == table} for table, _ in KEYS}
OTHERS = {name for names in OTHER_NAMES.values() for name in names}


def test_words_that_are_no_keys_lead_to_keys_or_to_what_is_not_modelled():
    words, keys = [word for topic in NOT_MODELLED for word in topic.words], {key for _, key in KEYS}
    assert len(set(words)) == len(words)
    assert not set(words) & {*keys, *ELSEWHERE, *OTHERS}
    assert set(OTHER_NAMES) <= keys
    for key, names in OTHER_NAMES.items():
        assert len(set(names)) == len(names)
        assert key not in names
        found = [
            hint(name, there) for name in names for there in TABLES.values() if {name, key} & there == {key}
        ]
        assert any(f"did you mean {key}" in line for line in found), key
    assert set(CONVERTED) <= OTHERS
    assert hint("to", TABLES["load"]) == hint("from", TABLES["load"]) == "did you mean part?"
    for word, line in ELSEWHERE.items():
        assert any(word not in there and hint(word, there) == line for there in TABLES.values()), word
        tables = [part.partition("]")[0] for part in line.split("[")[1:] if part.rstrip("]")]
        assert all(table in TABLES for table in tables if table), line


def test_another_name_gives_no_second_line():
    text = (
        SCENES["strip"].replace("youngs_modulus", "E").replace("poissons_ratio", "nu").replace("height", "h")
    )
    assert keys(text) == ["beam[0].h", "beam[0].E", "beam[0].nu"]
