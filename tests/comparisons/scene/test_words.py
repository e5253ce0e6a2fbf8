"""Words that are no keys are answered by the key that is meant, where it belongs, or what is not modelled."""

from dataclasses import fields

import pytest

from comparisons.cases.settings import OWN
from comparisons.cases.study import RUN_KEYS
from comparisons.scene import SceneError, read_scene
from comparisons.scene.read import LISTS, STAGE_LISTS
from comparisons.scene.words import CONVERTED, ELSEWHERE, NOT_MODELLED, OTHER_NAMES, hint
from docs.extensions.messages import SCENES

RECORDS = {**LISTS, **{f"stage.{name}": kind for name, kind in STAGE_LISTS.items()}}
TABLES = {
    "": {"scene", *LISTS},
    "scene": OWN,
    "run": set(RUN_KEYS),
    **{name: {item.name for item in fields(kind)} for name, kind in RECORDS.items()},
}
"""The keys of every table, of the file itself under the empty name."""
KEYS = set().union(*TABLES.values())
OTHERS = {name for names in OTHER_NAMES.values() for name in names.split()}


def test_nothing_that_is_modelled_is_said_not_to_be() -> None:
    words = [word for topic in NOT_MODELLED for word in topic.words.split()]
    assert len(set(words)) == len(words)
    assert not set(words) & KEYS
    assert not set(words) & {*ELSEWHERE, *OTHERS}


def test_other_names_lead_to_keys() -> None:
    assert set(OTHER_NAMES) <= KEYS
    for key, names in ((key, names.split()) for key, names in OTHER_NAMES.items()):
        assert len(set(names)) == len(names)
        assert key not in names
        found = [
            hint(name, known) for name in names for known in TABLES.values() if {name, key} & known == {key}
        ]
        assert any(f"did you mean {key}" in line for line in found), key
    assert set(CONVERTED) <= OTHERS
    assert hint("to", TABLES["load"]) == hint("from", TABLES["load"]) == "did you mean part?"


def test_what_belongs_elsewhere_is_known_there() -> None:
    for word, line in ELSEWHERE.items():
        assert any(word not in known and hint(word, known) == line for known in TABLES.values()), word
        tables = [part.partition("]")[0] for part in line.split("[")[1:] if part.rstrip("]")]
        assert all(table in TABLES for table in tables if table), line


@pytest.mark.parametrize(
    ("place", "key", "line"),
    [
        ("[scene]", "damping_ratio", "dynamics is not modelled"),
        ("[[beam]]", "mass", "dynamics is not modelled"),
        ("[[beam]]", "yield_stress", "plasticity, damage and fracture are not modelled"),
        ("[[beam]]", "yeld", "plasticity, damage and fracture are not modelled"),
        ("[[beam]]", "temperature", "temperature is not modelled"),
        ("[[beam]]", "Thermal-Expansion", "temperature is not modelled"),
        ("[[pin]]", "z", "a third dimension is not modelled"),
        ("[[contact]]", "mu_s", "adhesion, wear, lubrication and a static coefficient"),
        ("[[beam]]", "nu", "did you mean poissons_ratio?"),
        ("[[beam]]", "E", "did you mean youngs_modulus?"),
        ("[[beam]]", "radius", "did you mean turn, the angle of the arc in rad: the length over the radius?"),
        ("[[beam]]", "weight", "did you mean density, the mass per volume, with gravity in [scene]?"),
        ("[scene]", "steps", "did you mean load_parameters?"),
        ("[[contact]]", "mu", "did you mean friction?"),
        ("[[contact]]", "stiffness", "a spring is a table of its own, [[spring]]"),
        ("[[contact]]", "colour", "known are beam, friction, keep"),
    ],
)
def test_a_word_is_answered(place: str, key: str, line: str) -> None:
    text = SCENES["strip"].replace(f"{place}\n", f'{place}\n"{key}" = 1.0\n', 1)
    with pytest.raises(SceneError) as caught:
        read_scene(text, "my.toml")
    (only,) = str(caught.value).splitlines()
    assert f".{key} = 1.0: unknown key, {line}" in only


def test_another_name_gives_no_second_line() -> None:
    text = (
        SCENES["strip"].replace("youngs_modulus", "E").replace("poissons_ratio", "nu").replace("height", "h")
    )
    with pytest.raises(SceneError) as caught:
        read_scene(text, "my.toml")
    assert [mistake.key for mistake in caught.value.mistakes] == ["beam[0].h", "beam[0].E", "beam[0].nu"]
