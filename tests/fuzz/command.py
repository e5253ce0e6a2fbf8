"""Judge drawn scenes on all cores: ``python -m tests.fuzz KIND SEED NUMBER``; without a number, print the scene of the seed.

Kinds are ``world``, ``friction``, ``special``, ``held``, and ``files``, of which a seed makes 250.
"""

import os
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

from tests.fuzz.judge import tally
from tests.fuzz.special import DRAW
from tests.fuzz.world_judge import BEAMS, judged

NUMBERS = {"special": (3,), "held": (1, 3, 7, 20)}
"""Numbers of load parameters that scenes are solved with besides their own, where they are not those of `MANY`."""
MANY = (1, 2, 5, 8, 12, 40)
COARSE = "NOT_AN_EQUILIBRIUM mixed"
"""That `mixed` elements are coarse is no fault of a beam that is held."""


def one(kind: str, seed: int) -> tuple[Counter[str], list[str]]:
    """How the solutions of what a seed makes ended, and reports of what is wrong."""
    if kind == "files":
        files = tally(250, seed)
        wrong = [f"{model}: {why}\n{data!r}" for model, why, data in files.wrong]
        return Counter({f"{model} {end}": number for (model, end), number in files.kinds.items()}), wrong
    found = judged(DRAW[kind](seed), (*BEAMS, *["solid"] * (kind == "world")), NUMBERS.get(kind, MANY))
    ends = Counter(f"{row.model} {row.ended}" for row in found.rows)
    return ends, [found.report()] if any(
        kind != "held" or item.kind != COARSE for item in found.findings
    ) else []


def main(kind: str, first: int, number: int) -> int:
    """Print what is wrong, and how all ended."""
    ends, wrong, seeds = Counter[str](), 0, range(first, first + number)
    with ProcessPoolExecutor(os.cpu_count(), max_tasks_per_child=200) as pool:
        for count, (own, reports) in enumerate(pool.map(one, [kind] * number, seeds), 1):
            ends += own
            wrong += len(reports)
            print(f"\r{count} of {number}, {wrong} wrong", end="", file=sys.stderr)
            print(*("WRONG " + text for text in reports), sep="\n", end="\n" * bool(reports), flush=True)
    print(f"\n{wrong} wrong: " + ", ".join(f"{n} {end}" for end, n in ends.most_common()))
    return int(wrong > 0)
