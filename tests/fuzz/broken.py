"""Scene files that break something: keys, values, shapes, the syntax, or all of it at once."""

import copy
import math
import tomllib
from random import Random
from typing import Any

from hypothesis import strategies as st
from hypothesis.internal.conjecture import providers

from comparisons.scene import to_toml

# the tables of a file and their records
from comparisons.scene.read import LISTS
from tests.fuzz.special import drawn_special
from tests.fuzz.world import Tables, toml_text

# draws depend on the seed alone, not on the numbers that the imported modules hold
providers._get_local_constants = providers.Constants

MOST = 12
"""Largest number of load parameters, elements and cells that is run: more is a long solution, not a hang."""
LARGEST = 100_000
"""Largest such number that a scene may state."""


def small(seed: int) -> Tables:
    """The scene of a seed with every special key, with few elements, cells and load parameters, and options of the solid."""
    random, scene = Random(seed), tomllib.loads(to_toml(drawn_special(seed)))  # noqa: S311 - nothing is secret
    scene["scene"]["load_parameters"] = random.randint(1, 5)
    scene["scene"]["name"] = random.choice(("mine", "Balken-2", "\u6881"))
    for beam in scene["beam"]:
        beam.pop("nodes", None)
        beam |= {
            "elements": random.randint(1, 8),
            "mesh": [random.randint(2, 10), random.randint(1, 2)],
            "material": random.choice(("st-venant-kirchhoff", "biot-linear", "neo-hookean")),
            "solid_clamp": random.choice(("rod", "full")),
            "solid_element": random.choice(("Q2", "Q2", "Q2-full", "Q1")),
        }
    return scene


def one_of(*items: object) -> st.SearchStrategy[object]:
    return st.sampled_from(items)


valid_scenes = st.integers(0, 10**6).map(small)
numbers = st.one_of(
    one_of(0.0, -0.0, -1.0, 1e-320, 5e-324, 1e-160, 1e160, 1.7e308, -1.7e308, 1.0, 0.5, 1e-9, 1e9),
    one_of(1e155, -1e308, 1e308, 1e50, 1.1e50, -1e49, 1e-50, 0.9e-50, 1e-100, 1e100, 1e25, 1e-25),
    one_of(math.nan, math.inf, -math.inf),
    st.floats(allow_nan=True, allow_infinity=True),
    one_of(0, -1, 1, 2, 3, 100_001, 2**31, 2**63, 2**64, 10**30, 10**400, -(10**400)),
)
WORDS = ["start", "end", "pin", "beam", "a.end", "x", "..", "\U0001d6fc", "\u202e", "%s{}"]
texts = st.one_of(one_of(*WORDS, "", " ", "N, m", "a\nb", "\0"), st.text(max_size=12))
values = st.recursive(
    st.one_of(numbers, texts, st.booleans()),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(texts, inner, max_size=3)),
    max_leaves=6,
)
KEYS = sorted(
    {key for kind in LISTS.values() for key in kind.__annotations__} | {"units", "load_parameters", *LISTS}
)
"""Keys that are added where they may not stand."""


def _tables(scene: Tables) -> list[Tables]:
    inner = [item for value in scene.values() for item in (value if isinstance(value, list) else [value])]
    return [table for table in (scene, *inner) if isinstance(table, dict) and table]


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """A valid scene after one to three mutations of its keys and values."""
    scene = copy.deepcopy(draw(valid_scenes))
    for _ in range(draw(st.integers(1, 3))):
        if candidates := _tables(scene):
            _mutate(draw, draw(st.sampled_from(candidates)))
    return toml_text(scene)


def _number(draw: st.DrawFn, holder: Any, at: Any) -> None:
    """Put a number in the place of a value, or of one in its lists."""
    while isinstance(value := holder[at], list) and value:
        holder, at = value, draw(st.integers(0, len(value) - 1))
    holder[at] = draw(numbers)


def _mutate(draw: st.DrawFn, table: Tables) -> None:
    """Change one key of a table."""
    key = draw(st.sampled_from(list(table)))
    value = table[key]
    several = isinstance(value, list) and bool(value)
    tables = several and isinstance(value[0], dict)
    how = draw(one_of("value", "number", "delete", "misspell", "add", "length", "scale", "repeat", "wrap"))
    if how == "number" and not tables and not isinstance(value, dict):
        _number(draw, table, key)
    elif how == "scale" and isinstance(value, float):
        table[key] = value * 10.0 ** draw(st.integers(-300, 300))
    elif how == "length" and isinstance(value, list):
        table[key] = draw(one_of(value[:-1], value + value[:1], [], [value]))
    elif how == "repeat" and tables:
        table[key] = value + copy.deepcopy(value[-1:])
    elif how == "wrap":
        table[key] = draw(one_of([value], {key: value}, str(value)))
    elif how == "add":
        table[draw(st.one_of(one_of(*KEYS), texts))] = draw(values)
    elif how in ("delete", "misspell"):
        del table[key]
        if how == "misspell":
            at = draw(st.integers(0, max(len(key) - 1, 0)))
            table[key[:at] + draw(one_of("", "x", "_", "é", ".")) + key[at + 1 :] or "x"] = value
    else:
        table[key] = draw(values)


@st.composite
def deepened(draw: st.DrawFn) -> str:
    """A valid scene with a key, a header or a list far deeper than any parser recurses."""
    lines = toml_text(draw(valid_scenes)).splitlines()
    depth = draw(one_of(40, 60, 500, 20_000))
    keys = draw(one_of("a.", '"".', "'b' . ", "a-b .")) * depth
    nested = "x = " + "[" * depth + "]" * depth, "x = " + "{a = " * depth + "1" + "}" * depth
    lines.insert(draw(st.integers(0, len(lines))), draw(one_of(f"{keys}a = 1", f"[{keys}a]", *nested)))
    return "\n".join(lines) + "\n"


@st.composite
def garbled(draw: st.DrawFn) -> bytes:
    """The bytes of a valid scene after deletions, repetitions and insertions anywhere."""
    data = toml_text(draw(valid_scenes)).encode()
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(data)))
        size = draw(one_of(0, 1, 2, 10, 100))
        piece = draw(st.one_of(st.binary(max_size=6), st.just(data[at : at + size]), st.just(b"[" * 500)))
        data = data[:at] + piece + data[at + draw(one_of(0, size)) :]
    return data


wrong = st.one_of(mutated(), mutated(), mutated(), mutated(), deepened()).map(str.encode)
files = st.one_of(
    valid_scenes.map(lambda scene: toml_text(scene).encode()), wrong, garbled(), st.binary(max_size=200)
)


def is_small(data: bytes) -> bool:
    """Whether no count in the file asks for a long solution."""
    if any(line.count(b".") > 1000 for line in data.splitlines()):
        return True  # `crossval` refuses a key of so many parts, which tomllib reads for half a minute
    try:
        tables = tomllib.loads(data.decode())
    except (ValueError, RecursionError):
        return True
    counts = [table.get(key) for table in _tables(tables) for key in ("load_parameters", "elements", "mesh")]
    every = [number for count in counts for number in (count if isinstance(count, list) else [count])]
    return not any(isinstance(number, int) and MOST < number <= LARGEST for number in every)
