"""Judge drawn scenes on all cores: ``python -m tests.fuzz KIND SEED NUMBER``; without a number, print the scene of the seed.

Kinds are ``world``, ``friction``, ``special``, ``held``, ``cantilevers`` by shooting, and ``files``, of which a seed makes 250.
"""

import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor

from comparisons.scene import Scene, to_toml
from tests.fuzz.cantilevers import verdict
from tests.fuzz.files import tally
from tests.fuzz.held import drawn_held, judged_held
from tests.fuzz.special import drawn_special
from tests.fuzz.world import drawn, drawn_with_friction
from tests.fuzz.world_judge import BEAMS, Judged, judged

NUMBERS = (1, 2, 5, 8, 12, 40)
"""Numbers of load parameters that scenes are solved with besides their own."""
Found = tuple[Counter[str], list[str]]
"""How solutions ended, and reports of what is wrong."""


def _of(found: Judged) -> Found:
    return Counter(f"{row.model} {row.ended}" for row in found.rows), [
        found.report()
    ] if found.findings else []


def _scene(draw: Callable[[int], Scene], seed: int, models: Iterable[str], numbers: Sequence[int]) -> Found:
    return _of(judged(draw(seed), tuple(models), numbers))


def _cantilever(seed: int) -> Found:
    found = verdict(seed, "mixed" if seed % 4 == 0 else "exact")
    return Counter([found.ended]), [f"{seed} {found.ended}: {found.wrong}"] if found.wrong else []


def _files(seed: int) -> Found:
    found = tally(250, seed)
    wrong = [f"{model}: {why}\n{data!r}" for model, why, data in found.wrong]
    return Counter({f"{model} {kind}": number for (model, kind), number in found.kinds.items()}), wrong


DRAWN = {"world": drawn, "friction": drawn_with_friction, "special": drawn_special, "held": drawn_held}
JUDGED: dict[str, Callable[[int], Found]] = {
    "world": lambda seed: _scene(drawn, seed, (*BEAMS, "solid"), NUMBERS),
    "friction": lambda seed: _scene(drawn_with_friction, seed, BEAMS, NUMBERS),
    "special": lambda seed: _scene(drawn_special, seed, BEAMS, (3,)),
    "held": lambda seed: _of(judged_held(seed)),
    "cantilevers": _cantilever,
    "files": _files,
}


def one(kind: str, seed: int) -> Found:
    """Judge what a seed makes."""
    return JUDGED[kind](seed)


def main(kind: str, first: int, number: int) -> int:
    """Print what is wrong, and how all ended."""
    ends, wrong = Counter[str](), 0
    with ProcessPoolExecutor(os.cpu_count(), max_tasks_per_child=200) as pool:
        for count, (own, reports) in enumerate(
            pool.map(one, [kind] * number, range(first, first + number)), 1
        ):
            ends += own
            wrong += len(reports)
            print(f"\r{count} of {number}, {wrong} wrong", end="", file=sys.stderr)
            print(*("WRONG " + text for text in reports), sep="\n", end="\n" * bool(reports), flush=True)
    print(f"\n{wrong} wrong: " + ", ".join(f"{n} {end}" for end, n in ends.most_common()))
    return int(wrong > 0)


if __name__ == "__main__":
    if len(sys.argv) == 3:
        print(to_toml(DRAWN[sys.argv[1]](int(sys.argv[2]))), end="")
    else:
        sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
