"""Speed as ratios within one run, one thread. `make bench` prints them and compares them with the pages."""

import argparse
import sys

from tests.benchmarks import commands, inside
from tests.benchmarks.measure import Bench
from tests.stated import MARK, check, pages

VARIES = 0.25
"""Part of a stated ratio by which machines and runs may differ."""


def compared(gates, *, write):
    """Return a line for every ratio that is not what the pages state."""
    marks = {mark for page in pages() for mark in MARK.findall(page.read_text())}
    failures = []
    for gate in gates:
        if gate.mark in marks:
            try:
                check(gate.mark, gate.value, relative=VARIES, write=write)
            except AssertionError as error:
                failures.append(str(error))
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write-results", action="store_true", help="write changed ratios into the pages")
    given = parser.parse_args()
    bench = Bench()
    for part in (*commands.PARTS, *inside.PARTS):
        part(bench)
    for gate in bench.gates:
        print(gate)
    for name, value in bench.times.items():
        print(f"         {name}: {1e3 * value:.3g} ms")
    failures = compared(bench.gates, write=given.write_results)
    marks = {mark for page in pages() for mark in MARK.findall(page.read_text()) if mark.startswith("bench.")}
    failures += [
        f"{mark}: nothing measures it" for mark in sorted(marks - {gate.mark for gate in bench.gates})
    ]
    print(*failures, sep="\n")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
