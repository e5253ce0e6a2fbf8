"""The keys of a scene: each is written and read, and stated or refused by every model; what supports, joints and arcs make of them."""

import math
import re
import tomllib
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from comparisons.models import MODELS, find, solve
from comparisons.models.model import ModelError
from comparisons.scene import (
    SPECIAL,
    BeamSpec,
    ContactSpec,
    InputError,
    Scene,
    built_in_scenes,
    read_scene,
    rules,
    to_toml,
)

# where a key is declared, and what follows from it
from comparisons.scene.read import LISTS, json_schema
from comparisons.scene.record import optional
from docs.extensions.generated import scene_file

SCHEMA = json_schema()
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
"""A scene with each key of `SPECIAL`."""
WRITTEN = {**built_in_scenes(), **USES, "rest": Path(__file__).with_name("every_key.toml").read_text()}


@pytest.mark.parametrize("key", SPECIAL)
def test_every_model_states_a_key_or_refuses_it_in_one_line(key):
    scene = read_scene(USES[key], "s")
    for name in (*MODELS, "calculix", "exudyn", "felupe", "opensees"):
        model = find(name)
        assert model.keys <= SPECIAL.keys()
        reason = model.refusal(scene)
        if key in model.keys:
            assert "does not state" not in str(reason)
            continue
        assert reason is not None
        assert f"does not state {SPECIAL[key]}" in reason
        assert len(reason.splitlines()) == 1
        if name in MODELS:
            with pytest.raises(ModelError, match="does not state"):
                solve(scene, name)


@pytest.mark.parametrize("name", WRITTEN)
def test_a_scene_is_written_and_read(name):
    scene = read_scene(WRITTEN[name], "s")
    copy = read_scene(to_toml(scene), "copy")
    assert (copy, hash(copy)) == (scene, hash(scene))
    assert [pin.points for pin in copy.pins] == [pin.points for pin in scene.pins]
    assert scene.name == ("s" if name in USES else name)


def written(value: Any, table: str = "") -> Iterator[tuple[str, str]]:
    """Yield the tables of a file, as ``stage.pin``, with each of their keys; the file itself has the empty name."""
    for one in value if isinstance(value, list) else [value]:
        for key, inner in one.items() if isinstance(one, dict) else ():
            yield from ((table, key), *written(inner, f"{table}.{key}".lstrip(".")))


def listed(schema: dict[str, Any], table: str = "") -> Iterator[tuple[str, str]]:
    for key, rule in schema.get("items", schema).get("properties", {}).items():
        yield from ((table, key), *listed(rule, f"{table}.{key}".lstrip(".")))


KEYS = set(listed(SCHEMA))
"""Every key of a scene file, with its table."""


def test_every_key_of_the_schema_is_written_and_read_by_a_scene_above():
    texts = [to_toml(read_scene(text, "s")) for text in WRITTEN.values()]
    assert {key for text in texts for key in written(tomllib.loads(text))} == KEYS


class Worn(ContactSpec):
    """A contact that wears."""

    wear: float = optional(rules.fraction, "Share of the surface worn off.", 0.25)


def test_a_new_key_is_one_declaration(monkeypatch):
    """Its check, message, default, schema, line of the reference and way back to TOML follow."""
    monkeypatch.setitem(LISTS, "contact", Worn)
    monkeypatch.setattr(Scene.rules["contacts"], "kind", Worn)
    text = HEAD + BEAM + PIN
    assert [contact.wear for contact in read_scene(text, "s").contacts] == [0.25]
    scene = read_scene(text + "wear = 0.5\n", "s")
    assert read_scene(to_toml(scene), "copy") == scene
    assert "\nwear = 0.5" in to_toml(scene)
    for line, said in {
        "wear = 2": "contact[0].wear = 2: must be a number between 0 and 1",
        "waer = 0.5": "contact[0].waer = 0.5: unknown key, did you mean wear?",
    }.items():
        with pytest.raises(InputError, match=f"^s: {re.escape(said)}$"):
            read_scene(f"{text}{line}\n", "s")
    schema = json_schema()["properties"]["contact"]["items"]["properties"]["wear"]
    assert (schema["exclusiveMaximum"], schema["default"]) == (1, 0.25)
    assert "| `wear` | a number between 0 and 1 | `0.25` | Share of the surface worn off. |" in scene_file()


KS = built_in_scenes()["ks-cantilever"]
START = "start = [1.0, 0.0]\ndisplacement"


def test_a_pin_on_the_axis_may_be_off_by_round_off_and_one_beyond_the_tip_has_no_side():
    near = product((math.nextafter(1.0, 0.0), 1.0, math.nextafter(1.0, 2.0)), (5e-324, math.ulp(1.0), 0.0))
    assert KS.count(START) == 1
    for place in (*near, (1.1, 0.1)):
        scene = read_scene(KS.replace(START, f"start = {list(place)}\ndisplacement"), "s")
        assert scene.pins[0].points[0] == place


@pytest.mark.parametrize("turn", [1e-9, -5.0])
def test_a_pin_inside_an_arc_is_on_the_wrong_side_by_its_distance(turn):
    given = USES["turn"].replace("turn = -1.0", f"turn = {turn}")
    beam = BeamSpec(**tomllib.loads(given)["beam"][0])
    (x, y), (tx, ty) = beam.place(0.3), beam.tangent(0.3)
    inside = f"start = [{x - 0.03 * ty!r}, {y + 0.03 * tx!r}]"
    with pytest.raises(InputError, match=r'must lie on the right of beam "a" \(axis\), gap -0\.03$'):
        read_scene(given.replace("start = [0.7, -0.1]", inside), "s")
