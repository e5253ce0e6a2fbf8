"""Try a random sample of mutants on the fast tests: `python tests/mutation/sample.py --count 120 --seed 1 --out out/mutation.tsv`.

The table names every mutant tried and the test that kills it. Mutants that survive for a reason are listed in `survivors.toml`. The exit status
is 0 only if at least `--rate` of the sample is killed and every survivor is listed.
"""

from __future__ import annotations

import argparse
import hashlib
import math
import sys
import tomllib
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from comparisons.files import write_text

sys.path.insert(0, str(Path(__file__).parent))
from mutants import Mutant, mutants
from trial import ROOT, Outcome, Trials, project_copy

SURVIVORS = Path(__file__).with_name("survivors.toml")
MODULES = (
    "tsm/elements/*.py",
    "tsm/groups/*.py",
    "tsm/rods/*.py",
    "tsm/contact.py",
    "tsm/contact_set.py",
    "tsm/critical.py",
    "tsm/crossing.py",
    "tsm/events.py",
    "tsm/fall.py",
    "tsm/newton.py",
    "tsm/path.py",
    "tsm/predictor.py",
    "tsm/projection.py",
    "tsm/root.py",
    "tsm/step_control.py",
    "tsm/stepping.py",
    "tsm/track.py",
    "comparisons/exact/*.py",
)
_EVENTS = ["tests/tsm/test_contact_events.py", "tests/tsm/test_statuses.py"]
_BEAMS = ["tests/tsm/test_double_beam.py", "tests/tsm/test_path.py", "tests/tsm/test_solve.py"]
_ELEMENTS = ["tests/tsm/test_elements.py"]
_PAPER = ["tests/tsm/elements/test_paper_matrices.py"]
_RODS = ["tests/tsm/test_rod_element.py"]
_EXACT = ["tests/verification/test_exact.py", "tests/verification/test_exact_invariance.py"]
_AXIS = ["tests/tsm/elements/test_axis.py"]
_PIN = ["tests/comparisons/exact/test_rod.py"]
_STAGES: dict[str, tuple[list[str], list[str]]] = {
    "tsm/elements/axis.py": (_AXIS, [*_RODS, *_EVENTS]),
    "tsm/elements/rod.py": (_RODS, [*_EXACT, *_EVENTS]),
    "tsm/elements/collocation.py": (_RODS, [*_EXACT, *_EVENTS]),
    "tsm/elements/as_printed.py": (_PAPER, _ELEMENTS),
    "tsm/elements/cantilever.py": (_ELEMENTS, _PAPER),
    "tsm/elements/": (_ELEMENTS, [*_EVENTS, *_BEAMS, *_AXIS, *_PAPER]),
    "tsm/rods/": (_RODS, ["tests/tsm/test_graded.py", *_EXACT, *_EVENTS]),
    "tsm/": (_EVENTS, [*_BEAMS, *_EXACT]),
    "comparisons/exact/chain.py": (["tests/comparisons/exact/test_chain.py"], []),
    "comparisons/exact/section.py": (
        ["tests/comparisons/exact/test_chain.py"],
        ["tests/comparisons/exact/test_coupled.py"],
    ),
    "comparisons/exact/coupled.py": (["tests/comparisons/exact/test_coupled.py"], []),
    "comparisons/exact/graded.py": (
        ["tests/comparisons/exact/test_graded.py"],
        ["tests/comparisons/exact/test_tied.py"],
    ),
    "comparisons/exact/tied.py": (["tests/comparisons/exact/test_tied.py"], []),
    "comparisons/exact/elastica.py": (["tests/comparisons/exact/test_elastica.py"], _PIN),
    "comparisons/exact/": (_PIN, ["tests/comparisons/exact"]),
}
"""Tests run first, and those run on what survives them, by the start of a module's path: the nearest end most mutants within seconds."""


class Tried(NamedTuple):
    """A mutant and what became of it."""

    mutant: Mutant
    outcome: Outcome


def stages(module: str) -> list[list[str]]:
    """Tests of a module: the nearest, and the others that concern it."""
    return [
        files
        for files in next(found for start, found in _STAGES.items() if module.startswith(start))
        if files
    ]


def population() -> list[Mutant]:
    """All mutants of the modules."""
    paths = sorted(path for pattern in MODULES for path in ROOT.glob(pattern))
    names = [path.relative_to(ROOT).as_posix() for path in paths]
    return [mutant for name in names for mutant in mutants(name, (ROOT / name).read_text(encoding="utf-8"))]


def draw(every: list[Mutant], seed: int, count: int) -> list[Mutant]:
    """Return a random sample, from every module in proportion to its mutants."""
    shares: list[tuple[float, int]] = []
    numbered = list(enumerate(every))
    for _, group in groupby(numbered, key=lambda entry: entry[1].module):
        ranked = sorted((_rank(seed, mutant), n) for n, mutant in group)
        start = int.from_bytes(ranked[0][0][-8:]) / 2**64
        shares += [((place + start) / len(ranked), n) for place, (_, n) in enumerate(ranked)]
    return [every[n] for _, n in sorted(shares)[:count]]


def interval(killed: int, count: int) -> tuple[float, float]:
    """Return Wilson's interval of a rate, 95 %."""
    z, rate = 1.959964, killed / count
    centre = rate + z**2 / (2 * count)
    half = z * math.sqrt(rate * (1 - rate) / count + (z / (2 * count)) ** 2)
    return (centre - half) / (1 + z**2 / count), (centre + half) / (1 + z**2 / count)


def reasons() -> dict[tuple[str, str, str], str]:
    """Why known mutants survive, by module and line before and after."""
    listed = tomllib.loads(SURVIVORS.read_text(encoding="utf-8"))["survivor"]
    return {(entry["module"], entry["before"], entry["after"]): entry["reason"] for entry in listed}


def table(tried: list[Tried]) -> str:
    """Tab-separated table of the trials."""
    lines = ["module\tline\tbefore\tafter\toutcome\tby\tseconds"]
    for mutant, outcome in tried:
        verdict = "killed" if outcome.killed else "survived"
        cells = (mutant.module, mutant.line, mutant.before, mutant.after, verdict, outcome.by)
        lines.append("\t".join(map(str, cells)) + f"\t{outcome.seconds:.1f}")
    return "\n".join(lines) + "\n"


def _survivors_of(path: Path) -> set[tuple[str, ...]]:
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    return {tuple(row[n] for n in (0, 2, 3)) for row in rows if row[4] == "survived"}


def _key(mutant: Mutant) -> tuple[str, str, str]:
    return mutant.module, mutant.before, mutant.after


def _rank(seed: int, mutant: Mutant) -> bytes:
    """Random rank, the same wherever the mutant stands in its module: a sample changes no more than the modules do."""
    return hashlib.sha256("\t".join([str(seed), *_key(mutant)]).encode()).digest()


def _summary(tried: list[Tried], among: int, least: float) -> bool:
    """Print the rate and the survivors, and say whether both are as they should be."""
    known = reasons()
    killed = sum(outcome.killed for _, outcome in tried)
    low, high = interval(killed, len(tried))
    late = sum(outcome.by == "timeout" for _, outcome in tried)
    print(f"{killed} of {len(tried)} mutants killed ({late} by timeout), sampled from {among}:", end=" ")
    print(f"{killed / len(tried):.1%}, 95 % interval {low:.1%} to {high:.1%}")
    unlisted = [mutant for mutant, outcome in tried if not outcome.killed and _key(mutant) not in known]
    for mutant in unlisted:
        print(
            f"{mutant.module}:{mutant.line}: survives, not in {SURVIVORS.name}\n  - {mutant.before}\n  + {mutant.after}"
        )
    return killed >= least * len(tried) and not unlisted


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=120, help="mutants to draw")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--skip", type=int, default=0, help="mutants of the sample tried elsewhere, from its start"
    )
    parser.add_argument("--rate", type=float, default=0.9, help="least part to be killed")
    parser.add_argument(
        "--stages", type=int, default=3, help="1 for the nearest tests of a module alone, 3 for all"
    )
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "mutation.tsv")
    parser.add_argument("--again", type=Path, help="table of an earlier run whose survivors alone are tried")
    options = parser.parse_args()
    every = population()
    if options.again:
        again = _survivors_of(options.again)
        drawn = [mutant for mutant in every if _key(mutant) in again]
    else:
        drawn = draw(every, options.seed, options.count)[options.skip :]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    tried: list[Tried] = []
    with project_copy() as folder:
        trials = Trials(folder)
        for mutant in drawn:
            outcome = trials(mutant.module, mutant.source, stages(mutant.module))
            tried.append(Tried(mutant, outcome))
            write_text(options.out, table(tried))
            print(
                f"{len(tried)}/{len(drawn)} {mutant.module}:{mutant.line} {outcome.by or 'survived'}",
                flush=True,
            )
    return 0 if _summary(tried, len(every), options.rate) else 1


if __name__ == "__main__":
    sys.exit(main())
