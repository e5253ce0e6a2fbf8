"""A random sample of mutmut's mutants on the fast tests, and the part of them that the tests kill."""

from __future__ import annotations

import argparse
import os
import random
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

from scipy.stats import binomtest

ROOT = Path(__file__).parents[2]
KILLED = {"killed", "timeout", "segfault"}


def mutmut(*arguments: str, capture: bool = False) -> str:
    program = Path(sys.executable).with_name("mutmut")
    return subprocess.run([program, *arguments], check=True, text=True, capture_output=capture).stdout


def statuses() -> dict[str, str]:
    """Return what became of every mutant in ``mutants/``."""
    lines = mutmut("results", "--all", "true", capture=True).splitlines()
    return dict(line.strip().split(": ") for line in lines)


def generate() -> None:
    """Write all mutants of the modules that ``pyproject.toml`` lists into ``mutants/``; `mutmut run` alone would try all."""
    from mutmut.__main__ import create_mutants
    from mutmut.utils.file_utils import copy_src_dir

    shutil.rmtree("mutants", ignore_errors=True)
    Path("mutants").mkdir()
    copy_src_dir()
    create_mutants(os.cpu_count() or 1)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=120, help="mutants to draw")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rate", type=float, default=0.8, help="least part to be killed, for exit status 0")
    options = parser.parse_args()
    os.chdir(ROOT)
    generate()
    every = sorted(statuses())
    drawn = random.Random(options.seed).sample(every, options.count)  # noqa: S311 - a sample is no secret
    mutmut("run", *drawn)
    status = statuses()
    survivors = [name for name in drawn if status[name] not in KILLED]
    for name in survivors:
        mutmut("show", name)
    killed = len(drawn) - len(survivors)
    interval = binomtest(killed, len(drawn)).proportion_ci(method="wilson")
    print(", ".join(f"{count} {kind}" for kind, count in Counter(status[name] for name in drawn).items()))
    print(f"killed {killed} of {len(drawn)} mutants, drawn from {len(every)}:", end=" ")
    print(f"{killed / len(drawn):.1%}, 95 % interval {interval.low:.1%} to {interval.high:.1%}")
    return 0 if killed >= options.rate * len(drawn) else 1


if __name__ == "__main__":
    sys.exit(main())
