"""Solve fuzzed scene files and count how they end: ``python -m tests.fuzz.run 10000``."""

import argparse
import hashlib
import os
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

from hypothesis import HealthCheck, Phase, assume, given, seed, settings
from hypothesis import strategies as st

import tsm
from tests.fuzz.broken import broken_files, is_small, toml_text
from tests.fuzz.judge import solved
from tests.fuzz.scenes import valid_scenes

MODELS = ("rod", "elastica", "solid", "solid", *(f"tsm --element {name}" for name in tsm.ELEMENTS))
CHUNK = 250
"""Files of one seed."""
files = st.one_of(valid_scenes.map(lambda scene: toml_text(scene).encode()), broken_files)


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How some files ended: number by model and outcome, what is wrong with which file, seconds by model and file."""

    kinds: Counter[tuple[str, str]] = field(default_factory=Counter)
    wrong: list[tuple[str, str, bytes]] = field(default_factory=list)
    seconds: list[tuple[float, str, bytes]] = field(default_factory=list)


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
        found.seconds.append((outcome.seconds, model, data))
        if outcome.wrong is not None:
            found.wrong.append((model, outcome.wrong, data))

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        run()
    return found


def tallies(number: int, first: int) -> Iterator[Tally]:
    """Solve `number` files on all cores."""
    sizes = [CHUNK] * (number // CHUNK) + [number % CHUNK] * (number % CHUNK > 0)
    with ProcessPoolExecutor(os.cpu_count(), max_tasks_per_child=1) as pool:
        yield from pool.map(tally, sizes, range(first, first + len(sizes)))


def main() -> int:
    """Print the counts; keep the files that ended wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", type=int, nargs="?", default=10_000, help="of files (10,000)")
    parser.add_argument("--seed", type=int, default=0, help="the same seed makes the same files (0)")
    parser.add_argument("--out", type=Path, default=Path("out/fuzz"), help="for the files that end wrong")
    given_ = parser.parse_args()
    kinds, seconds, places = Counter[tuple[str, str]](), [(0.0, "", b"")], count()
    for part in tallies(given_.number, given_.seed):
        kinds += part.kinds
        print(f"\r{kinds.total()} files", end="", file=sys.stderr)
        seconds = sorted(seconds + part.seconds, key=lambda row: row[0])[-5:]
        for (model, reason, data), place in zip(part.wrong, places, strict=False):
            given_.out.mkdir(parents=True, exist_ok=True)
            (given_.out / f"{place}.toml").write_bytes(data)
            print(f"WRONG {given_.out / str(place)}.toml --model {model}: {reason}", flush=True)
    print(file=sys.stderr)
    outcomes = Counter[str]()
    for (_, kind), n in kinds.items():
        outcomes[kind] += n
    print(f"{kinds.total()} files: " + ", ".join(f"{n} {kind}" for kind, n in outcomes.most_common()))
    for model in ("tsm", "solid", "rod", "elastica"):
        own = [(n, kind) for (name, kind), n in kinds.most_common() if name == model]
        print(f"  {model}: " + ", ".join(f"{n} {kind}" for n, kind in own))
    print("slowest: " + ", ".join(f"{s:.1f} s {model}" for s, model, _ in reversed(seconds)))
    return int(any(kind.startswith(("raised", "status")) for kind in outcomes))


if __name__ == "__main__":
    sys.exit(main())
