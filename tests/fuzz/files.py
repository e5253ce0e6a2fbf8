"""Solve fuzzed scene files and count how they end."""

import hashlib
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from hypothesis import HealthCheck, Phase, assume, given, seed, settings
from hypothesis import strategies as st

import tsm
from tests.fuzz.broken import broken_files, is_small, valid_scenes
from tests.fuzz.judge import solved
from tests.fuzz.world import toml_text

MODELS = ("rod", "elastica", "solid", "solid", *(f"tsm --element {name}" for name in tsm.ELEMENTS))
files = st.one_of(valid_scenes.map(lambda scene: toml_text(scene).encode()), broken_files)


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How some files ended: number by model and outcome, and what is wrong with which file."""

    kinds: Counter[tuple[str, str]] = field(default_factory=Counter)
    wrong: list[tuple[str, str, bytes]] = field(default_factory=list)


def tally(number: int, first: int) -> Tally:
    """Solve `number` different fuzzed files, each with one model, drawn from the seed `first`."""
    found, seen = Tally(), set[str]()

    @settings(
        max_examples=number,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @seed(first)
    @given(files, st.sampled_from(MODELS))
    def run(data: bytes, model: str) -> None:
        digest = hashlib.sha256(model.encode() + data).hexdigest()
        assume(is_small(data) and digest not in seen)
        seen.add(digest)
        file.write_bytes(data)
        outcome, _ = solved(file, *model.split())
        found.kinds[model.partition(" ")[0], outcome.kind] += 1
        if outcome.wrong is not None:
            found.wrong.append((model, outcome.wrong, data))

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        run()
    return found
