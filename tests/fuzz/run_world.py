"""Solve and judge drawn scenes on all cores: ``python -m tests.fuzz.run_world 5000``."""

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import count, islice
from pathlib import Path

from tests.fuzz.world import drawn, drawn_with_friction
from tests.fuzz.world_judge import MODELS, Judged, judged

NUMBERS = (1, 2, 5, 8, 12, 40)
"""Numbers of load parameters that every scene is solved with besides its own."""
MANY, RARELY = 200, 50
"""Number that one scene in so many is solved with as well."""


def plan(seed: int, models: tuple[str, ...], numbers: tuple[int, ...], friction: bool) -> tuple[str, Judged]:
    """Draw, solve and judge the scene of a seed; the report says what is wrong, nothing if nothing is."""
    many = (MANY,) if numbers and seed % RARELY == 0 else ()
    scene = drawn_with_friction(seed) if friction else drawn(seed)
    found = judged(scene, models, (*numbers, *many))
    # responses hold functions, which do not go from process to process
    return found.report() if found.findings else "", found.bare()


def results(
    seeds: Iterable[int], models: tuple[str, ...], numbers: tuple[int, ...], *, friction: bool
) -> Iterator[tuple[int, str, Judged]]:
    """Yield seed, report and judgement of every scene, in order, from all cores."""
    seeds = tuple(seeds)
    with ProcessPoolExecutor(os.cpu_count(), max_tasks_per_child=200) as pool:
        work = partial(plan, models=models, numbers=numbers, friction=friction)
        for seed, (report, found) in zip(seeds, pool.map(work, seeds), strict=True):
            yield seed, report, found


def has_round_pin(seed: int) -> bool:
    """Whether the scene of a seed has a round pin."""
    return any(pin.radius is not None for pin in drawn(seed).pins)


def main() -> int:
    """Print what is wrong and how the solutions ended; keep the scenes that are wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", type=int, nargs="?", default=5000, help="of scenes (5,000)")
    parser.add_argument("--seed", type=int, default=0, help="of the first scene (0)")
    parser.add_argument("--round-pins", action="store_true", help="only scenes that have some")
    parser.add_argument(
        "--friction", action="store_true", help="only scenes with contacts, some with friction"
    )
    parser.add_argument("--models", default=",".join(MODELS), help=f"some of {', '.join(MODELS)}")
    parser.add_argument(
        "--numbers", default=",".join(map(str, NUMBERS)), help="of load parameters besides the scene's own"
    )
    parser.add_argument("--out", type=Path, default=Path("out/world"), help="for the scenes that are wrong")
    given = parser.parse_args()
    models = tuple(given.models.split(","))
    numbers = tuple(int(item) for item in given.numbers.split(",") if item)
    seeds = filter(has_round_pin, count(given.seed)) if given.round_pins else count(given.seed)
    ends, kinds, wrong = Counter[tuple[str, str]](), Counter[str](), 0
    answers = results(islice(seeds, given.number), models, numbers, friction=given.friction)
    for n, (seed, report, found) in enumerate(answers, 1):
        ends.update((row.model, row.ended) for row in found.rows)
        kinds.update({item.kind for item in found.findings})
        print(f"\r{n} scenes, {wrong} wrong", end="", file=sys.stderr)
        if report:
            wrong += 1
            given.out.mkdir(parents=True, exist_ok=True)
            file = given.out / f"{seed}.toml"
            file.write_text(report, encoding="utf-8")
            print(
                f"WRONG {file}: " + "; ".join(f"{item.kind}: {item.text}" for item in found.findings),
                flush=True,
            )
    print(file=sys.stderr)
    print(
        f"{given.number} scenes, {wrong} wrong" + "".join(f"; {n} {kind}" for kind, n in kinds.most_common())
    )
    for model in models:
        own = [(kind, n) for (name, kind), n in ends.most_common() if name == model]
        print(f"  {model}: " + ", ".join(f"{n} {kind}" for kind, n in own))
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
