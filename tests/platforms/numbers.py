"""The answers of the golden files on this platform: ``python -m tests.platforms.numbers``. Pictures and pages need not be installed."""

import sys
from collections.abc import Iterator

from tests.golden.write import HERE, differences, machine, solved

SCENES = ("ks-cantilever", "double-beam")
BOUND = 1e-10
"""Largest difference between platforms, relative to the largest value of a line."""


def apart() -> Iterator[str]:
    """Yield the lines that differ."""
    for scene in SCENES:
        kept = (HERE / f"{scene}.txt").read_text(encoding="utf-8")
        answers = kept[kept.index("== solve") : kept.index("\n== certify")]
        yield from differences("\n".join(solved(scene)), answers, BOUND)


if __name__ == "__main__":
    found = list(apart())
    print(machine(), f"{len(found)} lines differ by more than {BOUND:g}", *found, sep="\n")
    sys.exit(bool(found))
