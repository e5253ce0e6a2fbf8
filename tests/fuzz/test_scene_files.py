"""Whatever a scene file holds: done and checked, refused in one line, or stopped by name; and what is done is the exact rod's."""

from collections.abc import Callable, Iterator
from itertools import count, islice

import pytest

from comparisons.models import MODELS
from comparisons.scene import Scene
from tests.fuzz.judge import tally
from tests.fuzz.world import drawn, drawn_with_friction
from tests.fuzz.world_judge import Row, apart, run
from tests.laws.transform import Readings, readings
from tests.laws.transform import apart as differ

EXACT, LATE = 1e-6, 3e-6
"""Largest difference of exact elements and the rod, of the largest force, and of the load parameter of an event with friction."""


@pytest.mark.slow_at("many")
@pytest.mark.parametrize(
    ("number", "seed", "ends"),
    [(20, 1, {"done", "refused"}), (200, 2, {"done", "refused", "stopped"})],
    ids=["few", "many"],
)
def test_files_end_as_documented(number: int, seed: int, ends: set[str]) -> None:
    found = tally(number, seed)
    assert not found.wrong, "\n\n".join(f"{model}\n{why}\n{data!r}" for model, why, data in found.wrong)
    assert {kind.split()[0] for _, kind in found.kinds} == ends


STOPS = {87: "JAMMED"}
"""Scenes in which the rod with friction ends by name, and exact elements have a certified answer."""


KINDS = ("touch", "slip", "stick", "slip-off", "release")


def rods() -> Iterator[Scene]:
    """Yield drawn scenes of one beam under one pin, every other one with friction."""
    for seed in count():
        scene = drawn_with_friction(seed) if seed % 2 else drawn(seed)
        if MODELS["rod"].refusal(scene) is None and not MODELS["rod"].setting(scene, MODELS["rod"].reference):
            yield scene


def rubbed(row: Row, scene: Scene) -> tuple[Readings, list[tuple[str, float]]]:
    """What an answer states of the contact at every load parameter, and its events after the start."""
    assert row.response is not None
    names = ("contact", "arc", "tangential", "dissipated")
    states = {name: item for name, item in readings(row.response, scene).items() if name.split()[0] in names}
    events = row.response.events or ()
    return states, [(e.kind, e.load_parameter) for e in events if e.kind in KINDS and e.load_parameter > 1e-9]


@pytest.mark.slow
def test_answers_are_the_rods(stated: Callable[..., None]) -> None:
    """At every load parameter that both reach, with friction in its events too; where the rod stops exact elements stop too."""
    stated("fuzz.exact", EXACT)
    compared = 0
    for scene in islice(rods(), 60):
        rod, exact = (run(scene, model) for model in ("rod", "exact"))
        stops = STOPS.get(int(scene.name.removeprefix("drawn-")))
        assert rod.ended == stops or rod.completed or not exact.completed, f"{rod.line()} | {exact.line()}"
        for row in (rod, exact):
            assert row.certified or not row.completed, row.line()
        both = 0 if not (rod.completed and exact.completed) else len(scene.times)
        compared += both
        for k in range(both):
            assert apart(scene, rod, exact, at=k) <= EXACT, f"{scene.name} at load parameter {k}"
        if both and scene.contacts[0].friction:
            (true, happened), (own, found) = (rubbed(row, scene) for row in (rod, exact))
            if not true[f"contact {scene.contacts[0].pair}"][1].any():
                continue  # the pin is gone before the next load parameter: nothing to certify
            assert differ(scene, true, own)[0] <= EXACT, scene.name
            assert [kind for kind, _ in found] == [kind for kind, _ in happened], scene.name
            assert [t for _, t in found] == pytest.approx([t for _, t in happened], abs=LATE), scene.name
    assert compared > 60
