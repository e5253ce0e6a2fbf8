"""Scenes over everything that the format can state: completed answers are certified, the same by every element and number of load parameters."""

import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import SPECIAL, Scene, load_scene, read_scene, to_tables, to_toml

# the tables of a file and their records
from comparisons.scene.read import LISTS
from tests.comparisons.referee.forged import contact
from tests.fuzz.special import DRAW
from tests.fuzz.world_judge import BEAMS, Judged, Row, findings, judged, wrong


@pytest.mark.slow_at("world", "friction", "more", "held")
@pytest.mark.parametrize(
    ("kind", "seeds", "least"),
    [
        ("world", range(4), 0.7),
        ("friction", range(10), 0.5),
        ("special", range(102, 105), 0.6),
        ("world", range(4, 10), 0.5),
        ("held", range(20), 0.3),
    ],
    ids=["world", "friction", "special", "more", "held"],
)
def test_answers_to_drawn_scenes_are_right(kind: str, seeds: range, least: float) -> None:
    """No completed answer is wrong, and not too many solutions stop; `python -m tests.fuzz world 0 5000` draws thousands, with many numbers of load parameters."""
    found = [judged(DRAW[kind](seed), BEAMS) for seed in seeds]
    faults = [item.report() for item in found if list(wrong(item))]
    assert not faults, f"{len(faults)} of {len(found)} scenes\n" + "\n\n".join(faults)
    for model in BEAMS:
        own = [row for item in found for row in item.rows if row.model == model]
        assert sum(row.completed or row.ended == "END_CONTACT" for row in own) >= least * len(own)


REFUSED_WRONGLY = {2043: "tension near GA EA/(EA - GA), where the referee's iteration does not converge"}
"""Scenes whose true answers are not certified."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "first"), [("world", 2000), ("world", 2020), ("world", 2040), ("special", 100), ("special", 120)])  # fmt: skip
def test_drawn_scenes_are_certified(kind: str, first: int) -> None:
    found = [
        judged(DRAW[kind](seed), BEAMS, ()).bare()
        for seed in range(first, first + 20)
        if seed not in REFUSED_WRONGLY
    ]
    faults = [item.report() for item in found if item.findings]
    assert not faults, f"{len(faults)} of {len(found)} scenes\n" + "\n\n".join(faults)


QUICK = [("held", "9"), ("held", "75")]
MENDED = tomllib.loads(Path(__file__).with_name("mended.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("kind", "seed"),
    [
        pytest.param(kind, seed, marks=[pytest.mark.slow] * ((kind, seed) not in QUICK))
        for kind in DRAW for seed in MENDED.get(kind, ())
    ],
)  # fmt: skip
def test_drawn_scenes_that_once_failed(kind: str, seed: str) -> None:
    found = judged(DRAW[kind](int(seed)), BEAMS, (3,) if kind == "special" else (1, 8, 12))
    assert not found.findings, found.report()
    expected = MENDED["ended"].get(seed, ["COMPLETED"])
    assert expected in ([], sorted({row.ended for row in found.rows}))


@pytest.mark.parametrize("kind", DRAW)
def test_the_seed_alone_decides_what_is_drawn(kind: str) -> None:
    scenes = [DRAW[kind](seed) for seed in range(60)]
    assert scenes == [DRAW[kind](seed) for seed in range(60)]
    assert len(set(scenes)) > 50
    assert all(read_scene(to_toml(scene), "copy") == scene for scene in scenes)


SOLID_ONLY = {
    "beam.solid_clamp", "beam.solid_element", "beam.solid_mesh_file", "beam.material", "contact.penalty", "contact.penetration",
}  # fmt: skip


@pytest.mark.slow
def test_drawn_scenes_have_everything_that_a_scene_can_state() -> None:
    """Every key of every table, every word, and beams from slender to soft in shear, eight times at least."""
    numbers = {"world": 400, "special": 400, "friction": 20}
    scenes = [DRAW[kind](seed) for kind, number in numbers.items() for seed in range(number)]
    found = Counter(kind for scene in scenes for kind in set(_kinds(scene)))
    keys = {f"{table}.{field.name}" for table, kind in LISTS.items() for field in fields(kind)} - SOLID_ONLY
    words = {
        "clamped", "pinned", "roller", "start", "end", "x", "y", "rotation", "left", "right", "axis", "face",
        "slender", "thick", "soft in shear", "stiff in shear", "strut", "rigid joint", "several pins on a beam",
        "N, m", "N, mm", "bent path",
    }  # fmt: skip
    rare = {kind for kind in {*keys, *words, *SPECIAL} if found[kind] < 8}
    assert rare <= {"stage.name", "stage.gravity"}


def _kinds(scene: Scene) -> Iterator[str]:
    """Keys and words of a scene, and what its numbers are."""
    tables = to_tables(scene)
    for name, rows in tables.items():
        for row in rows if isinstance(rows, list) else [rows]:
            for key, value in row.items():
                yield f"{name}.{key}"
                yield key
                yield from (
                    item for item in (value if isinstance(value, list) else [value]) if isinstance(item, str)
                )
            yield name
    ends = [end for beam in scene.beams for end in (beam.start, beam.end)]
    touched = Counter(contact.beam for contact in scene.contacts if "." not in contact.node)
    sizes = [beam.rectangle_height / beam.length for beam in scene.beams]
    soft = [beam.GA * beam.length**2 / beam.EI for beam in scene.beams]
    along = [
        abs(np.dot(load.force, scene.beam(load.beam).direction)) > 0.99 * np.hypot(*load.force) > 0.0 for load in scene.loads
    ]  # fmt: skip
    there = {
        "slender": min(sizes) < 0.003, "thick": max(sizes) > 0.05, "soft in shear": min(soft) < 100.0,
        "stiff in shear": max(soft) > 1e5, "strut": any(along), "rigid joint": len(set(ends)) < len(ends),
        "several pins on a beam": max(touched.values(), default=0) > 1, "bent path": any(pin.path for pin in scene.pins), "taper": any(beam.tapers for beam in scene.beams),
    }  # fmt: skip
    yield from (kind for kind, is_there in there.items() if is_there)


@pytest.fixture(scope="module")
def row() -> Row:
    answer = solve(load_scene("ks-cantilever"), "tsm", Options(element="exact"))
    return Row(model="exact", number=50, ended="COMPLETED", response=answer, certified=True)


def forged(row: Row, at: slice = slice(None), **changes: object) -> Row:
    """A row whose contact force is a tenth too large."""
    assert row.response is not None
    force = next(iter(row.response.contacts.values())).force.copy()
    force[at] *= 1.1
    return replace(row, response=contact(row.response, force=force), **changes)


def kinds(*rows: Row) -> list[str]:
    return [item.kind for item in findings(load_scene("ks-cantilever"), rows)]


def test_the_judge_tells_wrong_answers(row: Row) -> None:
    """A forged force, an answer that depends on the load parameters, and one of another branch are found."""
    assert kinds(row, row) == []
    assert kinds(row, forged(row, number=7)) == ["DEPENDS exact"]
    assert kinds(row, replace(row, number=7, ended="LIMIT_POINT")) == ["DEPENDS exact"]
    assert kinds(row, forged(row, model="mixed")) == ["BRANCHES"]
    assert kinds(replace(row, certified=False, certificate="UNSTABLE: index 1")) == ["UNSTABLE exact"]
    assert kinds(replace(row, ended="HANG", response=None)) == ["HANG exact"]


def test_an_answer_that_the_referee_alone_refuses_is_not_wrong(row: Row) -> None:
    """It is wrong where the other elements have another answer, at any load parameter, or none, or where neither is certified."""
    refused = replace(row, model="mixed", certified=False, certificate="NOT_AN_EQUILIBRIUM: far")
    bare = replace(row, certified=False, certificate="INADMISSIBLE: pulls")
    one, both = ["NOT_AN_EQUILIBRIUM mixed"], ["INADMISSIBLE exact", "NOT_AN_EQUILIBRIUM mixed"]
    scene = load_scene("ks-cantilever")
    for rows, faults in (
        ((row, refused), []),
        ((row, forged(refused, slice(7, 8))), one),
        ((replace(row, ended="LIMIT_POINT"), refused), one),
        ((bare, refused), both),
        ((replace(bare, lost=True), replace(refused, lost=True)), []),
        ((row, replace(refused, ended="HANG")), []),
    ):
        found = Judged(scene=scene, rows=rows, findings=tuple(findings(scene, rows)))
        assert [item.kind for item in wrong(found)] == faults


@pytest.mark.slow
def test_the_command_judges_on_all_cores() -> None:
    arguments = [sys.executable, "-m", "tests.fuzz", "held", "0", "2"]
    assert "0 wrong: " in subprocess.run(arguments, capture_output=True, text=True, check=True).stdout
